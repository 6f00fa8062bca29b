#include "gis/base/fields.h"

#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"
#include "base/text/quotedList.h"
#include "gis/base/gdal.h"

#include <cpl_csv.h>
#include <cpl_string.h>
#include <ogrsf_frmts.h>

#include <algorithm>
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
  ColumnNames names;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
  {
    names.push_back(definition.GetFieldDefn(i)->GetNameRef());
  }
  return names.empty() ? "none" : quotedList(names);
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
  std::vector<std::string> unread;
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
      unread.push_back(written);
    }
  }
  if (!unread.empty())
  {
    notes.push_back(fileName +
      (unread.size() > 1 ? ": not read are its columns " : ": not read is its column ") +
      quotedList(unread) + ".");
  }
}

void refuseSurplusCells(GDALDataset& dataset, const std::string& fileName)
{
  if (!isOfDriver(dataset, "CSV"))
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

} // namespace rockfall::gis
