#include "statistics/familyOfLines.h"

#include "base/require.h"
#include "base/text/numberText.h"

#include <cmath>
#include <string>

namespace rockfall
{

namespace
{

using Vec2 = Eigen::Vector2d;

constexpr int kMostLines = 1000; ///< With those that were given.

/// A bend sharper than about 154° has its corner more than 4.4 shifts away.
constexpr double kSharpest = 0.1; ///< 1 + cosine of the angle between the pieces' normals.

[[noreturn]] void refuse(const CollectorLine& line, double offset, const std::string& why)
{
  throw ParameterError("ParallelLines, ParallelSpacing: line \"" + line.name +
    "\" has no parallel at " + numberText(offset) + " m: " + why);
}

CollectorLine parallelOf(const CollectorLine& line, double offset)
{
  std::vector<Vec2> normals; // of each piece, to the left
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    const Vec2 along = (line.points[k] - line.points[k - 1]).normalized();
    normals.emplace_back(-along.y(), along.x());
  }
  CollectorLine result = line;
  result.offset = offset;
  result.name += (offset > 0.0 ? " +" : " −") + numberText(std::abs(offset)) + " m";
  // A closed line has a corner where it begins and ends.
  const bool closed = line.points.front() == line.points.back();
  const std::size_t first = closed ? normals.size() - 1 : 0, last = closed ? 0 : normals.size() - 1;
  for (std::size_t k = 0; k < line.points.size(); ++k)
  {
    const Vec2& before = normals[k > 0 ? k - 1 : first];
    const Vec2& after = normals[k < normals.size() ? k : last];
    const double bend = 1.0 + before.dot(after);
    if (bend < kSharpest)
    {
      refuse(line, offset, "it turns back at its point " + std::to_string(k + 1));
    }
    result.points[k] += offset / bend * (before + after);
  }
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    const Vec2 was = line.points[k] - line.points[k - 1];
    if (!(was.dot(result.points[k] - result.points[k - 1]) > 0.0))
    {
      refuse(line, offset, "its piece " + std::to_string(k) + " is too short");
    }
  }
  return result;
}

} // namespace

void addParallels(std::vector<CollectorLine>& lines, int count, double spacing)
{
  if (count < 0 || double(lines.size()) * (1.0 + count) > kMostLines)
  {
    throw ParameterError("ParallelLines is " + std::to_string(count) +
      ", it must be 0 or more, and all lines " + std::to_string(kMostLines) + " at most");
  }
  if (count == 0)
  {
    return;
  }
  require(std::abs(spacing) > 0.0 && std::isfinite(spacing), "ParallelSpacing", spacing, "",
    "finite and not 0");
  std::vector<CollectorLine> all;
  for (CollectorLine& line : lines)
  {
    all.push_back(line);
    for (int k = 1; k <= count; ++k)
    {
      all.push_back(parallelOf(line, k * spacing));
    }
  }
  lines = std::move(all);
}

} // namespace rockfall
