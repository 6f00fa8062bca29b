#include "gis/layers/rockContacts.h"

#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "base/text/quotedList.h"
#include "gis/base/FeatureRow.h"
#include "gis/base/gdal.h"
#include "gis/layers/LayerFile.h"
#include "terrain/material.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace rockfall
{

namespace
{

using namespace gis;

/// As they are written, by key.
using Names = std::map<std::string, std::string>;

Names namesOf(std::span<const std::string> materials)
{
  Names names;
  for (const std::string& material : materials)
  {
    const std::string key = nameKey(material);
    if (!key.empty())
    {
      names.emplace(key, trimmed(material));
    }
  }
  return names;
}

/// Reads a row into a pair.
class PairReader
{
public:
  PairReader(const std::string& fileName, OGRLayer& layer, const Columns& columns, Names materials)
    : materials_(std::move(materials))
  {
    const auto require = [&](std::initializer_list<const char*> names)
    {
      if (std::none_of(
            names.begin(), names.end(), [&](const char* name) { return columns.count(name) > 0; }))
      {
        throw DataError(fileName + ": has no column \"" + *names.begin() + "\"; its columns are " +
          fieldList(*layer.GetLayerDefn()));
      }
    };
    require({ "material_a" });
    require({ "material_b" });
    require({ "restitution", "rn", "e" });
    require({ "phi", "friction_angle", "frictionangle" });
  }

  RockContactPair read(const FeatureRow& row, int number, double usualCohesion)
  {
    RockContactPair pair;
    pair.first = this->material(row, "material_a");
    pair.second = this->material(row, "material_b");
    std::pair<std::string, std::string> key = { nameKey(pair.first), nameKey(pair.second) };
    if (key.second < key.first)
    {
      std::swap(key.first, key.second);
    }
    const auto place = rows_.emplace(key, number);
    if (!place.second)
    {
      row.fail("the pair of \"" + pair.first + "\" and \"" + pair.second + "\" is in row " +
        std::to_string(place.first->second) + " already");
    }
    used_.insert({ key.first, key.second });
    if (used_.size() > std::size_t(MaterialClasses::largest))
    {
      row.fail("is of one material too many: a table has at most " +
        std::to_string(MaterialClasses::largest));
    }
    RockContact& c = pair.contact;
    c.restitution =
      needed(row, "restitution", row.ranged({ "restitution", "rn", "e" }, 0.0, 1.0, "0 to 1"));
    c.frictionAngle = radians(needed(row, "phi",
      row.ranged({ "phi", "friction_angle", "frictionangle" }, 0.0, 89.0, "0 to 89 degrees")));
    c.cohesion = row
                   .ranged({ "cohesion", "c" }, 0.0, std::numeric_limits<double>::max(),
                     "a finite number of newtons, not negative")
                   .value_or(usualCohesion);
    return pair;
  }

private:
  template <typename Value>
  static Value needed(const FeatureRow& row, const char* column, const std::optional<Value>& value)
  {
    if (!value)
    {
      row.failField(column, " is empty");
    }
    return *value;
  }

  std::string material(const FeatureRow& row, const char* column) const
  {
    const std::string text = needed(row, column, row.text(column));
    const auto found = materials_.find(nameKey(text));
    if (found == materials_.end())
    {
      row.failField(column,
        " is \"" + text + "\", which no rock is of; " +
          (materials_.empty()
              ? "the rocks have no Material"
              : "the rocks are of " + quotedList(materials_, &Names::value_type::second, 200)));
    }
    return found->second;
  }

  Names materials_;
  std::map<std::pair<std::string, std::string>, int> rows_; ///< By keys in order.
  std::set<std::string> used_;
};

} // namespace

std::vector<RockContactPair> readRockContacts(const std::string& fileName, double usualCohesion,
  std::span<const std::string> materials, const std::string& layerName,
  std::vector<std::string>* notes)
{
  Messages messages;
  LayerWish wish{ fileName, layerName, "RockContactSheet" };
  wish.what = "table with \"material_a\" and \"material_b\"";
  wish.kinds = kRows;
  wish.columns = { { "material_a" }, { "material_b" } };
  LayerFile file(wish, messages);
  const ColumnNames known = { "cohesion" };
  const ColumnNames others = { "c", "material_a", "material_b", "restitution", "rn", "e", "phi",
    "friction_angle", "frictionangle" };
  refuseNearMisses(file.definition(), fileName, known, others);
  const Columns columns = columnsOf(file.definition());
  PairReader reader(fileName, file.layer(), columns, namesOf(materials));
  std::vector<RockContactPair> pairs;
  while (const OGRFeatureUniquePtr feature = file.next())
  {
    const FeatureRow row(fileName, columns, *feature, file.number());
    row.refuseLostText(messages);
    pairs.push_back(reader.read(row, int(file.number()), usualCohesion));
  }
  if (pairs.empty())
  {
    throw DataError(fileName + ": has no row");
  }
  if (notes)
  {
    file.tell(*notes, true);
    tellUnread(file.definition(), fileName, known, others, *notes);
  }
  return pairs;
}

} // namespace rockfall
