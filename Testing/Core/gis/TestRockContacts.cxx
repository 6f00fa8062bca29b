// The table of pairs of materials of rocks that hit each other.
#include "base/errors.h"
#include "gis/layers/rockContacts.h"
#include "gisFiles.h"

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

const std::vector<std::string> materials = { "Granite", "", "slate", "granite", "concrete", "7" };

std::vector<RockContactPair> read(const std::string& text, double cohesion = 0.0)
{
  return readRockContacts(writeFile("pairs.csv", text), cohesion, materials);
}

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
  const std::string message = messageOf<DataError>([&] { read(text); });
  EXPECT_TRUE(holds(message, words));
  EXPECT_TRUE(holds(message, { "pairs.csv" }));
}

const std::string header = "material_a,material_b,restitution,phi,cohesion\n";

} // namespace

TEST(RockContacts, ReadsPairs)
{
  const auto pairs =
    read(header + "granite,SLATE,0.3,25.5,1e3\nslate, slate ,0,0,\n7,concrete,1,89,0\n", 50.0);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].first, "Granite"); // as the rocks have it
  EXPECT_EQ(pairs[0].second, "slate");
  EXPECT_EQ(pairs[0].contact.restitution, 0.3);
  EXPECT_EQ(pairs[0].contact.frictionAngle, radians(25.5));
  EXPECT_EQ(pairs[0].contact.cohesion, 1000.0);
  EXPECT_EQ(pairs[1].first, "slate");
  EXPECT_EQ(pairs[1].second, "slate");
  EXPECT_EQ(pairs[1].contact.restitution, 0.0);
  EXPECT_EQ(pairs[1].contact.cohesion, 50.0); // empty
  EXPECT_EQ(pairs[2].first, "7");
  EXPECT_EQ(pairs[2].contact.restitution, 1.0);
  EXPECT_EQ(pairs[2].contact.frictionAngle, radians(89.0));
}

TEST(RockContacts, OtherNamesOfColumnsAndNoCohesion)
{
  const auto pairs =
    read("Rn;Material_B;note;Material_A;Friction_Angle\n0.4;slate;wet;granite;20\n", 7.0);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, "Granite");
  EXPECT_EQ(pairs[0].second, "slate");
  EXPECT_EQ(pairs[0].contact.restitution, 0.4);
  EXPECT_EQ(pairs[0].contact.frictionAngle, radians(20.0));
  EXPECT_EQ(pairs[0].contact.cohesion, 7.0);
}

TEST(RockContacts, decimalCommaOfTheLocaleChangesNothing)
{
  const CommaLocale comma;
  const auto pairs = read(header + "granite,slate,0.25,25.5,1000.5\n");
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].contact.restitution, 0.25);
  EXPECT_EQ(pairs[0].contact.frictionAngle, radians(25.5));
  EXPECT_EQ(pairs[0].contact.cohesion, 1000.5);
  expectRefused(header + "granite,slate,1.5,25.5,0\n", { "row 1", "restitution", "1.5" });
}

TEST(RockContacts, BadTables)
{
  const std::string good = "granite,slate,0.5,30,0\n";
  expectRefused(header, { "no row" });
  expectRefused("material_a,restitution,phi\ngranite,0.5,30\n", { "material_b", "\"phi\"" });
  expectRefused("material_a,material_b,phi\ngranite,slate,30\n", { "no column \"restitution\"" });
  expectRefused("material_a,material_b,rn\ngranite,slate,0.3\n", { "no column \"phi\"" });
  expectRefused(header + good + "granite,,0.5,30,0\n", { "row 2", "material_b", "empty" });
  expectRefused(header + good + "slate,slate,,30,0\n", { "row 2", "restitution", "empty" });
  expectRefused(header + good + "slate,slate,0.5,,0\n", { "row 2", "phi", "empty" });
  expectRefused(header + good + "cheese,slate,0.5,30,0\n",
    { "row 2", "material_a", "cheese", "\"7\", \"concrete\", \"Granite\", \"slate\"" });
  expectRefused(header + good + "granite,slate,0.5,30,0\n", { "row 2", "is in row 1 already" });
  expectRefused(
    header + good + "Slate,granite,0.4,20,0\n", { "row 2", "slate", "Granite", "row 1" });
  expectRefused(header + "granite,slate,-0.1,30,0\n", { "row 1", "restitution", "-0.1", "0 to 1" });
  expectRefused(header + "granite,slate,nan,30,0\n", { "row 1", "restitution", "nan" });
  expectRefused(header + "granite,slate,0.5,90,0\n", { "row 1", "phi", "90", "0 to 89 degrees" });
  expectRefused(header + "granite,slate,0.5,-1,0\n", { "row 1", "phi", "-1" });
  expectRefused(header + "granite,slate,0.5,30,-5\n", { "row 1", "cohesion", "-5" });
  expectRefused(header + "granite,slate,0.5,30,inf\n", { "row 1", "cohesion", "inf" });
  expectRefused(header + "granite,slate,hard,30,0\n", { "row 1", "restitution", "hard" });
  expectRefused(header + "granite,slate,\"0,5\",30,0\n", { "row 1", "0,5", "decimal sign" });
  expectRefused(header + "granite,slate,0,5,30,0\n", { "row 1", "decimal sign" });
}

TEST(RockContacts, NamesOfColumns)
{
  const std::string row = "granite,slate,0.5,30,1000\n";
  for (const std::string slip : { "coh", "Cohes", "cohesoin" })
  {
    expectRefused("material_a,material_b,restitution,phi," + slip + "\n" + row,
      { "\"" + slip + "\" is not read", "none \"cohesion\"" });
  }
  // Another first letter.
  EXPECT_EQ(read("material_a,material_b,restitution,phi,kohesion\n" + row).size(), 1u);
  expectRefused(
    "material_a,material_b,restitution,phi,PHI\n" + row, { "two columns \"phi\"", "PHI" });
  expectRefused("material_a,material_b,restitution,phi,rn\ngranite,slate,0.5,30,0.4\n",
    { "row 1", "\"restitution\" is 0.5", "\"rn\"", "0.4" });
  EXPECT_EQ(
    read("material_a,material_b,restitution,phi,rn\ngranite,slate,0.5,30,0.5\n").size(), 1u);
  EXPECT_EQ(read("material_a,material_b,restitution,phi,rn\ngranite,slate,0.5,30,\n").size(), 1u);
}

TEST(RockContacts, RocksWithoutMaterial)
{
  const std::string file = writeFile("pairs.csv", header + "granite,slate,0.5,30,0\n");
  const std::vector<std::string> none(3);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { readRockContacts(file, 0.0, none); }),
    { "row 1", "material_a", "granite", "the rocks have no Material" }));
}

TEST(RockContacts, TooManyMaterials)
{
  std::vector<std::string> many;
  std::string text = header;
  for (int k = 0; k < 256; ++k)
  {
    many.push_back("m" + std::to_string(k));
    text += many.back() + "," + many.back() + ",0.5,30,0\n";
  }
  const std::string file = writeFile("pairs.csv", text);
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { readRockContacts(file, 0.0, many); }), { "row 256", "255" }));
}

TEST(RockContacts, BadFiles)
{
  EXPECT_TRUE(holds(messageOf<FileError>([&] { readRockContacts("/no/such.csv", 0.0, materials); }),
    { "no/such" }));
  const std::string empty = writeFile("pairs.csv", "");
  messageOf<FileError>([&] { readRockContacts(empty, 0.0, materials); });
}
