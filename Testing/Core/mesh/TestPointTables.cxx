// Tables of points: columns by their header, decimal commas read or refused and never split.

#include "base/errors.h"
#include "mesh/pointTable.h"
#include "meshTexts.h"

#include <gtest/gtest.h>

using namespace rockfall;
using meshTexts::print;

namespace
{

const std::vector<Vec3> points = { { 12.4, 33.75, 5.125 }, { 13.6, 33.5, 5.25 },
  { 12.5, 34.25, 5.5 }, { 12.75, 33.25, 6.125 }, { 12.625, 33.875, 5.875 } };

/// A line for each point, decimal points becoming `mark`.
std::string table(const std::string& header, const char* format, char mark = '.')
{
  std::string text;
  int number = 0;
  for (const Vec3& p : points)
  {
    text += print(format, p.x(), p.y(), p.z(), ++number);
  }
  for (char& c : text)
  {
    c = c == '.' ? mark : c;
  }
  return header + text;
}

void expectPoints(const std::string& text)
{
  SCOPED_TRACE(text.substr(0, 80));
  const Mesh mesh = parsePointTable(text, "table");
  ASSERT_EQ(mesh.points.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    EXPECT_TRUE(mesh.points[k].isApprox(points[k], 1e-12)) << mesh.points[k].transpose();
  }
}

void expectError(const std::string& text, const std::vector<std::string>& words)
{
  try
  {
    const Mesh mesh = parsePointTable(text, "table");
    ADD_FAILURE() << "read as " << mesh.points[0].transpose() << ": " << text.substr(0, 80);
  }
  catch (const Error& error)
  {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("table", 0), 0u) << message;
    for (const std::string& word : words)
    {
      EXPECT_NE(message.find(word), std::string::npos) << word << " is not in " << message;
    }
  }
}

std::string utf16(const std::string& text, bool big)
{
  std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text)
  {
    wide += big ? std::string({ '\0', c }) : std::string({ c, '\0' });
  }
  return wide;
}

} // namespace

TEST(PointTables, ColumnsAreThoseThatTheHeaderNames)
{
  expectPoints(table("x,y,z\n", "%.3f,%.3f,%.3f\n"));
  expectPoints(table("Nr,X,Y,Z\n", "%4$d,%1$.3f,%2$.3f,%3$.3f\n"));
  expectPoints(table("gps_time,x,y,z\n", "100%4$d.25,%1$.3f,%2$.3f,%3$.3f\n"));
  expectPoints(table("z,y,x\n", "%3$.3f,%2$.3f,%1$.3f\n"));
  expectPoints(table("id;Northing;Easting;Height\n", "%4$d;%2$.3f;%1$.3f;%3$.3f\n"));
  expectPoints(table("\"X [m]\",\"Y [m]\",\"Z [m]\",\"R\"\n", "%.3f,%.3f,%.3f,255\n"));
  expectPoints(table("//X Y Z R\n", "%.3f %.3f %.3f 12\n"));
  expectPoints(table("# z y x\n", "%3$.3f %2$.3f %1$.3f\n"));
  expectPoints(table("Points_0,Points_1,Points_2,n\n", "%.3f,%.3f,%.3f,%d\n"));
  expectPoints(table("Point name\tX\tY\tZ\n", "P %4$d\t%1$.3f\t%2$.3f\t%3$.3f\n"));
  expectPoints(table("code,x,y,z,remark\n", "top,%.3f,%.3f,%.3f,\n"));
}

TEST(PointTables, AHeaderThatNamesNoAxesIsAnError)
{
  expectError(table("a,b,c\n", "%.3f,%.3f,%.3f\n"), { "line 1", "\"a\", \"b\", \"c\"" });
  expectError(table("lon,lat,h\n", "%.3f,%.3f,%.3f\n"), { "\"lon\"" });
  expectError(table("points of block 7\n", "%.3f %.3f %.3f\n"), { "line 1" });
  expectError(table("x,y,z,X\n", "%.3f,%.3f,%.3f,1\n"), { "two columns \"x\"" });
  expectError(table("x [ft],y [ft],z [ft]\n", "%.3f,%.3f,%.3f\n"), { "ft", "metres" });
  expectError(table("x_mm,y_mm,z_mm\n", "%.3f,%.3f,%.3f\n"), { "mm" });
}

TEST(PointTables, DecimalCommasAreReadWhereNoCommaPartsTheColumns)
{
  expectPoints(table("x;y;z\n", "%.3f;%.3f;%.3f\n", ','));
  expectPoints(table("", "%.3f %.3f %.3f\n", ','));
  expectPoints(table("", "%.3f\t%.3f\t%.3f\n", ','));
  expectPoints(table("X\tY\tZ\n", "%.3f\t%.3f\t%.3f\n", ','));
  expectPoints(table("sep=;\nx;y;z\n", "%.3f;%.3f;%.3f\n", ','));
  expectPoints(table("", "  %.3f   %.3f \t %.3f  \n", ','));
  std::string inQuotes = table("x,y,z\n", "\"%.3f\",\"%.3f\",\"%.3f\"\n");
  for (std::size_t k = 6; k < inQuotes.size(); ++k)
  {
    inQuotes[k] = inQuotes[k] == '.' ? ',' : inQuotes[k];
  }
  expectPoints(inQuotes);
}

TEST(PointTables, DecimalCommasThatNobodyCanTellAreErrors)
{
  expectError(table("x,y,z\n", "%.3f,%.3f,%.3f\n", ','), { "line 2", "6 columns", "point" });
  expectError(table("", "%.3f,%.3f,%.3f\n", ','), { "6 whole numbers", "decimal commas" });
  expectError(table("", "%.3f, %.3f, %.3f\n", ','), { "line 1", "semicolons" });
  expectError("1.234,5;2.345,5;3\n", { "line 1" });
  expectError("x;y;z\n1,234,567;2;3\n", { "line 2", "1,234,567" });
  expectError("x;y;z\n1,5;2,5;3\n1.5;2.5;3\n", { "line 3", "decimal point" });
}

TEST(PointTables, WithoutAHeaderTheFirstThreeAreTakenAndANoteSaysSo)
{
  expectPoints(table("", "%.3f,%.3f,%.3f\n"));
  expectPoints(table("", "%.3f, %.3f, %.3f\n"));
  expectPoints(table("# a comment\n\n% and another\n", "%.3f %.3f %.3f\n"));
  const std::string coloured = table("", "%.3f %.3f %.3f 10 20 30\n");
  expectPoints(coloured);
  const Mesh mesh = parsePointTable(coloured, "table");
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("first three of its 6 columns"), std::string::npos);
  // A first column of 1, 2, 3 … is a number of the point.
  expectError(table("", "%4$d %1$.3f %2$.3f %3$.3f\n"), { "counts the points", "x, y and z" });
}

TEST(PointTables, EncodingsAndLineEnds)
{
  const std::string plain = table("x,y,z\n", "%.3f,%.3f,%.3f\n");
  expectPoints("\xEF\xBB\xBF" + plain);
  expectPoints(utf16(plain, false));
  expectPoints(utf16(plain, true));
  std::string mac = plain, windows;
  for (char& c : mac)
  {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
    c = c == '\n' ? '\r' : c;
  }
  expectPoints(windows);
  expectPoints(mac);
  expectPoints(table("h\xF6he,x,y,z\n", "1,%.3f,%.3f,%.3f\n")); // Latin-1
  expectPoints(table("Punkt;Rechtswert;Hochwert;H\xF6he\n", "%4$d;%1$.3f;%2$.3f;%3$.3f\n"));
  expectPoints(utf16(plain, false).substr(2)); // without a mark that says so
  expectPoints(utf16(plain, true).substr(2));
  EXPECT_EQ(parsePointTable(utf16(plain, true).substr(2), "table").notes.size(), 1u);
  // Of several encodings, or no text at all.
  expectError(table("h\xC3\xB6he,x,y,z,w\n", "1,%.3f,%.3f,%.3f,\xF6\n"), { "line 2", "UTF-8" });
  std::string holed = plain;
  holed[plain.size() / 2] = '\0';
  expectError(holed, { "byte 0" });
}

TEST(PointTables, BadLinesAreNamed)
{
  expectError("x,y,z\n0,0,0\n1,two,3\n", { "line 3", "\"1,two,3\"", "\"two\"" });
  expectError("1 2\n", { "line 1", "three numbers" });
  expectError("x,y,z\n1,2,3\n1,2\n", { "line 3" });
  expectError("x,y,z\n1,,3\n", { "line 2" });
  expectError("1 2 3\n4 5 6 7\n", { "line 2", "4 columns" });
  expectError("1.0D+03 2 3\n", { "line 1" });
  expectError("", { "no points" });
  expectError("x,y,z\n", { "no points" });
}
