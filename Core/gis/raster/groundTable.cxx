#include "gis/raster/groundTable.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "base/text/quotedList.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "terrain/presets.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace rockfall::gis
{

namespace
{

/// "1", "1.0" and " 01" are one class; "15E2" is a name.
std::string keyOf(const std::string& text)
{
  const std::string key = nameKey(text);
  const auto value = parsedNumber(key);
  return value && key.find_first_not_of("+-.0123456789") == std::string::npos ? exactly(*value)
                                                                              : key;
}

RestitutionModel modelFrom(const FeatureRow& row, const std::string& text)
{
  const std::string letters = letterKey(text);
  if (letters == "0" || letters == "velocity" || letters == "wholevelocity")
  {
    return RestitutionModel::Velocity;
  }
  if (letters == "1" || letters == "normaltangential" || letters == "normalandtangential")
  {
    return RestitutionModel::NormalTangential;
  }
  if (letters == "2" || letters == "speeddependent")
  {
    return RestitutionModel::SpeedDependent;
  }
  row.failField("model",
    " is \"" + text + "\", it must be 0 (Velocity), 1 (NormalTangential) or 2 (SpeedDependent)");
}

/// A message about properties, with the names of their columns.
std::string inColumns(std::string text)
{
  const auto fields = yieldingFields();
  // Backwards: GroundDeviationLength begins as GroundDeviation does.
  for (auto field = fields.rbegin(); field != fields.rend(); ++field)
  {
    const std::string property = field->property;
    const std::string column = "\"" + std::string(field->column) + "\"";
    for (std::size_t at = text.find(property); at != std::string::npos;
         at = text.find(property, at + column.size()))
    {
      text.replace(at, property.size(), column);
    }
  }
  return text;
}

void readRestitution(const FeatureRow& row, bool preset, SurfaceMaterial& m)
{
  if (const auto model = row.text({ "model", "restitutionmodel" }))
  {
    m.restitutionModel = modelFrom(row, *model);
  }
  const auto rv = row.ranged(
    { "rv", "rn", "restitution", "rv_mean", "restitutioncoefficient" }, 0.0, 1.0, "0 to 1");
  if (!rv && !preset)
  {
    row.failAbsent("rv", ", and the row has no preset", "table");
  }
  m.restitution = rv.value_or(m.restitution);
  m.restitutionDeviation =
    row
      .ranged({ "rv_deviation", "rn_deviation", "rv_dev", "rv_sd", "restitutiondeviation" }, 0.0,
        1.0, "0 to 1")
      .value_or(m.restitutionDeviation);
  m.tangentialRestitution = row.ranged({ "rt", "tangentialrestitution" }, 0.0, 1.0, "0 to 1")
                              .value_or(m.tangentialRestitution);
  m.restitutionSpeed = row
                         .ranged({ "speed", "k", "restitutionspeed" },
                           std::numeric_limits<double>::min(), 1e6, "above 0, in m/s")
                         .value_or(m.restitutionSpeed);
  for (const YieldingField& field : yieldingFields())
  {
    if (const auto typed = row.ranged({ field.column, nameKey(field.property).c_str() }, 0.0,
          std::numeric_limits<double>::max(), "a finite number, not negative"))
    {
      field.set(m.yielding, *typed);
    }
  }
  try
  {
    m.yielding.validate();
  }
  catch (const Error& error)
  {
    row.fail("field " + inColumns(error.what()));
  }
}

void readJoint(const FeatureRow& row, bool preset, SurfaceMaterial& m)
{
  const auto phi = row.ranged(
    { "phi", "phi_mean", "friction_angle", "frictionangle" }, 0.0, 89.0, "0 to 89 degrees");
  if (!phi && !preset)
  {
    row.failAbsent("phi", ", and the row has no preset", "table");
  }
  m.frictionAngle = phi ? radians(*phi) : m.frictionAngle;
  const auto deviation = row.ranged(
    { "phi_deviation", "phi_dev", "phi_sd", "friction_angle_deviation", "frictionangledeviation" },
    0.0, 89.0, "0 to 89 degrees");
  m.frictionAngleDeviation = deviation ? radians(*deviation) : m.frictionAngleDeviation;
  m.cohesion = row
                 .ranged({ "cohesion", "c" }, 0.0, std::numeric_limits<double>::max(),
                   "a finite number of newtons, not negative")
                 .value_or(m.cohesion);
}

Roughness roughnessFrom(const FeatureRow& row, const Roughness& usual)
{
  Roughness r = usual;
  const double most = std::numeric_limits<double>::max();
  const auto height = [&](std::initializer_list<const char*> names, double otherwise)
  { return row.ranged(names, 0.0, most, "a number of metres, not negative").value_or(otherwise); };
  r.mean = row.ranged({ "roughness_mean", "roughnessmean" }, -most, most, "a number of metres")
             .value_or(r.mean);
  r.deviation =
    height({ "roughness", "roughness_deviation", "roughness_dev", "roughness_sd" }, r.deviation);
  r.length = height({ "roughness_length", "roughnesslength" }, r.length);
  r.obstacles = { height({ "rg70" }, r.obstacles[0]), height({ "rg20" }, r.obstacles[1]),
    height({ "rg10" }, r.obstacles[2]) };
  try
  {
    r.validate();
  }
  catch (const Error& error)
  {
    row.fail(error.what());
  }
  return r;
}

/// Whether a table says anything of roughness.
bool hasRoughness(const Columns& columns)
{
  return std::any_of(columns.begin(), columns.end(),
    [](const auto& column)
    { return column.first.starts_with("roughness") || column.first.starts_with("rg"); });
}

} // namespace

std::string kindName(GroundKind kind)
{
  return kind == GroundKind::Restitution ? "Restitution" : "Joint";
}

int GroundTable::rowOf(const std::string& key) const
{
  const auto found = this->rows.find(keyOf(key));
  return found == this->rows.end() ? 0 : found->second;
}

std::string GroundTable::keys() const
{
  return quotedList(this->rows, &std::map<std::string, int>::value_type::first, 200);
}

GroundTable readGroundTable(GroundKind kind, const GroundFiles& files, const SurfaceMaterial& usual,
  const Roughness& usualRoughness, std::vector<std::string>& notes)
{
  const std::string& fileName = files.table;
  Messages messages;
  LayerWish wish{ fileName, files.tableSheet, kindName(kind) + "TableSheet" };
  wish.what = "table with a column \"class\" or \"name\"";
  wish.kinds = kRows;
  wish.columns = { { "class", "name" } };
  LayerFile file(wish, messages);
  OGRLayer& layer = file.layer();
  ColumnNames known = { "preset", "model", "rv", "rn", "rv_mean", "restitution", "rv_deviation",
    "rn_deviation", "rv_dev", "rv_sd", "rt", "speed", "phi", "phi_mean", "friction_angle",
    "phi_deviation", "phi_dev", "phi_sd", "friction_angle_deviation", "cohesion", "roughness",
    "roughness_mean", "roughness_deviation", "roughness_dev", "roughness_sd", "roughness_length",
    "rg70", "rg20", "rg10" };
  ColumnNames others = { "class", "name", "restitutionmodel", "restitutioncoefficient",
    "restitutiondeviation", "tangentialrestitution", "k", "restitutionspeed", "frictionangle",
    "frictionangledeviation", "c", "roughnessmean", "roughnesslength" };
  std::vector<std::string> keys;
  for (const YieldingField& field : yieldingFields())
  {
    known.push_back(field.column);
    keys.push_back(nameKey(field.property));
  }
  for (const std::string& key : keys)
  {
    others.push_back(key.c_str());
  }
  refuseNearMisses(*layer.GetLayerDefn(), fileName, known, others);
  tellUnread(*layer.GetLayerDefn(), fileName, known, others, notes);
  const Columns columns = columnsOf(*layer.GetLayerDefn());
  if (!columns.count("class") && !columns.count("name"))
  {
    throw DataError(fileName + ": has no column \"class\" or \"name\"; its columns are " +
      fieldList(*layer.GetLayerDefn()));
  }
  GroundTable table;
  const bool restitution = kind == GroundKind::Restitution;
  const char* const other = restitution ? "phi" : "rv";
  if (files.alone && columns.count(other))
  {
    notes.push_back(fileName + ": its column \"" + other + "\" is read where it is the " +
      kindName(restitution ? GroundKind::Joint : GroundKind::Restitution) +
      "Table, which is not given.");
  }
  bool rough = restitution && hasRoughness(columns);
  std::vector<const GroundPreset*> used;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    const int number = int(table.names.size()) + 1;
    const FeatureRow row(fileName, columns, *feature, number);
    row.refuseLostText(messages);
    if (number > MaterialClasses::largest)
    {
      row.fail("is one too many: a table has at most " + std::to_string(MaterialClasses::largest) +
        " classes");
    }
    const auto written = row.text("class"), name = row.text("name");
    if (!written && !name)
    {
      row.failField("class", " is empty");
    }
    const std::string key = keyOf(written.value_or(name.value_or("")));
    if (!table.rows.emplace(key, number).second)
    {
      row.fail(
        "class \"" + key + "\" is in row " + std::to_string(table.rows.at(key)) + " already");
    }
    SurfaceMaterial material = usual;
    Roughness roughness = usualRoughness;
    material.restitutionDeviation = material.frictionAngleDeviation = 0.0;
    const auto preset = row.text("preset");
    if (preset)
    {
      try
      {
        const GroundPreset& ground = groundPreset(*preset);
        material = ground.material();
        material.deviationPer = ground.deviationPer();
        material.cohesion = usual.cohesion;
        roughness = ground.roughness;
        rough = restitution;
        used.push_back(&ground);
      }
      catch (const Error& error)
      {
        row.failField("preset", std::string(": ") + error.what());
      }
    }
    restitution ? readRestitution(row, bool(preset), material)
                : readJoint(row, bool(preset), material);
    table.names.push_back(name.value_or(*(written ? written : name)));
    table.materials.push_back(material);
    table.roughness.push_back(roughnessFrom(row, roughness));
  }
  if (!rough)
  {
    table.roughness.clear(); // that of the slope
  }
  file.tell(notes, true);
  for (const GroundPreset* preset : used)
  {
    preset->warn(notes);
  }
  if (table.names.empty())
  {
    throw DataError(fileName + ": has no row");
  }
  // Names serve as well where no class is called so.
  for (std::size_t i = 0; i < table.names.size(); ++i)
  {
    table.rows.emplace(keyOf(table.names[i]), int(i) + 1);
  }
  return table;
}

} // namespace rockfall::gis
