#include "terrain/flats.h"

#include "base/abort.h"
#include "base/types.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rockfall
{

namespace
{

/// Areas of more nodes than this are solved on a coarser grid first.
constexpr std::size_t mostUnknowns = 100000;
/// Sweeps that refine what comes from a coarser grid: what is left then is smooth, and right.
constexpr int sweeps = 60;
/// Nodes that meet a bound are held there and the others solved again, so often at most.
constexpr int mostBounds = 10;
/// Holds what too few heights around it hold: a plate on one side of a straight line could turn.
constexpr double hold = 1e-9;

/// A squared second difference: Σ factor · height, with `weight`.
struct Bend
{
  std::array<std::int64_t, 4> nodes;
  std::array<double, 4> factors;
  int count;
  double weight;
};

/// The raster with what is known of it.
struct Plate
{
  int columns, rows;
  std::vector<double> heights;
  std::vector<std::uint8_t> free;
  std::vector<double> low, high; ///< Bounds of the free nodes, m.
  std::vector<int> number;       ///< Of an unknown while an area is solved; else −1.

  bool known(int row, int column) const
  {
    return row >= 0 && column >= 0 && row < rows && column < columns &&
      !std::isnan(heights[this->at(row, column)]);
  }
  std::size_t at(int row, int column) const { return std::size_t(row) * columns + column; }

  /// Calls visit(bend) for all second differences in which a node takes part.
  template <typename Visit>
  void forEachBend(std::int64_t node, Visit&& visit) const
  {
    const int row = int(node / columns), column = int(node % columns);
    for (int k = -2; k <= 0; ++k)
    {
      if (this->known(row, column + k) && this->known(row, column + k + 1) &&
        this->known(row, column + k + 2))
      {
        visit(Bend{ { node + k, node + k + 1, node + k + 2, 0 }, { 1.0, -2.0, 1.0, 0.0 }, 3, 1.0 });
      }
      if (this->known(row + k, column) && this->known(row + k + 1, column) &&
        this->known(row + k + 2, column))
      {
        const std::int64_t first = node + std::int64_t(k) * columns;
        visit(Bend{
          { first, first + columns, first + 2 * columns, 0 }, { 1.0, -2.0, 1.0, 0.0 }, 3, 1.0 });
      }
    }
    for (int r = row - 1; r <= row; ++r)
    {
      for (int c = column - 1; c <= column; ++c)
      {
        if (this->known(r, c) && this->known(r, c + 1) && this->known(r + 1, c) &&
          this->known(r + 1, c + 1))
        {
          const std::int64_t first = std::int64_t(this->at(r, c));
          visit(Bend{ { first, first + 1, first + columns, first + columns + 1 },
            { 1.0, -1.0, -1.0, 1.0 }, 4, 2.0 });
        }
      }
    }
  }

  /// The free nodes that depend on each other, each group in ascending order.
  std::vector<std::vector<std::int64_t>> areas() const
  {
    std::vector<std::vector<std::int64_t>> result;
    std::vector<std::uint8_t> seen(free.size(), 0);
    for (std::size_t start = 0; start < free.size(); ++start)
    {
      if (!free[start] || seen[start])
      {
        continue;
      }
      std::vector<std::int64_t> area{ std::int64_t(start) };
      seen[start] = 1;
      for (std::size_t next = 0; next < area.size(); ++next)
      {
        stayWanted();
        this->forEachBend(area[next],
          [&](const Bend& bend)
          {
            for (int i = 0; i < bend.count; ++i)
            {
              const std::size_t node = std::size_t(bend.nodes[i]);
              if (free[node] && !seen[node])
              {
                seen[node] = 1;
                area.push_back(bend.nodes[i]);
              }
            }
          });
      }
      std::sort(area.begin(), area.end());
      result.push_back(std::move(area));
    }
    return result;
  }
};

/// The least energy of one area by a direct solution, with its bounds.
void solve(Plate& plate, const std::vector<std::int64_t>& area)
{
  std::vector<std::uint8_t> held(area.size(), 0);
  const auto numberOf = [&](std::int64_t node) -> int& { return plate.number[std::size_t(node)]; };
  for (int round = 0; round <= mostBounds; ++round)
  {
    stayWanted();
    int unknowns = 0;
    for (std::size_t i = 0; i < area.size(); ++i)
    {
      numberOf(area[i]) = held[i] ? -1 : unknowns++;
    }
    if (unknowns == 0)
    {
      return;
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t i = 0; i < area.size(); ++i)
    {
      if (held[i])
      {
        continue;
      }
      const int own = numberOf(area[i]);
      entries.emplace_back(own, own, hold);
      load[own] += hold * plate.heights[std::size_t(area[i])];
      // The row of this node: ½ ∂E/∂z.
      plate.forEachBend(area[i],
        [&](const Bend& bend)
        {
          double share = 0.0;
          for (int k = 0; k < bend.count; ++k)
          {
            share = bend.nodes[k] == area[i] ? bend.factors[k] : share;
          }
          for (int k = 0; k < bend.count; ++k)
          {
            const double factor = bend.weight * share * bend.factors[k];
            const int other = numberOf(bend.nodes[k]);
            if (other < 0)
            {
              load[own] -= factor * plate.heights[std::size_t(bend.nodes[k])];
            }
            else if (other <= own)
            {
              entries.emplace_back(own, other, factor);
            }
          }
        });
    }
    Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    const Eigen::VectorXd z = factors.solve(load);
    bool beyond = false;
    for (std::size_t i = 0; i < area.size(); ++i)
    {
      const std::size_t node = std::size_t(area[i]);
      if (held[i])
      {
        continue;
      }
      const double height = z[numberOf(area[i])];
      plate.heights[node] = std::clamp(height, plate.low[node], plate.high[node]);
      if (plate.heights[node] != height)
      {
        held[i] = 1;
        beyond = true;
      }
    }
    if (!beyond)
    {
      return;
    }
  }
}

void relax(Plate& plate);

/// An area of many nodes: from every second node, then refined by taking node after node to its
/// place of least energy.
void refine(Plate& plate, const std::vector<std::int64_t>& area)
{
  Plate coarse;
  coarse.columns = (plate.columns + 1) / 2;
  coarse.rows = (plate.rows + 1) / 2;
  const std::size_t size = std::size_t(coarse.columns) * coarse.rows;
  coarse.heights.resize(size);
  coarse.free.assign(size, 0);
  coarse.low.resize(size);
  coarse.high.resize(size);
  coarse.number.assign(size, -1);
  for (int row = 0; row < coarse.rows; ++row)
  {
    for (int column = 0; column < coarse.columns; ++column)
    {
      const std::size_t from = plate.at(2 * row, 2 * column), to = coarse.at(row, column);
      coarse.heights[to] = plate.heights[from];
      coarse.low[to] = plate.low[from];
      coarse.high[to] = plate.high[from];
    }
  }
  const auto isCoarse = [&](std::int64_t node)
  { return node / plate.columns % 2 == 0 && node % plate.columns % 2 == 0; };
  for (const std::int64_t node : area)
  {
    if (isCoarse(node))
    {
      coarse.free[coarse.at(int(node / plate.columns) / 2, int(node % plate.columns) / 2)] = 1;
    }
  }
  relax(coarse);
  for (const std::int64_t node : area)
  {
    const int row = int(node / plate.columns), column = int(node % plate.columns);
    double sum = 0.0;
    int count = 0;
    for (const int r : { row / 2, (row + 1) / 2 })
    {
      for (const int c : { column / 2, (column + 1) / 2 })
      {
        if (coarse.known(r, c))
        {
          sum += coarse.heights[coarse.at(r, c)];
          ++count;
        }
      }
    }
    plate.heights[std::size_t(node)] = count ? sum / count : plate.heights[std::size_t(node)];
  }
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    for (const std::int64_t node : area)
    {
      stayWanted();
      double slope = 0.0, curvature = 0.0; // of the energy
      plate.forEachBend(node,
        [&](const Bend& bend)
        {
          double value = 0.0, own = 0.0;
          for (int k = 0; k < bend.count; ++k)
          {
            value += bend.factors[k] * plate.heights[std::size_t(bend.nodes[k])];
            own = bend.nodes[k] == node ? bend.factors[k] : own;
          }
          slope += bend.weight * own * value;
          curvature += bend.weight * own * own;
        });
      if (curvature > 0.0)
      {
        double& height = plate.heights[std::size_t(node)];
        height = std::clamp(
          height - slope / curvature, plate.low[std::size_t(node)], plate.high[std::size_t(node)]);
      }
    }
  }
}

void relax(Plate& plate)
{
  // Areas have no bend in common, so the numbers of one are never met in another.
  for (const std::vector<std::int64_t>& area : plate.areas())
  {
    area.size() <= mostUnknowns ? solve(plate, area) : refine(plate, area);
  }
}

} // namespace

std::int64_t relaxFlats(int columns, int rows, std::span<double> heights,
  std::span<const std::uint8_t> flat, std::span<const double> levels)
{
  if (levels.size() < 2)
  {
    return 0; // one height: there is no slope to join
  }
  Plate plate;
  plate.columns = columns;
  plate.rows = rows;
  plate.heights.assign(heights.begin(), heights.end());
  plate.free.assign(flat.begin(), flat.end());
  plate.low.assign(heights.size(), 0.0);
  plate.high.assign(heights.size(), 0.0);
  plate.number.assign(heights.size(), -1);
  for (std::size_t node = 0; node < heights.size(); ++node)
  {
    if (!flat[node])
    {
      continue;
    }
    const double z = heights[node];
    const auto own = std::lower_bound(levels.begin(), levels.end(), z);
    const auto above = std::upper_bound(levels.begin(), levels.end(), z);
    const bool lowest = own == levels.begin(), highest = above == levels.end();
    // Beyond the outermost contours the next interval is taken to be like the last.
    const double down = lowest ? levels[1] - levels[0] : z - *(own - 1);
    const double up = highest ? levels.back() - *(levels.end() - 2) : *above - z;
    plate.low[node] = z - down;
    plate.high[node] = z + up;
  }
  relax(plate);
  std::int64_t changed = 0;
  for (std::size_t node = 0; node < heights.size(); ++node)
  {
    changed += flat[node] && plate.heights[node] != heights[node];
    heights[node] = flat[node] ? plate.heights[node] : heights[node];
  }
  return changed;
}

} // namespace rockfall
