// Tables as people save them: encodings, what spreadsheets put before the header, comments, and
// sheets whose cells are all text. Each is read rightly or is one message that names the file and
// the line.
#include "base/errors.h"
#include "gis/layers/rockContacts.h"
#include "gis/layers/sources.h"
#include "gis/raster/ground.h"
#include "gisFiles.h"
#include "sheets.h"
#include "slopes.h"
#include "terrain/presets.h"

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

const std::string table = "x,y,height,source\n5,50,0,Höhle\n6,51,1,Éboulis\n";

SourceLayer read(const std::string& file)
{
  SourceOptions options;
  options.haveTerrain = true;
  return readSourceLayer(file, options);
}

/// The names of the two rows of `table`.
void expectNames(const std::string& file)
{
  const SourceLayer layer = read(file);
  ASSERT_EQ(layer.rows.size(), 2u);
  EXPECT_EQ(layer.rows[0].sourceName, "Höhle");
  EXPECT_EQ(layer.rows[1].sourceName, "Éboulis");
  EXPECT_EQ(layer.rows[1].position.x(), 6.0);
  EXPECT_EQ(layer.rows[1].height, 1.0);
}

/// One byte for each letter of U+0080 to U+00FF.
std::string latin1(const std::string& text)
{
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const auto c = std::uint8_t(text[i]);
    bytes += c < 0x80 ? text[i] : char((c & 3) << 6 | (std::uint8_t(text[++i]) & 0x3f));
  }
  return bytes;
}

/// Letters up to U+00FF, `wide` bytes each.
std::string utf(const std::string& text, std::size_t wide, bool bigEnd, bool mark)
{
  std::string result;
  const auto put = [&](std::uint32_t code)
  {
    for (std::size_t k = 0; k < wide; ++k)
    {
      result += char(code >> 8 * (bigEnd ? wide - 1 - k : k) & 0xff);
    }
  };
  if (mark)
  {
    put(0xfeff);
  }
  for (const char c : latin1(text))
  {
    put(std::uint8_t(c));
  }
  return result;
}

std::string failure(const std::string& content, const std::string& name = "table.csv")
{
  const std::string file = writeFile(name, content);
  return messageOf<DataError>([&] { read(file); });
}

} // namespace

TEST(TableText, Utf8WithAndWithoutAMark)
{
  expectNames(writeFile("plain.csv", table));
  expectNames(writeFile("marked.csv", "\xef\xbb\xbf" + table));
  EXPECT_TRUE(read(writeFile("plain.csv", table)).notes.empty());
}

TEST(TableText, Latin1IsReadAndSaysSo)
{
  const std::string file = writeFile("latin.csv", latin1(table));
  expectNames(file);
  const std::vector<std::string> notes = read(file).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(holds(notes[0], { "latin.csv", "Windows-1252", "line 2", "\"Höhle\"", ".cpg" }));
  // Of Windows only: € and a dash.
  const SourceLayer layer =
    read(writeFile("euro.csv", "x,y,height,source\n5,50,0,B \x96 1 \x80\n"));
  EXPECT_EQ(layer.rows.at(0).sourceName, "B – 1 €");
}

TEST(TableText, Utf16AndUtf32)
{
  for (const bool bigEnd : { false, true })
  {
    expectNames(writeFile("utf16.csv", utf(table, 2, bigEnd, true)));
    expectNames(writeFile("bare16.csv", utf(table, 2, bigEnd, false)));
    expectNames(writeFile("utf32.csv", utf(table, 4, bigEnd, true)));
  }
}

TEST(TableText, Utf16AsASpreadsheetSavesIt)
{
  // "Unicode text": tabs between the cells.
  std::string tabs = table;
  std::replace(tabs.begin(), tabs.end(), ',', '\t');
  expectNames(writeFile("tabs.csv", utf(tabs, 2, false, true)));
}

TEST(TableText, AnEncodingBesideTheFile)
{
  // Šumava, in the code page of central Europe.
  const std::string file =
    writeFile("czech.csv", "x,y,height,source\n5,50,0,\x8aumava \xf8\xedmsa\n");
  writeFile("czech.cpg", "1250");
  EXPECT_EQ(read(file).rows.at(0).sourceName, "Šumava římsa");
  const std::string other = writeFile("polish.csv", "x,y,height,source\n5,50,0,\xb3\xb1ka\n");
  writeFile("polish.cpg", "ISO-8859-2\n");
  EXPECT_EQ(read(other).rows.at(0).sourceName, "łąka");
  const std::string third = writeFile("odd.csv", latin1(table));
  writeFile("odd.cpg", "no-such-page");
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { read(third); }), { "odd.csv", ".cpg", "no-such-page" }));
}

TEST(TableText, WhatNoEncodingExplainsIsOneMessage)
{
  // Two encodings in one file; the page of MS-DOS; a byte that is no letter; a zero.
  EXPECT_TRUE(holds(failure("x,y,height,source\n5,50,0,Höhle\n6,51,0,H\xf6hle\n"),
    { "table.csv, line 3", "not UTF-8 as others are" }));
  EXPECT_TRUE(holds(
    failure("x,y,height,source\n5,50,0,H\x94hle\n"), { "table.csv, line 2", "H”hle", "no word" }));
  EXPECT_TRUE(holds(failure("x,y,height,source\n5,50,0,a\n6,50,0,M\x81ller\n"),
    { "table.csv, line 3", "neither UTF-8", ".cpg" }));
  EXPECT_TRUE(holds(failure(std::string("x,y,height,source\n5,50,0,a\0b\n", 29)),
    { "table.csv, line 2", "byte 0" }));
}

TEST(TableText, ClassesInLatin1AreThoseOfAMapInUtf8)
{
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string zones =
    writeFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\",GERÖLL\n");
  const std::string presets = writeFile("t.csv", latin1("class,preset\nGeröll,talus\n"));
  std::vector<std::string> notes;
  const MaterialClasses classes =
    readGround(GroundKind::Restitution, { zones, presets, "" }, terrain, notes);
  EXPECT_EQ(classes.names.at(0), "Geröll");
  EXPECT_NE(notes.front().find("t.csv: The table is not UTF-8"), std::string::npos)
    << notes.front();
}

TEST(TableText, ALineThatSaysTheSeparator)
{
  for (const char* line : { "sep=;\n", "SEP=;\r\n", "\"sep=;\"\n", "\xef\xbb\xbfsep=;\n" })
  {
    std::string cells = table;
    std::replace(cells.begin(), cells.end(), ',', ';');
    expectNames(writeFile("sep.csv", line + cells));
  }
  // A separator that nobody would guess, a comma in the header, quotes in a cell.
  const SourceLayer layer = read(writeFile(
    "colon.csv", "sep=:\nx:y:height:\"note, if any\":source\n5:50:0:\"a \"\"b\"\": c\":cliff\n"));
  EXPECT_EQ(layer.rows.at(0).position.y(), 50.0);
  EXPECT_EQ(layer.rows.at(0).sourceName, "cliff");
}

TEST(TableText, CommentsAndBlankLinesAboveTheHeader)
{
  expectNames(writeFile("head.csv", "# survey of 2021\n#\n\n// by hand\n" + table));
  const std::vector<std::string> notes =
    read(writeFile("head.csv", "# survey of 2021\n" + table)).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(holds(notes[0], { "head.csv", "1 line that begins with #" }));
}

TEST(TableText, CommentsAmongRows)
{
  expectNames(
    writeFile("rows.csv", "x,y,height,source\n5,50,0,Höhle\n# not sure of this\n6,51,1,Éboulis\n"));
  // A row that was put out of use, or one of a numbering? Nobody knows.
  EXPECT_TRUE(holds(failure("source,x,y,height\na,5,50,0\n#b,6,51,0\nc,7,52,0\n"),
    { "table.csv, line 3", "comment or a row" }));
  const SourceLayer numbered =
    read(writeFile("numbered.csv", "source,x,y,height\n#1,5,50,0\n#2,6,51,1\n"));
  ASSERT_EQ(numbered.rows.size(), 2u);
  EXPECT_EQ(numbered.rows[1].sourceName, "#2");
}

TEST(TableText, AHeaderThatIsAComment)
{
  const SourceLayer layer =
    read(writeFile("named.csv", "# points\n# x, y, height\n5,50,0\n6,51,1\n"));
  ASSERT_EQ(layer.rows.size(), 2u);
  EXPECT_EQ(layer.rows[1].position.y(), 51.0);
  EXPECT_EQ(layer.rows[1].height, 1.0);
}

TEST(TableText, TextOfOtherFormatsThatIsNoUtf8)
{
  const std::string file = writeFile("latin.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"source":"H)"
    "\xf6"
    R"(hle"},"geometry":{"type":"Point","coordinates":[5,50]}}]})");
  EXPECT_NE(messageOf<Error>([&] { read(file); }).find("latin.geojson"), std::string::npos);
}

TEST(Sheets, AllCellsAreText)
{
  const Rows rows = { { "x", "y", "height", "source" }, { "5", "50", "0", "Höhle" },
    { "6", "51", "1", "Éboulis" } };
  expectNames(writeXlsx("t.xlsx", { { "Tabelle1", rows } }));
  expectNames(writeOds("t.ods", { { "Tabelle1", rows } }));
}

TEST(Sheets, TablesOfClassesAndContacts)
{
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string zones =
    writeFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\",scree\n");
  const Sheets presets = { { "Blatt", { { "class", "preset" }, { "scree", "talus" } } } };
  for (const std::string& file : { writeXlsx("t.xlsx", presets), writeOds("t.ods", presets) })
  {
    std::vector<std::string> notes;
    EXPECT_EQ(readGround(GroundKind::Restitution, { zones, file, "" }, terrain, notes).names.at(0),
      "scree");
  }
  const std::vector<std::string> materials = { "a" };
  const auto pairs = readRockContacts(
    writeXlsx("c.xlsx",
      { { "Blatt",
        { { "material_a", "material_b", "restitution", "phi" }, { "a", "a", "0.5", "30" } } } }),
    0.0, materials);
  EXPECT_EQ(pairs.at(0).contact.restitution, 0.5);
}

TEST(Sheets, OneOfSeveral)
{
  const Rows notes = { { "remark", "date" }, { "hot", "2021" } };
  const Rows good = { { "class", "preset" }, { "scree", "talus" } };
  const Rows other = { { "class", "preset" }, { "scree", "rock" } };
  const Terrain terrain = makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
  const std::string zones =
    writeFile("zones.csv", "WKT,class\n\"POLYGON((0 0,100 0,100 100,0 100,0 0))\",scree\n");
  const auto restitution = [&](const std::string& file, const std::string& sheet)
  {
    GroundFiles files{ zones, file, "" };
    files.tableSheet = sheet;
    std::vector<std::string> told;
    const double value =
      readGround(GroundKind::Restitution, files, terrain, told).materials.at(0).restitution;
    return std::pair(value, told.front());
  };
  const auto [only, note] =
    restitution(writeOds("t.ods", { { "Notizen", notes }, { "b", good } }), "");
  EXPECT_EQ(only, groundPreset("talus").normalRestitution);
  EXPECT_TRUE(holds(note, { "t.ods", "\"Notizen\"", "\"b\" was taken", "RestitutionTableSheet" }));
  const std::string both =
    writeXlsx("t.xlsx", { { "old", other }, { "Neu Ä", good }, { "Notizen", notes } });
  EXPECT_TRUE(holds(messageOf<DataError>([&] { restitution(both, ""); }),
    { "t.xlsx", "2 layers that would do", "\"old\", \"Neu Ä\"", "RestitutionTableSheet" }));
  EXPECT_EQ(restitution(both, "neu ä").first, groundPreset("talus").normalRestitution);
  EXPECT_EQ(restitution(both, "old").first, 0.53);
  EXPECT_TRUE(holds(messageOf<DataError>([&] { restitution(both, "none"); }),
    { "no layer \"none\"", "\"old\"", "\"Notizen\"" }));
}
