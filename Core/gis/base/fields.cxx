#include "gis/base/fields.h"

#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "gis/base/gdal.h"

#include <cpl_csv.h>
#include <cpl_json.h>
#include <cpl_string.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace rockfall::gis
{

Columns columnsOf(const OGRFeatureDefn& definition)
{
  Columns columns;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    columns.emplace(nameKey(definition.GetFieldDefn(i)->GetNameRef()), i);
  }
  return columns;
}

std::string fieldList(const OGRFeatureDefn& definition)
{
  std::string list;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    list += (i ? ", \"" : "\"") + std::string(definition.GetFieldDefn(i)->GetNameRef()) + "\"";
  }
  return list.empty() ? "none" : list;
}

namespace
{

/// Letters that are wrong, missing, too many, or taken with the next one in the wrong order.
std::size_t slipsBetween(const std::string& one, const std::string& other)
{
  // Rows of the table of prefixes: two before, one before, this one.
  std::vector<std::size_t> before, last(other.size() + 1), now(other.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t(0));
  for (std::size_t i = 1; i <= one.size(); ++i)
  {
    now[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j)
    {
      now[j] =
        std::min({ last[j] + 1, now[j - 1] + 1, last[j - 1] + (one[i - 1] != other[j - 1]) });
      if (i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1])
      {
        now[j] = std::min(now[j], before[j - 2] + 1);
      }
    }
    before = std::exchange(last, now);
  }
  return last.back();
}

/// Whether `column` is `name` with a slip, or two where it has eight letters: value is no volume.
/// Short words and other first letters do not count: weight is no height.
bool isSlipOf(const std::string& column, const std::string& name)
{
  const auto letters = std::count_if(name.begin(), name.end(), [](char c) { return c != '_'; });
  return std::min(column.size(), name.size()) >= 5 && column[0] == name[0] &&
    slipsBetween(column, name) <= std::size_t(letters < 8 ? 1 : 2);
}

bool holds(const ColumnNames& names, const std::string& word)
{
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return word == name; });
}

/// Quantities and states of rocks, structures and ground, but for a unit, in small letters.
const ColumnNames kQuantities = { "mass", "masse", "massa", "weight", "gewicht", "poids", "peso",
  "speed", "velocity", "geschwindigkeit", "vitesse", "spin", "diameter", "durchmesser", "bhd",
  "dbh", "girth", "circumference", "umfang", "size", "length", "width", "breite", "largeur",
  "larghezza", "height", "hoehe", "höhe", "hauteur", "altezza", "elevation", "elev", "ele",
  "altitude", "volume", "density", "dichte", "densité", "densità", "energy", "energie", "énergie",
  "energia", "mel", "capacity", "kapazität", "capacité", "capacità", "slope", "inclination",
  "neigung", "restitution", "friction", "reibung", "frottement", "attrito", "species", "baumart",
  "essence", "frequency", "häufigkeit", "fréquence", "frequenza", "return_period", "period",
  "wiederkehrperiode", "jährlichkeit", "période", "periodo", "status", "condition", "zustand",
  "état", "stato", "dip", "azimuth", "efficiency", "sel", "planned", "geplant", "prévu", "removed",
  "entfernt", "enlevé", "demolished", "rückgebaut", "dead", "felled", "gefällt", "abattu" };

/// Whether a word of the column is a quantity, or a column that is read: annual_frequency, BlockVolume.
/// What ArcGIS adds to every layer, Shape_Length and Shape_Area, is none, nor is KML's altitudeMode.
bool namesQuantity(const ColumnName& column, const ColumnNames& known)
{
  return !column.words.empty() && column.words.front() != "shape" &&
    column.name != "altitudemode" &&
    std::any_of(column.words.begin(), column.words.end(),
      [&](const std::string& word)
      { return holds(kQuantities, word) || (word.size() >= 4 && holds(known, word)); });
}

/// Whether `column` is `name` cut short within its first word.
bool isShortFor(const std::string& column, const std::string& name)
{
  return name.size() >= 5 && column.size() >= 3 && column.size() < name.size() &&
    name.starts_with(column) && name[column.size()] != '_';
}

bool isNumeric(const OGRFieldDefn& field)
{
  const OGRFieldType type = field.GetType();
  return type == OFTReal || type == OFTInteger || type == OFTInteger64;
}

/// Whether `column` goes on after `name`, is short for it or a slip of it.
bool isLike(const std::string& column, const std::string& name)
{
  const auto goesOn = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return (column.size() > name.size() && column.starts_with(name) &&
           !goesOn(column[name.size()])) ||
    isShortFor(column, name) || isSlipOf(column, name);
}

} // namespace

void refuseTwin(const OGRFeatureDefn& definition, const std::string& fileName, int column)
{
  const std::string written = definition.GetFieldDefn(column)->GetNameRef();
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    const std::string other = definition.GetFieldDefn(i)->GetNameRef();
    if (i != column && nameKey(other) == nameKey(written))
    {
      throw DataError(fileName + ": has two columns \"" + written + "\"" +
        (other == written ? "" : " and \"" + other + "\", in which upper and lower case are one") +
        "; leave out or rename one of them");
    }
  }
}

void refuseNearMisses(const OGRFeatureDefn& definition, const std::string& fileName,
  const ColumnNames& known, const ColumnNames& others)
{
  const Columns columns = columnsOf(definition);
  for (const auto& [column, index] : columns)
  {
    if (holds(known, column) || holds(others, column))
    {
      refuseTwin(definition, fileName, index);
      continue;
    }
    for (const std::string name : known)
    {
      if (isLike(column, name) && !columns.count(name))
      {
        throw DataError(fileName + ": its column \"" +
          definition.GetFieldDefn(index)->GetNameRef() + "\" is not read, and there is none \"" +
          name + "\"; call it so if it is that, else something less like it");
      }
    }
  }
}

void tellUnread(const OGRFeatureDefn& definition, const std::string& fileName,
  const ColumnNames& known, const ColumnNames& others, std::vector<std::string>& notes)
{
  const Columns columns = columnsOf(definition);
  std::string list;
  int count = 0;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    const std::string written = definition.GetFieldDefn(i)->GetNameRef();
    const std::string column = nameKey(written);
    const ColumnName quantity(written);
    const auto isRead = [&](const std::string& name)
    { return holds(known, name) || holds(others, name); };
    const bool alike = std::any_of(known.begin(), known.end(),
      [&](const char* name) { return columns.count(name) && isLike(column, name); });
    if (!isRead(column) && !isRead(quantity.name) &&
      (alike || holds(kQuantities, quantity.name) || namesQuantity(quantity, known)))
    {
      list += (count++ ? ", \"" : "\"") + written + "\"";
    }
  }
  if (count > 0)
  {
    notes.push_back(fileName +
      (count > 1 ? ": not read are its columns " : ": not read is its column ") + list + ".");
  }
}

void refuseSurplusCells(GDALDataset& dataset, const std::string& fileName)
{
  if (!dataset.GetDriver() || !EQUAL(dataset.GetDriver()->GetDescription(), "CSV"))
  {
    return;
  }
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(
    VSIFOpenL(dataset.GetDescription(), "rb"), VSIFCloseL);
  const char* first = file ? CPLReadLineL(file.get()) : nullptr;
  if (!first)
  {
    return;
  }
  const char separator = CSVDetectSeperator(first);
  VSIRewindL(file.get());
  const auto next = [&] { return CPLStringList(CSVReadParseLine2L(file.get(), separator)); };
  const int columns = next().size();
  for (std::int64_t row = 1; !VSIFEofL(file.get()); ++row)
  {
    const CPLStringList cells = next();
    for (int i = columns; i < cells.size(); ++i)
    {
      if (!trimmed(cells[i]).empty())
      {
        throw DataError(fileName + ", row " + std::to_string(row) + ": has " +
          std::to_string(cells.size()) + " fields, the header " + std::to_string(columns) + "; \"" +
          cells[i] + "\" is one too many (the decimal sign is a point)");
      }
    }
  }
}

Fields::Fields(
  const std::string& fileName, const Columns& columns, const OGRFeature& feature, std::int64_t row)
  : fileName_(fileName)
  , columns_(columns)
  , feature_(feature)
  , row_(row)
{
}

void Fields::fail(const std::string& what) const
{
  throw DataError(this->where() + ": " + what);
}

void Fields::refuseLostText(const Messages& messages) const
{
  if (!messages.lostText().empty())
  {
    this->fail(messages.lostText());
  }
}

std::string Fields::nameOf(int column) const
{
  return feature_.GetFieldDefnRef(column)->GetNameRef();
}

bool Fields::isTruth(int column) const
{
  const OGRFieldDefn& field = *feature_.GetFieldDefnRef(column);
  if (field.GetSubType() == OFSTBoolean)
  {
    return true;
  }
  const char* const json = isNumeric(field) ? feature_.GetNativeData() : nullptr;
  const double value = json ? feature_.GetFieldAsDouble(column) : 0.0;
  if (!json || (value != 0.0 && value != 1.0))
  {
    return false;
  }
  CPLJSONDocument document;
  return document.LoadMemory(json) &&
    document.GetRoot().GetObj("properties").GetObj(field.GetNameRef()).GetType() ==
    CPLJSONObject::Type::Boolean;
}

std::optional<std::string> Fields::textAt(int column) const
{
  if (!feature_.IsFieldSetAndNotNull(column))
  {
    return std::nullopt;
  }
  if (this->isTruth(column))
  {
    return feature_.GetFieldAsInteger(column) ? "true" : "false";
  }
  const std::string value(trimmed(feature_.GetFieldAsString(column)));
  if (!isUtf8(value))
  {
    this->fail("field \"" + this->nameOf(column) +
      "\": its text is not UTF-8; save the file so, or name its encoding, as windows-1252, in a "
      ".cpg file beside it");
  }
  return value.empty() ? std::nullopt : std::optional(value);
}

std::optional<double> Fields::numberAt(int column) const
{
  const auto written = this->textAt(column);
  if (!written)
  {
    return std::nullopt;
  }
  // A field of numbers is taken as such: its text is rounded.
  const auto value =
    isNumeric(*feature_.GetFieldDefnRef(column)) && *written != "true" && *written != "false"
    ? std::optional(feature_.GetFieldAsDouble(column))
    : parsedNumber(*written);
  if (!value)
  {
    const bool comma = written->find(',') != std::string::npos;
    this->fail("field \"" + this->nameOf(column) + "\": \"" + *written + "\" is not a number" +
      (comma ? " (the decimal sign is a point)" : ""));
  }
  if (!std::isfinite(*value))
  {
    this->fail("field \"" + this->nameOf(column) + "\" is " + *written + ", it must be finite");
  }
  return value;
}

std::optional<int> Fields::columnOf(std::initializer_list<const char*> names) const
{
  std::optional<int> taken;
  for (const char* name : names)
  {
    const auto column = columns_.find(name);
    const auto text = column != columns_.end() ? this->textAt(column->second) : std::nullopt;
    if (!text)
    {
      continue;
    }
    if (taken && *text != *this->textAt(*taken))
    {
      this->fail("field \"" + this->nameOf(*taken) + "\" is " + *this->textAt(*taken) +
        " and field \"" + this->nameOf(column->second) + "\", which is the same by another name, " +
        *text + "; leave out one of them");
    }
    taken = taken ? taken : column->second;
  }
  return taken;
}

std::optional<std::string> Fields::text(std::initializer_list<const char*> names) const
{
  const auto column = this->columnOf(names);
  return column ? this->textAt(*column) : std::nullopt;
}

std::optional<double> Fields::number(std::initializer_list<const char*> names) const
{
  const auto column = this->columnOf(names);
  return column ? this->numberAt(*column) : std::nullopt;
}

std::optional<double> Fields::ranged(
  std::initializer_list<const char*> names, double low, double high, const char* range) const
{
  const auto column = this->columnOf(names);
  if (!column)
  {
    return std::nullopt;
  }
  const auto value = this->numberAt(*column);
  if (!(*value >= low && *value <= high))
  {
    this->fail("field \"" + this->nameOf(*column) + "\" is " + gis::number(*value) +
      ", it must be " + range);
  }
  return value;
}

} // namespace rockfall::gis
