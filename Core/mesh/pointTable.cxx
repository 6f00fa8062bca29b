#include "mesh/pointTable.h"

#include "base/errors.h"
#include "base/text/columnName.h"
#include "base/text/lengthUnit.h"
#include "base/text/tableText.h"
#include "mesh/MeshBuilder.h"
#include "mesh/meshFile.h"
#include "mesh/tableText.h"
#include "mesh/words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace rockfall
{

namespace
{

using Columns = std::array<std::size_t, 3>;

/// Names of the three axes; those of one row belong together, an earlier row goes first.
constexpr std::array<std::string_view, 3> kAxes[] = { { "x", "y", "z" },
  { "easting", "northing", "elevation" }, { "easting", "northing", "height" },
  { "easting", "northing", "altitude" }, { "easting", "northing", "z" }, { "east", "north", "up" },
  { "east", "north", "elevation" }, { "east", "north", "height" }, { "east", "north", "z" },
  { "e", "n", "h" }, { "e", "n", "z" }, { "e", "n", "u" }, { "x", "y", "elevation" },
  { "x", "y", "height" }, { "x", "y", "h" }, { "x_coord", "y_coord", "z_coord" },
  { "coord_x", "coord_y", "coord_z" }, { "point_x", "point_y", "point_z" },
  { "pos_x", "pos_y", "pos_z" }, { "points_0", "points_1", "points_2" },
  { "points:0", "points:1", "points:2" }, { "rechtswert", "hochwert", "höhe" } };

bool isInMetres(const ColumnName& column)
{
  return column.unit.empty() || lengthUnit(column.unit) == 1.0;
}

std::string listOf(const std::vector<std::string>& cells)
{
  std::string list;
  for (std::size_t k = 0; k < cells.size() && k < 20; ++k)
  {
    list += (k > 0 ? ", " : "") + inQuotes(cells[k]);
  }
  return list + (cells.size() > 20 ? " …" : "");
}

/// Where the header has x, y and z; nothing if it has no such names.
std::optional<Columns> findAxes(const std::vector<std::string>& header, const std::string& place)
{
  std::vector<ColumnName> names(header.begin(), header.end());
  for (const auto& axes : kAxes)
  {
    Columns columns{};
    int found = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const auto is = [&](const ColumnName& column) { return column.name == axes[axis]; };
      const auto first = std::find_if(names.begin(), names.end(), is);
      if (first == names.end())
      {
        break;
      }
      columns[axis] = std::size_t(first - names.begin());
      ++found;
      if (std::find_if(first + 1, names.end(), is) != names.end())
      {
        throw FileError(place + ": has two columns " + inQuotes(axes[axis]) + "; its columns are " +
          listOf(header));
      }
    }
    if (found < 3)
    {
      continue;
    }
    for (const std::size_t column : columns)
    {
      if (!isInMetres(names[column]))
      {
        throw FileError(place + ": column " + inQuotes(header[column]) + " is in " +
          names[column].unit + ", coordinates in metres are needed");
      }
    }
    return columns;
  }
  return {};
}

class PointTable
{
public:
  PointTable(std::string_view text, const std::string& name)
    : name_(name)
    , table_(splitLines(text))
    , mesh_(name)
  {
  }

  Mesh read()
  {
    if (table_.lines.empty())
    {
      return mesh_.finish(false);
    }
    const std::size_t first = this->findColumns();
    for (std::size_t k = first; k < table_.lines.size(); ++k)
    {
      this->readRow(table_.lines[k]);
    }
    this->checkGuess();
    return mesh_.finish(false, digits_);
  }

private:
  [[noreturn]] void fail(const TableLine& line, const std::string& what) const
  {
    throw FileError(lineName(name_, line.number) + ": " + what);
  }

  /// How many lines are no points.
  std::size_t findColumns()
  {
    const TableLine& first = table_.lines.front();
    const char says = table_.separator;
    separator_ = says != '\0' ? says : separatorOf(first.text);
    if (separator_ == '\0')
    {
      this->fail(first,
        inQuotes(first.text) +
          " may have a decimal comma or not: part the columns by semicolons, or write decimal "
          "points");
    }
    std::vector<std::string> cells = splitCells(first.text, separator_);
    while (cells.size() > 3 && cells.back().empty())
    {
      cells.pop_back(); // a separator at the end
    }
    if (!isNumeric(first.text))
    {
      const std::string place = lineName(name_, first.number);
      const auto columns = findAxes(cells, place);
      if (!columns)
      {
        throw FileError(
          place + ": its header has no columns x, y and z; its columns are " + listOf(cells));
      }
      columns_ = *columns;
      cells_ = cells.size();
      return 1;
    }
    // A comment may name the columns; one that does not is just a comment.
    cells_ = cells.size();
    const std::vector<std::string> names = splitCells(table_.comment, separatorOf(table_.comment));
    if (names.size() == cells_)
    {
      const auto columns = findAxes(names, name_);
      guessed_ = !columns;
      columns_ = columns.value_or(columns_);
      return 0;
    }
    guessed_ = true;
    return 0;
  }

  void readRow(const TableLine& line)
  {
    std::vector<std::string> cells = splitCells(line.text, separator_);
    while (cells.size() > cells_ && cells.back().empty())
    {
      cells.pop_back(); // a separator at the end
    }
    if (cells.size() != cells_ || cells_ < 3)
    {
      this->fail(line,
        inQuotes(line.text) + " is not a point: three numbers x, y, z are" +
          (cells_ < 3 || cells.size() < 3
              ? std::string()
              : "; it has " + std::to_string(cells.size()) + " columns, " + std::to_string(cells_) +
                " are needed" + (separator_ == ',' ? " (the decimal sign is a point)" : "")));
    }
    Vec3 point;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const std::string& cell = cells[columns_[axis]];
      const DecimalMark mark = parseCell(cell, word_, point[Eigen::Index(axis)]);
      if (mark == DecimalMark::Wrong)
      {
        this->fail(line,
          inQuotes(line.text) + " is not a point: three numbers x, y, z are, " + inQuotes(cell) +
            " is none");
      }
      if (mark != DecimalMark::None)
      {
        if (mark_ != DecimalMark::None && mark != mark_)
        {
          this->fail(line,
            inQuotes(cell) + " has a decimal " +
              (mark == DecimalMark::Comma ? "comma, numbers before it a point"
                                          : "point, numbers before it a comma"));
        }
        mark_ = mark;
      }
      digits_.add(word_, point[Eigen::Index(axis)]);
    }
    // Were the first column a number of the point, it would be 1, 2, 3 …
    counts_ = counts_ && point.x() == std::floor(point.x()) &&
      (mesh_.points() == 0 || point.x() == last_ + 1.0);
    last_ = point.x();
    mesh_.addPoint(point);
  }

  /// Questions that a table without a header leaves open.
  void checkGuess()
  {
    if (!guessed_ || cells_ == 3)
    {
      return;
    }
    const std::string remedy = ": name the columns x, y and z in a first line";
    if (separator_ == ',' && cells_ % 2 == 0 && cells_ >= 6 && mark_ == DecimalMark::None)
    {
      throw FileError(name_ + ": has " + std::to_string(cells_) +
        " whole numbers a line between commas, which may be half as many with decimal commas" +
        remedy + ", or write decimal points");
    }
    if (counts_ && mesh_.points() > 3)
    {
      throw FileError(name_ + ": the first of its " + std::to_string(cells_) +
        " columns counts the points" + remedy);
    }
    mesh_.note(name_ + ": has no header; the first three of its " + std::to_string(cells_) +
      " columns are taken as x, y and z");
  }

  std::string name_;
  TableLines table_;
  MeshBuilder mesh_;
  char separator_ = ' ';
  std::size_t cells_ = 3; ///< Of every line.
  Columns columns_ = { 0, 1, 2 };
  bool guessed_ = false; ///< Nothing names the columns.
  DecimalMark mark_ = DecimalMark::None;
  WrittenDigits digits_;
  std::string word_;
  bool counts_ = true;
  double last_ = 0.0;
};

} // namespace

Mesh parsePointTable(std::string_view bytes, const std::string& name)
{
  std::vector<std::string> notes;
  const std::string text = asUtf8(std::string(bytes), "", name, notes);
  Mesh mesh = PointTable(text, name).read();
  if (mesh.points.empty())
  {
    throw FileError(name + ": has no points, so no shape can be made of it");
  }
  for (const std::string& note : notes)
  {
    mesh.notes.push_back(name + ": " + note);
  }
  return mesh;
}

Mesh readPointTable(const std::string& fileName)
{
  return parsePointTable(readFile(fileName), fileName);
}

} // namespace rockfall
