#pragma once

/// @file
/// Points and lines as GeoPackage or CSV.

#include "base/types.h"

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace rockfall
{

enum class FieldType
{
  Integer, ///< 64 bits.
  Real,
  Text,
};

struct LayerField
{
  std::string name;
  FieldType type = FieldType::Real;
};

/// As the field's type says; a NaN becomes an empty field.
using FieldValue = std::variant<std::int64_t, double, std::string>;

/// Writes layers of 3D points or lines, one after the other.
class LayerWriter
{
public:
  enum class Geometry
  {
    Point,       ///< x, y, z
    MeasuredLine ///< x, y, z and a measure m, such as time.
  };

  /// By the extension: .gpkg (any number of layers) or .csv (one; geometry as WKT in the column
  /// WKT, types and CRS in a .csvt and a .prj beside). `crs`: WKT, empty for a local system. Throws
  /// FileError (name, folder, extension) or DataError (a CRS that PROJ does not know).
  LayerWriter(const std::string& fileName, const std::string& crs);
  ~LayerWriter(); ///< Without commit() nothing stays.
  LayerWriter(const LayerWriter&) = delete;
  LayerWriter& operator=(const LayerWriter&) = delete;

  bool manyLayers() const; ///< Whether the format holds more than one layer.
  /// Throws FileError, also for a second layer of a CSV file.
  void beginLayer(
    const std::string& name, Geometry geometry, const std::vector<LayerField>& fields);
  /// How QGIS opens the layer that was begun last: its QML, in the table layer_styles of a
  /// GeoPackage. Nothing in a CSV file.
  void setStyle(const std::string& qml);
  /// A feature; `values` as many as fields. A point has one place, a line one measure for each.
  void add(std::span<const Vec3> places, std::span<const double> measures,
    std::span<const FieldValue> values);
  /// Closes the file and gives it its name. Throws FileError.
  void commit();

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace rockfall
