// Writes whole files for a reader to begin with: fuzzSeeds FuzzMesh folder

#include "meshTexts.h"

#include <filesystem>
#include <fstream>
#include <iostream>

using namespace meshTexts;

namespace
{

/// Behind the byte that says which format.
std::vector<std::string> meshes()
{
  const std::vector<Vec3> points = corners(Vec3(1, 2, 3));
  const std::string strips =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n";
  return { '\0' + ply(points, "ascii"), '\0' + ply(points, "binary_little_endian"),
    '\0' + ply(points, "binary_big_endian", "float"), '\0' + strips, '\1' + stlText(points),
    '\1' + stlBytes(points), '\2' + objText(points) };
}

std::vector<std::string> pointTables()
{
  return { "x,y,z\n1,2,3\n4,5,6\n", "x;y;z\n1,5;2,5;3,5\n", "1,5 2,5 3,5\n", "1, 2, 3\n",
    "sep=;\nNr;\"X [m]\";Y;Z\n1;2;3;4\n", "# x y z r\n1 2 3 4\n",
    "Easting\tNorthing\tHeight\n1\t2\t3\n", "5.20046e+06 812.378 1\n",
    std::string("\xFF\xFE"
                "1\0 \0002\0 \0003\0",
      12) };
}

std::vector<std::string> passages()
{
  std::string file = "RFPASS08" + bytesOf(std::int32_t(4)) + bytesOf(std::int32_t(3));
  for (const double value : { 5.0, 0.0, 0.0, 0.0, 0.0, 0.0 })
  {
    file += bytesOf(value);
  }
  file += bytesOf(std::uint64_t(4)) + "WKT:" + bytesOf(std::uint64_t(5)) +
    bytesOf(std::uint64_t(7)) + "Rigid 0" + bytesOf(std::uint64_t(1)) + bytesOf(std::int64_t(0)) +
    bytesOf(std::int64_t(2));
  for (const std::int64_t lost : { 2, 1, 0, 1, 0 })
  {
    file += bytesOf(lost);
  }
  file += bytesOf(60.0) + bytesOf(std::int64_t(0)) + bytesOf(std::uint64_t(1)) +
    bytesOf(std::int64_t(0)) + bytesOf(std::int64_t(7)) + bytesOf(std::int64_t(1)) +
    bytesOf(std::int64_t(3)) + bytesOf(0.25) + bytesOf(std::uint64_t(2)) +
    bytesOf(std::uint32_t(80)); // not packed
  for (const int rock : { 0, 1 })
  {
    file += bytesOf(std::uint32_t(0)) + bytesOf(std::uint32_t(1)) + bytesOf(std::int32_t(0)) +
      bytesOf(std::int32_t(rock)) + bytesOf(std::int64_t(7));
    for (const float value : { 1.0F, 2.0F, 3.0F, 4.0F })
    {
      file += bytesOf(value);
    }
  }
  return { file };
}

/// Behind the byte that says which driver.
std::vector<std::string> grids()
{
  const std::string esri = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  return { std::string(1, '\0') + esri + "1 2 3\n4 5 6\n",
    std::string(1, '\0') + esri + "NODATA_value -9999\n1 nan 3\n4,5 5 x\n",
    "\1north: 2\nsouth: 0\neast: 3\nwest: 0\nrows: 2\ncols: 3\nnull: *\n1 * 3\n4 5 6\n",
    "\1north: 2\nsouth: 0\neast: 3\nwest: 0\nrows: 2\ncols: 3\ntype: float\nmultiplier: 0.1\n"
    "null: -1\n1 -1 3\n4 5,5 6\n",
    "\2begin_of_head ====\nmodel name : m\nmodel type : gravimetric\nunits : meters\n"
    "reference : WGS84\nlat min = 0.0\nlat max = 2.0\nlon min = 0.0\nlon max = 3.0\n"
    "delta lat = 1.0\ndelta lon = 1.0\nnrows = 2\nncols = 3\nnodata = -9999\n"
    "ISG format = 1.0\nend_of_head ====\n1 2 3\n4 -9999 x\n",
    "\3"
    "0 0 1\n1 0 2\n0 1 3\n1 1 4\n",
    "\3x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,word\n" };
}

std::vector<std::string> tables()
{
  return { "class,rv\nrock,0.8\n", "sep=;\nclass;rv\nrock;0,8\n",
    "# remark\nclass,rv\nGer\xF6ll,0.3\n",
    "\xEF\xBB\xBF"
    "a\tb\n1\t2\n",
    std::string("\xFF\xFE"
                "a\0,\0b\0\n\0",
      10) };
}

} // namespace

int main(int count, char** words)
{
  if (count != 3)
  {
    std::cerr << "fuzzSeeds reader folder\n";
    return 1;
  }
  const std::string reader = words[1];
  const std::filesystem::path folder = words[2];
  std::filesystem::create_directories(folder);
  const std::vector<std::string> seeds = reader == "FuzzMesh" ? meshes()
    : reader == "FuzzPointTable"                              ? pointTables()
    : reader == "FuzzPassages"                                ? passages()
    : reader == "FuzzTableFile"                               ? tables()
                                                              : grids();
  for (std::size_t k = 0; k < seeds.size(); ++k)
  {
    std::ofstream(folder / ("seed" + std::to_string(k)), std::ios::binary) << seeds[k];
  }
  return 0;
}
