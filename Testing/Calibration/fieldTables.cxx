#include "fieldTables.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

namespace rockfall::calibration
{

namespace
{

std::vector<std::string> split(std::string line)
{
  if (!line.empty() && line.back() == '\r')
  {
    line.pop_back();
  }
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1)
  {
    comma = line.find(',', begin);
    cells.push_back(line.substr(begin, comma == std::string::npos ? comma : comma - begin));
  }
  return cells;
}

} // namespace

FieldTable::FieldTable(const std::string& fileName)
  : fileName_(fileName)
{
  std::ifstream file(fileName);
  std::string line;
  if (!file || !std::getline(file, line))
  {
    throw FileError(fileName + ": cannot be read, or is empty");
  }
  const std::vector<std::string> header = split(line);
  for (std::size_t k = 0; k < header.size(); ++k)
  {
    columns_[header[k]] = k;
  }
  while (std::getline(file, line))
  {
    rows_.push_back(split(line));
    if (rows_.back().size() != header.size())
    {
      throw DataError(fileName + ", line " + std::to_string(rows_.size() + 1) + ": has " +
        std::to_string(rows_.back().size()) + " cells, the header " +
        std::to_string(header.size()));
    }
  }
}

std::size_t FieldTable::column(const std::string& name) const
{
  const auto found = columns_.find(name);
  if (found == columns_.end())
  {
    throw DataError(fileName_ + ": there is no column \"" + name + "\"");
  }
  return found->second;
}

const std::string& FieldTable::text(std::size_t row, const std::string& name) const
{
  return rows_.at(row)[this->column(name)];
}

double FieldTable::number(std::size_t row, const std::string& name) const
{
  const std::string& cell = this->text(row, name);
  if (cell.empty() || cell == "nan" || cell == "NaN")
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
  {
    throw DataError(fileName_ + ", line " + std::to_string(row + 2) + ": field \"" + name +
      "\": \"" + cell + "\" is not a number");
  }
  return value;
}

Vec3 FieldTable::vector(std::size_t row, const std::string& head, const std::string& tail) const
{
  return { this->number(row, head + "x" + tail), this->number(row, head + "y" + tail),
    this->number(row, head + "z" + tail) };
}

Polyhedron makeCutBox(const Vec3& size, double volume)
{
  // Vertices are (±1, ±c, ±c) and the like, in halves of the size.
  const auto share = [](double c)
  { return c * c + c * (1.0 - c * c) + (1.0 - c) * (1.0 - c) * (1.0 + 2.0 * c) / 6.0; };
  const double wanted = volume / size.prod();
  if (!(wanted > share(0.0) && wanted < 1.0))
  {
    throw DataError("a rock of " + numberText(volume) + " m³ in a box of " +
      numberText(size.prod()) + " m³: it must fill 17 to 100 % of it");
  }
  double low = 0.0, high = 1.0;
  for (int k = 0; k < 60; ++k)
  {
    const double middle = 0.5 * (low + high);
    (share(middle) < wanted ? low : high) = middle;
  }
  std::vector<Vec3> points;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Vec3 corner((signs & 1) ? 1 : -1, (signs & 2) ? 1 : -1, (signs & 4) ? 1 : -1);
      const double whole = corner[axis];
      corner *= low;
      corner[axis] = whole;
      points.push_back(0.5 * corner.cwiseProduct(size));
    }
  }
  return Polyhedron::convexHull(points).withVolume(volume);
}

} // namespace rockfall::calibration
