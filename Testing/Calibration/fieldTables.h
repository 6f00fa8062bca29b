#pragma once

/// @file
/// Tables and rocks of field tests.

#include "geometry/Polyhedron.h"

#include <map>
#include <string>
#include <vector>

namespace rockfall::calibration
{

/// A table with a header, comma-separated, without quotes.
class FieldTable
{
public:
  /// Throws FileError or DataError naming file and line.
  explicit FieldTable(const std::string& fileName);

  std::size_t size() const { return rows_.size(); }
  const std::string& text(std::size_t row, const std::string& column) const;
  /// NaN where the cell is empty or says nan.
  double number(std::size_t row, const std::string& column) const;
  /// Of three columns `head`x`tail`, …y…, …z….
  Vec3 vector(std::size_t row, const std::string& head, const std::string& tail) const;

private:
  std::size_t column(const std::string& name) const;

  std::string fileName_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A box of this size (m) whose edges and corners are cut off, 26 faces, by so much that it has
/// this volume (m³): the EOTA blocks, stretched. Throws DataError if no cut gives it.
Polyhedron makeCutBox(const Vec3& size, double volume);

} // namespace rockfall::calibration
