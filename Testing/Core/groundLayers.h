#pragma once

/// @file
/// A level slope of 8 × 6 cells and layers of classes of ground on it.

#include "gis/raster/ground.h"
#include "gisFiles.h"

#include <string>
#include <vector>

namespace rockfall::testing::ground
{

constexpr double west = 600000.0, south = 5100000.0;

/// 8 × 6 cells of 10 m, level, in UTM 32N unless said otherwise.
inline Terrain slope(const std::string& crs = "EPSG:32632", SurfaceMaterial material = {})
{
  GridGeometry g;
  g.columns = 9;
  g.rows = 7;
  g.cellSize = 10.0;
  g.xOrigin = west;
  g.yOrigin = south;
  g.crs = crs;
  return Terrain(g, std::vector<double>(63, 0.0), material);
}

/// Classes 1 in the western half and 2 in the eastern one, at half the terrain's cell.
inline RawRaster halves(double first = 1.0, double second = 2.0)
{
  RawRaster raster;
  raster.columns = 16;
  raster.rows = 12;
  raster.affine = { west, 5.0, 0.0, south + 60.0, 0.0, -5.0 };
  raster.crs = "EPSG:32632";
  raster.type = "Byte";
  raster.fill([&](double x, double) { return x < west + 40.0 ? first : second; });
  return raster;
}

inline std::string table(const std::string& text = "class,name,rv,rv_deviation\n1,rock,0.9,0.05\n"
                                                   "2,talus,0.5,0.1\n",
  const std::string& name = "table.csv")
{
  return writeFile(name, text);
}

inline MaterialClasses read(const GroundFiles& files, const Terrain& terrain,
  GroundKind kind = GroundKind::Restitution, std::vector<std::string>* notes = nullptr)
{
  std::vector<std::string> own;
  return readGround(kind, files, terrain, notes ? *notes : own);
}

inline std::string failure(const GroundFiles& files, GroundKind kind = GroundKind::Restitution)
{
  const Terrain terrain = slope();
  return messageOf<DataError>([&] { read(files, terrain, kind); });
}

inline std::string polygons(const std::string& features, const std::string& crs = "EPSG::32632",
  const std::string& name = "zones.geojson")
{
  return writeFile(name,
    "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":"
    "\"urn:ogc:def:crs:" +
      crs + "\"}},\"features\":[" + features + "]}");
}

inline std::string box(double x0, double y0, double x1, double y1, const std::string& properties)
{
  const auto corner = [](double x, double y)
  { return "[" + exactText(x) + "," + exactText(y) + "]"; };
  return "{\"type\":\"Feature\",\"properties\":{" + properties +
    "},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[" + corner(x0, y0) + "," +
    corner(x1, y0) + "," + corner(x1, y1) + "," + corner(x0, y1) + "," + corner(x0, y0) + "]]}}";
}

/// Classes as a grid of text on the slope's cells; `first` is its northern row.
inline std::string textClasses(const std::string& corner, const std::string& first)
{
  std::vector<std::string> lines(6, "1 1 1 1 2 2 2 2");
  lines.front() = first;
  return writeAscii(lines, 8, corner);
}

} // namespace rockfall::testing::ground
