// Names that differ in case or in their Unicode form only are one: in every script in which a
// survey of this continent is written, and everywhere a name is looked for.
#include "base/RockContact.h"
#include "base/RockMaterial.h"
#include "base/errors.h"
#include "base/text/nameKey.h"
#include "geometry/shapes.h"
#include "gis/layers/rockContacts.h"
#include "gis/raster/contours.h"
#include "gis/raster/ground.h"
#include "gisFiles.h"
#include "slopes.h"
#include "terrain/presets.h"

#include <utility>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

/// "Geröll" with its ö as one letter, and as an o with a combining diaeresis.
const std::string composed = "Ger\u00f6ll", decomposed = "Gero\u0308ll", capitals = "GER\u00d6LL";

/// The slope's one class of ground, of which `word` is said on the map and `row` in the table.
std::string classOf(const std::string& word, const std::string& row)
{
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string zones =
    writeFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\"," + word + "\n");
  const std::string table = writeFile("table.csv", "class,preset\n" + row + ",talus\n");
  std::vector<std::string> notes;
  const MaterialClasses classes =
    readGround(GroundKind::Restitution, { zones, table, "" }, terrain, notes);
  return classes.names.at(std::size_t(classes.at(1)) - 1);
}

} // namespace

TEST(Names, CaseAndUnicodeFormMakeNoOtherName)
{
  const std::pair<const char*, const char*> same[] = {
    { "GER\u00d6LL", "geröll" },                    // German
    { "Gero\u0308ll", "Ger\u00f6ll" },              // decomposed, composed
    { "STRASSE", "straße" },                        // ß in capitals
    { "ÉBOULIS CALCAIRE", "éboulis calcaire" },     // French
    { "E\u0301boulis", "\u00c9BOULIS" },            //
    { "Œuvre", "œUVRE" },                           //
    { "CAVITÀ", "cavità" },                         // Italian
    { "URÅS", "ura\u030as" }, { "SKJÆR", "skjær" }, // Scandinavian
    { "Ø", "ø" },                                   //
    { "SKÁLA ŽĎÁR", "skála žďár" }, { "GŁAZOWISKO ŁĄKA", "głazowisko łąka" }, // Slavic
    { "ŠKRAPLJE Č", "s\u030ckraplje c\u030c" },                               //
    { "ΒΡΆΧΟΣ", "βράχος" },                          // Greek, with its final sigma
    { "ОСЫПЬ", "осыпь" }, { "Й", "\u0438\u0306" },   // Cyrillic
    { "  Fels ", "fels" }, { "Fels\u00a0", "FELS" }, // blanks, one of them from a spreadsheet
    { "bare\u00a0rock", "Bare Rock" },               //
  };
  for (const auto& [one, other] : same)
  {
    EXPECT_EQ(nameKey(one), nameKey(other)) << one << ", " << other;
  }
  const std::pair<const char*, const char*> different[] = {
    { "Geroll", "Geröll" },
    { "fels", "felsen" },
    { "bare rock", "barerock" },
    { "ø", "o" },
    { "осыпь", "осыпи" },
  };
  for (const auto& [one, other] : different)
  {
    EXPECT_NE(nameKey(one), nameKey(other)) << one << ", " << other;
  }
}

TEST(Names, BytesThatAreNoUtf8AreTold)
{
  EXPECT_TRUE(isUtf8("") && isUtf8("plain") && isUtf8(composed) && isUtf8("\xf0\x9f\xaa\xa8"));
  for (const char* text : { "Ger\xf6ll", "\xff\xfe", "cut \xc3", "\xed\xa0\x80", "\xc0\xaf" })
  {
    EXPECT_FALSE(isUtf8(text)) << text;
  }
  EXPECT_NE(nameKey("Ger\xf6ll"), nameKey(composed));
}

TEST(Names, ClassesOfGround)
{
  EXPECT_EQ(classOf(capitals, composed), composed);
  EXPECT_EQ(classOf(decomposed, composed), composed);
  EXPECT_EQ(classOf(composed, decomposed), decomposed);
  EXPECT_EQ(classOf("ΒΡΆΧΟΣ", "βράχος"), "βράχος");
  EXPECT_EQ(classOf("ОСЫПЬ", "осыпь"), "осыпь");
  EXPECT_EQ(classOf("E\u0301BOULIS", "éboulis"), "éboulis");
  EXPECT_THROW(classOf("Geroll", composed), DataError);
}

TEST(Names, ClassesThatAreOneAreRefusedTwice)
{
  const std::string table =
    writeFile("table.csv", "class,preset\n" + composed + ",talus\n" + decomposed + ",rock\n");
  const std::string zones =
    writeFile("zones.csv", "WKT,class\n\"POLYGON((0 0,9 0,9 9,0 9,0 0))\"," + composed + "\n");
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  std::vector<std::string> notes;
  const std::string message = messageOf<DataError>(
    [&] {
      readGround(GroundKind::Restitution, { zones, table, "" }, terrain, notes);
    });
  EXPECT_NE(message.find("is in row 1 already"), std::string::npos) << message;
}

TEST(Names, MaterialsOfRocks)
{
  const std::string table = writeFile("contacts.csv",
    "material_a,material_b,restitution,phi\n" + capitals + "," + decomposed + ",0.5,30\n");
  const std::vector<std::string> materials = { composed };
  const auto pairs = readRockContacts(table, 0.0, materials);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, composed);
  EXPECT_EQ(pairs[0].second, composed);
  EXPECT_EQ(rockMaterialFromName(" GRANITE ").density, rockMaterialFromName("granite").density);
  EXPECT_EQ(shapeFromName(" Cube"), Shape::Cube);
  EXPECT_STREQ(groundPreset("Talus\u00a0with Vegetation").name, "talus with vegetation");
  EXPECT_STREQ(groundPreset("Meadow (field data)").name, "meadow"); // as in the panel
}

TEST(Names, Columns)
{
  const std::string file = writeFile("lines.csv",
    "WKT,HO\u0308HE\n\"LINESTRING(0 0,0 100)\",50\n\"LINESTRING(50 0,50 100)\",40\n"
    "\"LINESTRING(100 0,100 100)\",30\n");
  ContourOptions options;
  options.elevationField = "H\u00f6he";
  const RasterSurface surface = readContours(file, options);
  EXPECT_EQ(*std::max_element(surface.heights.begin(), surface.heights.end()), 50.0);
}
