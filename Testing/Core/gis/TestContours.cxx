// Contour lines of slopes with a closed form: what the TIN makes of them, and what is left of its
// terraces.
#include "base/errors.h"
#include "form.h"
#include "gis/raster/contours.h"
#include "gisFiles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

struct Point
{
  double x, y;
};

struct Contour
{
  double height;
  std::vector<Point> points;
};

constexpr char utm[] = "urn:ogc:def:crs:EPSG::32632";

/// `property`: its name; empty for lines with a z of their own.
std::string geoJson(const std::vector<Contour>& contours, const std::string& property = "ELEV",
  const std::string& crs = utm, const std::string& name = "contours.geojson")
{
  std::string text = "{\"type\":\"FeatureCollection\",";
  text +=
    crs.empty() ? "" : "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"" + crs + "\"}},";
  text += "\"features\":[";
  for (std::size_t i = 0; i < contours.size(); ++i)
  {
    text += i ? ",\n" : "\n";
    text += "{\"type\":\"Feature\",\"properties\":{";
    if (!property.empty())
    {
      text += "\"" + property + "\":" + exactText(contours[i].height);
    }
    text += "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[";
    for (std::size_t k = 0; k < contours[i].points.size(); ++k)
    {
      const Point& p = contours[i].points[k];
      text += k ? ",[" : "[";
      text += exactText(p.x) + "," + exactText(p.y);
      if (property.empty())
      {
        text += "," + exactText(contours[i].height);
      }
      text += "]";
    }
    text += "]}}";
  }
  return writeFile(name, text + "]}");
}

constexpr double east = 600000.0, north = 5100000.0; // of the middle

/// Circles of a hill that falls with the distance from its top: radius of a height.
std::vector<Contour> circles(
  const std::vector<double>& heights, const std::function<double(double)>& radius)
{
  std::vector<Contour> contours;
  for (const double height : heights)
  {
    Contour contour{ height, {} };
    const int corners = 180;
    for (int k = 0; k <= corners; ++k)
    {
      const double angle = 2.0 * std::numbers::pi * (k % corners) / corners;
      contour.points.push_back(
        { east + radius(height) * std::cos(angle), north + radius(height) * std::sin(angle) });
    }
    contours.push_back(contour);
  }
  return contours;
}

std::vector<double> steps(double first, double last, double interval)
{
  std::vector<double> result;
  for (int k = 0; first + k * interval <= last + 1e-9; ++k)
  {
    result.push_back(first + k * interval);
  }
  return result;
}

struct Misfit
{
  double largest = 0.0, rms = 0.0; ///< m
  double level = 0.0;              ///< Share of the CFE pairs along x that are level.
};

Misfit misfitOf(const RasterSurface& surface, const std::function<double(double, double)>& height)
{
  const GridGeometry& g = surface.geometry;
  Misfit misfit;
  std::int64_t count = 0, pairs = 0, level = 0;
  for (int row = 0; row < g.rows; ++row)
  {
    for (int column = 0; column < g.columns; ++column)
    {
      const double z = surface.heights[std::size_t(row) * g.columns + column];
      const double next = column + 1 < g.columns
        ? surface.heights[std::size_t(row) * g.columns + column + 1]
        : std::nan("");
      if (!std::isnan(z) && !std::isnan(next))
      {
        ++pairs;
        level += z == next;
      }
      if (std::isnan(z))
      {
        continue;
      }
      const double x = g.xOrigin + column * g.cellSize - east;
      const double y = g.yOrigin + (g.rows - 1 - row) * g.cellSize - north;
      const double error = std::abs(z - height(x, y));
      misfit.largest = std::max(misfit.largest, error);
      misfit.rms += error * error;
      ++count;
    }
  }
  misfit.rms = std::sqrt(misfit.rms / double(count));
  misfit.level = double(level) / double(pairs);
  return misfit;
}

struct BeforeAfter
{
  Misfit before, after;
};

BeforeAfter compare(
  const std::string& file, double cell, const std::function<double(double, double)>& height)
{
  BeforeAfter result;
  result.before = misfitOf(readContours(file, { .cellSize = cell, .relaxFlats = false }), height);
  result.after = misfitOf(readContours(file, { .cellSize = cell }), height);
  std::cout << "before: largest " << result.before.largest << " m, rms " << result.before.rms
            << " m, level " << result.before.level << "; after: largest " << result.after.largest
            << " m, rms " << result.after.rms << " m, level " << result.after.level << "\n";
  return result;
}

std::string message(const std::string& file, const ContourOptions& options = {})
{
  return messageOf<DataError>([&] { readContours(file, options); });
}

std::vector<Contour> smallHill()
{
  return circles({ 10.0, 20.0, 30.0 }, [](double z) { return 50.0 - z; });
}

} // namespace

// A cone of 1 in 2 with its top 10 m above the last contour.
TEST(Contours, Cone)
{
  const auto height = [](double x, double y) { return 100.0 - 0.5 * std::hypot(x, y); };
  const std::string file =
    geoJson(circles(steps(0.0, 90.0, 10.0), [](double z) { return 2.0 * (100.0 - z); }));
  const BeforeAfter cone = compare(file, 2.0, height);
  // The TIN's top is cut off at the last contour: one interval. A plate that joins the contour with
  // the slope s around it rises by s R / 2 = 5 m, half of the cone: nothing says that the top is
  // sharp.
  EXPECT_NEAR(cone.before.largest, 10.0, 0.1);
  EXPECT_LT(cone.after.largest, 5.5);
  EXPECT_LT(cone.after.rms, 0.5 * cone.before.rms);
}

// A Gaussian hill: smooth, as ground is.
TEST(Contours, GaussianHill)
{
  const auto height = [](double x, double y)
  { return 100.0 * std::exp(-(x * x + y * y) / (2.0 * 60.0 * 60.0)); };
  const std::string file = geoJson(circles(
    steps(8.0, 92.0, 12.0), [](double z) { return 60.0 * std::sqrt(2.0 * std::log(100.0 / z)); }));
  const BeforeAfter hill = compare(file, 2.0, height);
  EXPECT_NEAR(hill.before.largest, 8.0, 0.1); // 100 − 92
  // What is left is that the TIN is straight between contours: 1/8 of the square of their distance
  // (19 m) times the curvature (100/60² per m) is 1.3 m; the top has no part in it any more.
  EXPECT_LT(hill.after.largest, 1.7);
  EXPECT_LT(hill.after.rms, 0.75 * hill.before.rms);
  EXPECT_LT(hill.after.level, 0.2 * hill.before.level + 1e-3);
}

// A valley that falls along its axis: flat triangles fill the noses of its contours.
TEST(Contours, ValleyFallsAllTheWay)
{
  const auto height = [](double x, double y) { return 0.2 * (x + 300.0) + 0.02 * y * y; };
  std::vector<Contour> contours;
  for (const double z : steps(0.0, 120.0, 10.0))
  {
    Contour contour{ z, {} };
    for (int k = -40; k <= 40; ++k)
    {
      const double y = 1.5 * k;
      contour.points.push_back({ east + (z - 0.02 * y * y) / 0.2 - 300.0, north + y });
    }
    contours.push_back(contour);
  }
  const std::string file = geoJson(contours);
  const auto thalweg = [&](bool relax)
  {
    // The lowest fall over 4 m along the axis, between contours: of the closed form it is 0.8 m.
    const RasterSurface s = readContours(file, { .cellSize = 2.0, .relaxFlats = relax });
    const GridGeometry& g = s.geometry;
    const int row = g.rows - 1 - int(std::lround((north - g.yOrigin) / g.cellSize));
    double least = 1e9, largest = 0.0;
    for (int column = 0; column + 2 < g.columns; ++column)
    {
      const double x = g.xOrigin + column * g.cellSize - east;
      if (x > -250.0 && x < 250.0)
      {
        const double* z = &s.heights[std::size_t(row) * g.columns + column];
        least = std::min(least, z[2] - z[0]);
        largest = std::max(largest, std::abs(z[0] - height(x, 0.0)));
      }
    }
    std::cout << "thalweg: least fall in 4 m " << least << " m, largest error " << largest
              << " m\n";
    return std::pair(least, largest);
  };
  const auto before = thalweg(false), after = thalweg(true);
  EXPECT_LT(before.first, 1e-9); // level: a rock would stop here
  EXPECT_GT(after.first, 0.1);
  EXPECT_LT(after.second, 0.5 * before.second);
}

// The contours themselves are kept: every vertex has its height in the raster.
TEST(Contours, ContoursKeepTheirHeights)
{
  // Squares with vertices on the nodes.
  std::vector<Contour> contours;
  for (int k = 0; k < 5; ++k)
  {
    const double r = 50.0 - 10.0 * k;
    contours.push_back({ 10.0 * k,
      { { east - r, north - r }, { east + r, north - r }, { east + r, north + r },
        { east - r, north + r }, { east - r, north - r } } });
  }
  const RasterSurface s = readContours(geoJson(contours), { .cellSize = 5.0 });
  ASSERT_EQ(s.geometry.columns, 21);
  ASSERT_EQ(s.geometry.rows, 21);
  EXPECT_EQ(s.geometry.xOrigin, east - 50.0);
  EXPECT_EQ(s.geometry.yOrigin, north - 50.0);
  for (int row = 0; row < 21; ++row)
  {
    for (int column = 0; column < 21; ++column)
    {
      const int ring = std::min({ row, column, 20 - row, 20 - column });
      if (ring % 2 == 0 && ring < 10)
      {
        EXPECT_NEAR(s.heights[std::size_t(row) * 21 + column], 5.0 * ring, 1e-9)
          << row << " " << column;
      }
    }
  }
  const double top = s.heights[10 * 21 + 10];
  EXPECT_GT(top, 42.0);
  EXPECT_LE(top, 50.0); // or there would be a contour
}

TEST(Contours, WideFlatsAreSolvedFromCoarseToFine)
{
  // The top of this hill has 270,000 nodes within its last contour; in the small form 10,000.
  const double cellSize = isSmallForm() ? 15.0 : 3.0;
  const auto height = [](double x, double y) { return 100.0 - 1e-4 * (x * x + y * y); };
  const std::string file = geoJson(
    circles({ 0.0, 8.0, 16.0, 24.0 }, [](double z) { return 100.0 * std::sqrt(100.0 - z); }));
  const RasterSurface s = readContours(file, { .cellSize = cellSize });
  // The paraboloid's own bounds: no more than one interval (8 m) above the last contour.
  double highest = 0.0;
  for (std::size_t i = 0; i < s.heights.size(); ++i)
  {
    if (!std::isnan(s.heights[i]))
    {
      highest = std::max(highest, s.heights[i]);
      const int row = int(i) / s.geometry.columns, column = int(i) % s.geometry.columns;
      const double x = s.geometry.xOrigin + column * s.geometry.cellSize - east;
      const double y =
        s.geometry.yOrigin + (s.geometry.rows - 1 - row) * s.geometry.cellSize - north;
      if (height(x, y) < 23.0)
      {
        EXPECT_NEAR(
          s.heights[i], height(x, y), 0.5); // 1/8 · 420² m² · 2e-4/m is 4 m at most inside
      }
    }
  }
  EXPECT_LE(highest, 32.0);
  EXPECT_GT(highest, 31.0);
}

TEST(Contours, LinesWithTheirOwnHeights)
{
  const RasterSurface field = readContours(geoJson(smallHill()), { .cellSize = 2.0 });
  const RasterSurface own =
    readContours(geoJson(smallHill(), "", utm, "z.geojson"), { .cellSize = 2.0 });
  ASSERT_EQ(field.heights.size(), own.heights.size());
  for (std::size_t i = 0; i < own.heights.size(); ++i)
  {
    EXPECT_TRUE(field.heights[i] == own.heights[i] ||
      (std::isnan(field.heights[i]) && std::isnan(own.heights[i])));
  }
}

TEST(Contours, NamesOfTheField)
{
  for (const char* name : { "elevation", "CONTOUR", "Height", "z" })
  {
    const RasterSurface s = readContours(geoJson(smallHill(), name), { .cellSize = 5.0 });
    EXPECT_TRUE(holds(s.notes.back().empty() ? "" : s.notes[0], { name })) << name;
  }
  const std::string file = geoJson(smallHill(), "hauteur");
  EXPECT_NO_THROW(readContours(file, { .cellSize = 5.0, .elevationField = "Hauteur" }));
  EXPECT_TRUE(holds(message(file), { file, "row 1", "hauteur", "ElevationField" }));
  EXPECT_TRUE(holds(message(file, { .elevationField = "hoogte" }), { file, "hoogte", "hauteur" }));
}

TEST(Contours, WhatTheHeightIsMustBePlain)
{
  const std::string two = writeFile("two.csv",
    "WKT,level,contour_m\n\"LINESTRING(0 0,50 0)\",1,510\n\"LINESTRING(0 30,50 30)\",2,520\n");
  EXPECT_TRUE(holds(message(two), { two, "\"contour_m\"", "\"level\"", "ElevationField" }));
  EXPECT_NO_THROW(readContours(two, { .elevationField = "contour_m" }));
  const auto solid = [](const std::string& heights, const std::string& name)
  {
    return writeFile(name,
      "WKT,level\n\"LINESTRING Z(0 0 510,50 0 510)\"," + heights.substr(0, 3) +
        "\n\"LINESTRING Z(0 30 520,50 30 520)\"," + heights.substr(3) + "\n");
  };
  const std::string labels = solid("1  2  ", "labels.csv");
  EXPECT_TRUE(holds(message(labels), { labels, "row 1", "z is 510", "\"level\" 1" }));
  EXPECT_NO_THROW(readContours(labels, { .elevationField = "level" }));
  EXPECT_NO_THROW(readContours(solid("510520", "same.csv")));
  const std::string feet = writeFile(
    "feet.csv", "WKT,elev_feet\n\"LINESTRING(0 0,50 0)\",100\n\"LINESTRING(0 30,50 30)\",200\n");
  const RasterSurface surface =
    readContours(feet, { .cellSize = 10.0, .elevationField = "elev_feet" });
  EXPECT_NEAR(surface.heights.back(), 30.48, 1e-9);
}

TEST(Contours, FeetBecomeMetres)
{
  const RasterSurface metres = readContours(geoJson(smallHill()), { .cellSize = 2.0 });
  for (const char* name :
    { "elev_ft", "Elevation (ft)", "elevFeet", "contour in feet", "ELEV_FT_MSL" })
  {
    const RasterSurface feet = readContours(geoJson(smallHill(), name), { .cellSize = 2.0 });
    EXPECT_TRUE(holds(feet.notes[0], { "0.3048" })) << name;
    ASSERT_EQ(metres.heights.size(), feet.heights.size());
    for (std::size_t i = 0; i < feet.heights.size(); ++i)
    {
      if (!std::isnan(metres.heights[i]))
      {
        // The plate is linear in the heights.
        EXPECT_NEAR(feet.heights[i], 0.3048 * metres.heights[i], 1e-6) << name;
      }
    }
  }
}

TEST(Contours, UnitInTheNameOfAnyField)
{
  for (const auto& [name, metres] :
    { std::pair("foo (ft)", 0.3048), std::pair("foo_usft", 1200.0 / 3937.0),
      std::pair("foo [cm]", 0.01), std::pair("foo_dm", 0.1), std::pair("foo [NHN]", 1.0) })
  {
    const RasterSurface s =
      readContours(geoJson(smallHill(), name), { .cellSize = 2.0, .elevationField = name });
    const RasterSurface plain = readContours(geoJson(smallHill()), { .cellSize = 2.0 });
    ASSERT_EQ(s.heights.size(), plain.heights.size());
    const std::size_t middle = s.heights.size() / 2;
    EXPECT_NEAR(s.heights[middle], metres * plain.heights[middle], 1e-6) << name;
  }
}

TEST(Contours, CellSizeOfItsOwn)
{
  // Rings 10 m apart; the mean distance between lines A/Σl over the square around the outer ring.
  const RasterSurface s = readContours(geoJson(smallHill()));
  const double area = 80.0 * 80.0, length = 2.0 * std::numbers::pi * (40.0 + 30.0 + 20.0);
  EXPECT_NEAR(s.geometry.cellSize, area / (2.0 * length), 0.01); // three digits
}

TEST(Contours, AnglesAreReprojected)
{
  std::vector<Contour> contours = smallHill();
  for (Contour& contour : contours)
  {
    for (Point& p : contour.points)
    {
      p = { 9.0 + (p.x - east) / 76000.0, 46.0 + (p.y - north) / 111000.0 };
    }
  }
  const RasterSurface s =
    readContours(geoJson(contours, "ELEV", "urn:ogc:def:crs:OGC:1.3:CRS84"), { .cellSize = 2.0 });
  EXPECT_TRUE(holds(s.geometry.crs, { "UTM zone 32N" }));
  EXPECT_NEAR(s.geometry.xOrigin, 500000.0 - 40.0, 2.0); // 9° E is the zone's middle
  EXPECT_NEAR(s.geometry.columns, 41, 2);                // 80 m
  EXPECT_TRUE(holds(s.notes[0], { "Reprojected", "angles" }));
}

TEST(Contours, DecimalCommasChangeNothing)
{
  const std::string table = "WKT,elevation\n"
                            "\"LINESTRING(600000 5100000,600050.5 5100000)\",10.5\n"
                            "\"LINESTRING(600000 5100030,600050.5 5100030)\",20.25\n";
  const std::string file = writeFile("contours.csv", table);
  const RasterSurface plain = readContours(file, { .cellSize = 5.0 });
  const CommaLocale commas;
  const RasterSurface s = readContours(file, { .cellSize = 5.0 });
  EXPECT_EQ(s.heights, plain.heights);
  EXPECT_DOUBLE_EQ(s.heights.front(), 20.25);
  EXPECT_DOUBLE_EQ(s.heights.back(), 10.5);
}

TEST(Contours, CrossingContoursAreNamed)
{
  const RasterSurface s =
    readContours(geoJson({ { 10.0, { { east, north }, { east + 50.0, north } } },
                   { 20.0, { { east, north + 50.0 }, { east, north } } },
                   { 30.0, { { east + 50.0, north + 50.0 }, { east + 10.0, north + 50.0 } } } }),
      { .cellSize = 5.0 });
  EXPECT_TRUE(holds(s.notes[0], { "10 m and 20 m", "600000, 5100000" }));
}

// A line without a height among others, and a shore of the sea.
TEST(Contours, ZeroAmongOthersIsNoted)
{
  const auto noted = [](std::vector<Contour> contours)
  {
    const RasterSurface s = readContours(geoJson(contours), { .cellSize = 5.0 });
    return std::any_of(s.notes.begin(), s.notes.end(),
      [](const std::string& note)
      { return note.find("exactly 0 m") != std::string::npos && holds(note, { "no height?" }); });
  };
  const auto hill = [](double first)
  { return circles(steps(first, 50.0, 10.0), [](double z) { return 2.0 * (100.0 - z); }); };
  const auto with = [](std::vector<Contour> contours, double radius)
  {
    contours.push_back(circles({ 0.0 }, [radius](double) { return radius; }).front());
    return contours;
  };
  EXPECT_FALSE(noted(hill(0.0)));               // a shore
  EXPECT_FALSE(noted(with(hill(10.0), 200.0))); // the same
  EXPECT_TRUE(noted(with(hill(30.0), 200.0)));  // three steps below the lowest
  EXPECT_FALSE(noted(hill(10.0)));
  EXPECT_FALSE(noted(with(hill(15.0), 200.0))); // one and a half steps below the lowest
}

TEST(ContourErrors, EachNamesWhatIsWrong)
{
  const std::string good = geoJson(smallHill());
  EXPECT_TRUE(holds(messageOf<ParameterError>([&] { readContours(good, { .cellSize = -1.0 }); }),
    { "CellSize", "-1" }));
  EXPECT_TRUE(holds(
    messageOf<FileError>([] { readContours("/no/such/lines.shp"); }), { "/no/such/lines.shp" }));
  EXPECT_TRUE(holds(message(good, { .cellSize = 500.0 }), { good, "500 m", "1 x 1" }));
  EXPECT_TRUE(holds(message(good, { .largestVertices = 100 }), { good, "more than 100 vertices" }));
  EXPECT_TRUE(holds(message(good, { .cellSize = 0.01, .largestVertices = 1000 }),
    { good, "more than 1000 vertices", "larger CellSize" }));

  std::string file = geoJson({ { 10.0, { { east, north }, { east + 9.0, north } } },
                               { 10.0, { { east, north + 9.0 }, { east + 9.0, north + 9.0 } } } },
    "ELEV", utm, "level.geojson");
  EXPECT_TRUE(holds(message(file), { file, "10 m", "ELEV", "no slope" }));
  file = geoJson({ { 10.0, { { 9.0, 46.0 }, { 9.001, 46.0 } } },
                   { 90.0, { { 9.0, 46.001 }, { 9.001, 46.001 } } } },
    "ELEV", "", "degrees.geojson");
  // GeoJSON without a CRS is WGS 84; a table is not.
  file = writeFile("degrees.csv",
    "WKT,elev\n\"LINESTRING(9 46,9.001 46)\",10\n\"LINESTRING(9 46.001,9.001 46.001)\",90\n");
  EXPECT_TRUE(holds(message(file), { file, "no CRS", "9 ... 9.001", "degrees" }));
  file = writeFile("empty.csv", "WKT,elev\n\"LINESTRING EMPTY\",10\n");
  EXPECT_TRUE(holds(message(file), { file, "no line" }));
  file = writeFile(
    "word.csv", "WKT,elev\n\"LINESTRING(0 0,50 0)\",10\n\"LINESTRING(0 30,50 30)\",high\n");
  EXPECT_TRUE(holds(message(file), { file, "row 2", "elev", "high" }));
  file = writeFile(
    "comma.csv", "WKT;elev\n\"LINESTRING(0 0,50 0)\";10,5\n\"LINESTRING(0 30,50 30)\";20,5\n");
  EXPECT_TRUE(holds(message(file), { file, "row 1", "10,5", "decimal sign is a point" }));
  file = writeFile(
    "missing.csv", "WKT,elev\n\"LINESTRING(0 0,50 0)\",10\n\"LINESTRING(0 30,50 30)\",\n");
  EXPECT_TRUE(holds(message(file), { file, "row 2", "elev", "empty" }));
  file =
    writeFile("nan.csv", "WKT,elev\n\"LINESTRING(0 0,50 0)\",nan\n\"LINESTRING(0 30,50 30)\",20\n");
  EXPECT_TRUE(holds(message(file), { file, "row 1", "elev", "nan" }));
  file = writeFile(
    "far.csv", "WKT,elev\n\"LINESTRING(0 0,50 0)\",-99999\n\"LINESTRING(0 30,50 30)\",20\n");
  EXPECT_TRUE(holds(message(file), { file, "row 1", "-99999" }));
  file = writeFile("twice.csv", "WKT,elev,ELEV\n\"LINESTRING(0 0,50 0)\",10,1\n");
  EXPECT_TRUE(holds(message(file), { file, "two columns \"elev\"", "\"ELEV\"" }));
  file = writeFile("points.csv", "WKT,elev\n\"POINT(0 0)\",10\n\"POINT(0 30)\",20\n");
  EXPECT_TRUE(holds(message(file), { file, "POINT", "LINESTRING" }));
  file = writeFile(
    "straight.csv", "WKT,elev\n\"LINESTRING(0 0,50 50)\",10\n\"LINESTRING(60 60,90 90)\",20\n");
  EXPECT_TRUE(holds(message(file), { file, "triangulation" }));
}

TEST(ContourErrors, WhatIsNoLayerOfLines)
{
  const std::string text = writeFile("notes.txt", "no layer at all\n");
  EXPECT_TRUE(
    holds(messageOf<FileError>([&] { readSlope(text, "", {}, {}); }), { text, "is not a raster" }));
  EXPECT_EQ(readSlope(writeAscii({ "1 2", "3 4" }, 2), "", {}, {}).heights.size(), 4u);
  EXPECT_EQ(
    readSlope(geoJson(smallHill()), "", {}, {}).notes, readContours(geoJson(smallHill())).notes);
  EXPECT_TRUE(
    holds(messageOf<FileError>([&] { readContours(text); }), { text, "not a vector layer" }));
}

namespace
{

/// Lines of 600 m and less, 8 m lower every 10 m to the east, each with a vertex at y = 50.
std::vector<Contour> eastward()
{
  std::vector<Contour> contours;
  for (int i = 0; i < 15; ++i)
  {
    const double x = east + 10.0 * i;
    contours.push_back(
      { 600.0 - 8.0 * i, { { x, north }, { x + 1.0, north + 50.0 }, { x, north + 100.0 } } });
  }
  return contours;
}

std::string notesOf(const std::vector<Contour>& contours)
{
  return joined(readContours(geoJson(contours), { .cellSize = 5.0 }).notes);
}

} // namespace

TEST(ContourCrossings, AreToldWithTheirFirstPlace)
{
  std::vector<Contour> contours = eastward();
  EXPECT_EQ(notesOf(contours).find("cross"), std::string::npos);
  // 13 of 14 lines of another height that it crosses between their vertices; the fifteenth is met
  // at a vertex of both. x = 600000.9 m at y = 5100055 m is on the first line.
  contours.push_back({ 560.0, { { east - 5.0, north + 55.0 }, { east + 135.0, north + 55.0 } } });
  EXPECT_TRUE(holds(notesOf(contours),
    { "Contours of different heights cross at 13 places, the first of 560 m and 600 m at 600000.9, "
      "5100055; " }));
  contours.back().points = { { east + 1.0, north + 50.0 }, { east - 8.0, north + 80.0 } };
  const std::string met = notesOf(contours); // at a vertex of the first line
  EXPECT_TRUE(holds(met, { "meet at 1 vertices, the first of 560 m and 600 m" }));
  EXPECT_EQ(met.find("cross"), std::string::npos);
}

TEST(ContourCrossings, AllOfABruteForceCount)
{
  // Waves of 20 heights that cross each other; the count over all pairs of segments.
  std::vector<Contour> contours;
  for (int i = 0; i < 20; ++i)
  {
    Contour wave{ 500.0 + 5.0 * i, {} };
    for (int k = 0; k <= 97; ++k)
    {
      const double x = 3.1 * k;
      wave.points.push_back(
        { east + x, north + 7.3 * i + 6.0 * std::sin(0.05 * x * (1.0 + 0.11 * i)) });
    }
    contours.push_back(wave);
  }
  const auto left = [](const Point& a, const Point& b, const Point& c)
  { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0; };
  int count = 0;
  for (std::size_t i = 0; i < contours.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      const std::vector<Point>&p = contours[i].points, &q = contours[j].points;
      for (std::size_t k = 1; k < p.size(); ++k)
      {
        for (std::size_t l = 1; l < q.size(); ++l)
        {
          count += left(p[k - 1], p[k], q[l - 1]) != left(p[k - 1], p[k], q[l]) &&
            left(q[l - 1], q[l], p[k - 1]) != left(q[l - 1], q[l], p[k]);
        }
      }
    }
  }
  ASSERT_GT(count, 20);
  EXPECT_TRUE(holds(notesOf(contours), { "cross at " + std::to_string(count) + " places" }));
}
