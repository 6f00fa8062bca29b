#pragma once

/// @file
/// netCDF-3 files of a grid, written byte by byte: axes, attributes and values as a test wants
/// them.

#include "gisFiles.h"

#include <bit>
#include <utility>
#include <variant>

namespace rockfall::testing
{

/// A text, or numbers of double or single precision.
struct NetCdfAttribute
{
  std::string name;
  std::variant<std::string, std::vector<double>, std::vector<float>> value;
};

struct NetCdfVariable
{
  std::string name;
  std::vector<int> dimensions; ///< Numbers of them.
  std::vector<double> values;
  std::vector<NetCdfAttribute> attributes;
  bool isSingle = false;
};

struct NetCdf
{
  std::vector<std::pair<std::string, int>> dimensions;
  std::vector<NetCdfVariable> variables;
  std::vector<NetCdfAttribute> attributes;

  std::string write(const std::string& name = "grid.nc") const
  {
    std::string head = "CDF\x02";
    put(head, std::int32_t(0));
    put(head, std::int32_t(10));
    put(head, std::int32_t(dimensions.size()));
    for (const auto& [text, size] : dimensions)
    {
      putText(head, text);
      put(head, std::int32_t(size));
    }
    putAttributes(head, attributes);
    std::vector<std::string> data;
    for (const NetCdfVariable& variable : variables)
    {
      std::string& bytes = data.emplace_back();
      for (const double value : variable.values)
      {
        variable.isSingle ? put(bytes, float(value)) : put(bytes, value);
      }
      pad(bytes);
    }
    const std::size_t size = head.size() + this->list(data, 0).size();
    std::string all = head + this->list(data, size);
    for (const std::string& bytes : data)
    {
      all += bytes;
    }
    return writeFile(name, all);
  }

private:
  /// The most significant byte first.
  template <class T>
  static void put(std::string& bytes, T value)
  {
    const char* raw = reinterpret_cast<const char*>(&value);
    std::string number(raw, sizeof(T));
    if constexpr (std::endian::native == std::endian::little)
    {
      number.assign(number.rbegin(), number.rend());
    }
    bytes += number;
  }
  static void pad(std::string& bytes) { bytes.resize((bytes.size() + 3) / 4 * 4, '\0'); }
  static void putText(std::string& bytes, const std::string& text)
  {
    put(bytes, std::int32_t(text.size()));
    bytes += text;
    bytes.resize(bytes.size() + (4 - text.size() % 4) % 4, '\0');
  }
  static void putAttributes(std::string& bytes, const std::vector<NetCdfAttribute>& attributes)
  {
    put(bytes, std::int32_t(attributes.empty() ? 0 : 12));
    put(bytes, std::int32_t(attributes.size()));
    for (const NetCdfAttribute& attribute : attributes)
    {
      putText(bytes, attribute.name);
      if (const auto* text = std::get_if<std::string>(&attribute.value))
      {
        put(bytes, std::int32_t(2));
        putText(bytes, *text);
        continue;
      }
      const auto* doubles = std::get_if<std::vector<double>>(&attribute.value);
      const auto* floats = std::get_if<std::vector<float>>(&attribute.value);
      put(bytes, std::int32_t(doubles ? 6 : 5));
      put(bytes, std::int32_t(doubles ? doubles->size() : floats->size()));
      for (std::size_t i = 0; i < (doubles ? doubles->size() : floats->size()); ++i)
      {
        doubles ? put(bytes, (*doubles)[i]) : put(bytes, (*floats)[i]);
      }
    }
  }
  std::string list(const std::vector<std::string>& data, std::size_t first) const
  {
    std::string bytes;
    put(bytes, std::int32_t(11));
    put(bytes, std::int32_t(variables.size()));
    for (std::size_t k = 0; k < variables.size(); ++k)
    {
      putText(bytes, variables[k].name);
      put(bytes, std::int32_t(variables[k].dimensions.size()));
      for (const int dimension : variables[k].dimensions)
      {
        put(bytes, std::int32_t(dimension));
      }
      putAttributes(bytes, variables[k].attributes);
      put(bytes, std::int32_t(variables[k].isSingle ? 5 : 6));
      put(bytes, std::int32_t(data[k].size()));
      put(bytes, std::int64_t(first));
      first += data[k].size();
    }
    return bytes;
  }
};

inline const char* const utm32Wkt =
  "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
  "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION["
  "\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],"
  "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER["
  "\"false_northing\",0],UNIT[\"metre\",1]]";

/// Heights z(y, x) on axes of 10 m steps from 600005, 5100005, in UTM zone 32; row 0 is the
/// southern one. Columns and rows as many as the axes have places.
inline NetCdf gridOfHeights(const std::vector<double>& values, int columns,
  const std::vector<NetCdfAttribute>& attributes = {})
{
  const int rows = int(values.size()) / columns;
  NetCdf file;
  file.dimensions = { { "y", rows }, { "x", columns } };
  file.attributes = { { "Conventions", "CF-1.6" } };
  NetCdfVariable x{ "x", { 1 }, {},
    { { "standard_name", "projection_x_coordinate" }, { "units", "m" } } };
  NetCdfVariable y{ "y", { 0 }, {},
    { { "standard_name", "projection_y_coordinate" }, { "units", "m" } } };
  for (int i = 0; i < columns; ++i)
  {
    x.values.push_back(600005.0 + 10.0 * i);
  }
  for (int i = 0; i < rows; ++i)
  {
    y.values.push_back(5100005.0 + 10.0 * i);
  }
  NetCdfVariable z{ "z", { 0, 1 }, values, attributes };
  z.attributes.push_back({ "grid_mapping", "crs" });
  NetCdfVariable crs{ "crs", {}, { 0.0 },
    { { "grid_mapping_name", "transverse_mercator" },
      { "longitude_of_central_meridian", std::vector<double>{ 9.0 } },
      { "latitude_of_projection_origin", std::vector<double>{ 0.0 } },
      { "scale_factor_at_central_meridian", std::vector<double>{ 0.9996 } },
      { "false_easting", std::vector<double>{ 500000.0 } },
      { "false_northing", std::vector<double>{ 0.0 } },
      { "semi_major_axis", std::vector<double>{ 6378137.0 } },
      { "inverse_flattening", std::vector<double>{ 298.257223563 } }, { "crs_wkt", utm32Wkt } } };
  file.variables = { x, y, z, crs };
  return file;
}

} // namespace rockfall::testing
