#include "statistics/HazardRaster.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "statistics/DiscSwath.h"
#include "terrain/Terrain.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace rockfall
{

namespace
{

constexpr double none = -std::numeric_limits<double>::infinity();

/// Between two cuts less than this of the way apart there is no cell, only rounding: a path through
/// the corner of four cells. m
constexpr double leastWay = 1e-9;

constexpr std::int64_t kPathsAtOnce = 16;    ///< Paths that one thread takes.
constexpr std::int64_t kPathsOfRound = 1024; ///< Paths whose passages wait to be taken in.

/// Appends where `value` (of bounds low, high) passes a multiple of `size` from `start` on.
void appendCuts(const Cubic& value, std::array<double, 2> bounds, double start, double size,
  double firstLine, double lastLine, double from, double to, std::vector<double>& cuts)
{
  const double first = std::max(firstLine, std::ceil((bounds[0] - start) / size));
  const double last = std::min(lastLine, std::floor((bounds[1] - start) / size));
  for (double line = first; line <= last; ++line)
  {
    Cubic shifted = value;
    shifted.c[0] -= start + line * size;
    const Roots roots = signChanges(shifted, from, to);
    cuts.insert(cuts.end(), roots.at.begin(), roots.at.begin() + roots.count);
  }
}

/// Bounds of a value between two places, of its Bézier points there and what rounding may add.
std::array<double, 2> boundsOf(const Cubic& f, double from, double to)
{
  constexpr double rounding = 1e-9; // of the value
  const auto blossom = [&f](double u, double v, double w)
  {
    return f.c[0] + f.c[1] * (u + v + w) / 3.0 + f.c[2] * (u * v + v * w + w * u) / 3.0 +
      f.c[3] * u * v * w;
  };
  const auto [low, high] =
    std::minmax({ f(from), blossom(from, from, to), blossom(from, to, to), f(to) });
  const double more = rounding * (1.0 + std::max(std::abs(low), std::abs(high)));
  return { low - more, high + more };
}

/// Seen from above.
bool isShort(const PathPiece& piece, double from, double to)
{
  const auto isNear = [&](double s)
  {
    return std::hypot(piece.along(0)(s) - piece.along(0)(from),
             piece.along(1)(s) - piece.along(1)(from)) < leastWay;
  };
  return isNear(to) && isNear(0.5 * (from + to));
}

Cubic sum(const Cubic& a, const Cubic& b)
{
  return { { a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2], a.c[3] + b.c[3] } };
}

Cubic difference(const Cubic& a, const Cubic& b)
{
  return { { a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2], a.c[3] - b.c[3] } };
}

double maximum(const Cubic& f, double from, double to)
{
  double most = std::max(f(from), f(to));
  const Roots turns = extremes(f, from, to);
  for (int k = 0; k < turns.count; ++k)
  {
    most = std::max(most, f(turns.at[std::size_t(k)]));
  }
  return most;
}

Maxima maximaAt(const PathPoint& point)
{
  return { float(point.kineticEnergy), float(point.velocity.norm()),
    float(std::isnan(point.heightOverGround) ? none : point.heightOverGround),
    float(point.rotationRate.norm()) };
}

} // namespace

HazardRaster::HazardRaster(const CellGrid& grid, const Terrain* terrain)
  : grid_(grid)
  , terrain_(terrain)
{
  if (grid.columns < 1 || grid.rows < 1 || !(grid.cellSize > 0.0) ||
    grid.cellCount() > std::int64_t(std::numeric_limits<std::uint32_t>::max()))
  {
    throw ParameterError("A hazard raster of " + std::to_string(grid.columns) + " x " +
      std::to_string(grid.rows) + " cells cannot be made");
  }
}

std::int64_t HazardRaster::cellAt(double x, double y) const
{
  const auto index = [this](double place, double start, int count)
  {
    const double found = std::floor((place - start) / grid_.cellSize);
    // A point on the outer border is on the map.
    return found == count && place <= start + count * grid_.cellSize ? count - 1.0 : found;
  };
  const double column = index(x, grid_.west, grid_.columns);
  const double row = index(y, grid_.south, grid_.rows);
  return column >= 0.0 && column < grid_.columns && row >= 0.0 && row < grid_.rows
    ? std::int64_t(row) * grid_.columns + std::int64_t(column)
    : -1;
}

std::uint32_t HazardRaster::angleAt(const Vec3& place) const
{
  const Vec3 up = release_ - place;
  const double away = up.head<2>().norm();
  const double share = away > 0.0 ? 2.0 * std::numbers::inv_pi * std::atan2(up.z(), away) : 1.0;
  return std::uint32_t(std::lround(std::clamp(share, 0.0, 1.0) * Passage::kAngleSteps));
}

void HazardRaster::addVisit(std::int64_t cell, const Maxima& maxima, const Vec3& place)
{
  if (cell >= 0 && cell == here_)
  {
    visits_.back().angle = this->angleAt(place);
    raise(visits_.back().maxima, maxima);
  }
  else if (cell >= 0)
  {
    Passage& visit = visits_.emplace_back();
    visit.cell = std::uint32_t(cell);
    visit.maxima = maxima;
    visit.angle = this->angleAt(place);
  }
  here_ = cell;
}

Maxima HazardRaster::maximaOf(
  const PathPiece& piece, double from, double to, std::array<double, 2> grounds) const
{
  return { float(piece.maxKineticEnergy(from, to)), float(piece.maxSpeed(from, to)),
    float(this->maxHeight(piece, from, to, grounds)), float(piece.maxRotationRate(from, to)) };
}

double HazardRaster::maxHeight(
  const PathPiece& piece, double from, double to, std::array<double, 2> grounds) const
{
  // With one end beyond the ground the terrain still is what lies under the rest of the way.
  if (!terrain_ || (std::isnan(grounds[0]) && std::isnan(grounds[1])))
  {
    const double most = maximum(piece.height(), from, to);
    return std::isnan(most) ? none : most;
  }
  // Between the sides of the CFEs the ground is a plane under the path, so the height is a cubic.
  const double size = terrain_->geometry().cellSize;
  const double lines = terrain_->geometry().columns + double(terrain_->geometry().rows);
  const Cubic height = piece.height(grounds[0], grounds[1]);
  const Cubic &x = piece.along(0), &y = piece.along(1);
  groundCuts_.assign({ from, to });
  const auto cut = [&](const Cubic& value, double firstLine)
  {
    appendCuts(
      value, boundsOf(value, from, to), 0.0, size, firstLine, lines, from, to, groundCuts_);
  };
  cut(x, 0.0);
  cut(y, 0.0);
  // Cuts of cells: x + y is the same all along one that falls, x − y along one that rises. A line
  // is cut off where the path is in cells with the other cut, too: nothing changes there.
  cut(sum(x, y), 0.0);
  if (terrain_->geometry().diagonal != CellDiagonal::FromUpperLeft)
  {
    cut(difference(x, y), -lines);
  }
  std::sort(groundCuts_.begin(), groundCuts_.end());
  const bool still = isShort(piece, from, to);
  double most = none;
  for (std::size_t k = 1; k < groundCuts_.size(); ++k)
  {
    const double a = groundCuts_[k - 1], b = groundCuts_[k];
    if (!(b > a) || (!still && isShort(piece, a, b)))
    {
      continue; // nothing between the cuts
    }
    const double middle = 0.5 * (a + b);
    const std::int64_t id = terrain_->cfeAt(x(middle), y(middle));
    if (id == 0)
    {
      continue; // no ground
    }
    const Cfe cfe = terrain_->cfe(id);
    const double slopeX = -cfe.normal.x() / cfe.normal.z(),
                 slopeY = -cfe.normal.y() / cfe.normal.z();
    Cubic over = height;
    for (std::size_t i = 0; i < 4; ++i)
    {
      over.c[i] -= slopeX * x.c[i] + slopeY * y.c[i];
    }
    over.c[0] -= cfe.nodes[0].z() - slopeX * cfe.nodes[0].x() - slopeY * cfe.nodes[0].y();
    const double value = maximum(over, a, b);
    most = std::isnan(value) ? most : std::max(most, value);
  }
  return most;
}

void HazardRaster::addPiece(const PathPiece& piece, std::array<double, 2> grounds)
{
  cuts_.assign({ 0.0, 1.0 });
  appendCuts(piece.along(0), piece.bounds(0), grid_.west, grid_.cellSize, 0.0, grid_.columns, 0.0,
    1.0, cuts_);
  appendCuts(
    piece.along(1), piece.bounds(1), grid_.south, grid_.cellSize, 0.0, grid_.rows, 0.0, 1.0, cuts_);
  std::sort(cuts_.begin() + 2, cuts_.end());
  std::rotate(cuts_.begin() + 1, cuts_.begin() + 2, cuts_.end()); // the end behind the crossings
  const auto visit = [&](std::int64_t cell, double from, double to)
  {
    this->addVisit(
      cell, cell >= 0 ? this->maximaOf(piece, from, to, grounds) : Maxima(), piece.position(to));
  };
  const auto cellOf = [&](double s) { return this->cellAt(piece.along(0)(s), piece.along(1)(s)); };
  bool visited = false;
  for (std::size_t k = 1; k < cuts_.size(); ++k)
  {
    const double from = cuts_[k - 1], to = cuts_[k];
    const bool whole = cuts_.size() == 2;
    if (!whole && isShort(piece, from, to))
    {
      continue;
    }
    visit(cellOf(0.5 * (from + to)), from, to);
    visited = true;
  }
  if (!visited)
  {
    // A rock that stays on a border but for rounding: in the cell where the rock was, else in any
    // of them.
    std::int64_t cell = here_;
    for (std::size_t k = cuts_.size(); cell < 0 && k > 0; --k)
    {
      cell = cellOf(cuts_[k - 1]);
    }
    visit(cell, 0.0, 1.0);
  }
}

void HazardRaster::add(const RockPath& path)
{
  stayWanted();
  checkPath(path);
  const auto as = [](const RockPath& of) { return std::tie(of.iteration, of.rock, of.blockId); };
  const std::size_t before = passages_.size();
  if (path.piece > 0 && released_ > 0 && as(path) == as(rock_))
  {
    this->addWhole(path);
    const Vec3 birth = path.points.empty() ? release_ : path.points.front().position;
    this->joinRock(before, this->cellAt(birth.x(), birth.y()));
    return;
  }
  ++released_;
  ++releasedIn_[path.iteration];
  rockBegin_ = before;
  rock_ = path;
  rock_.points = {};
  release_ = path.points.empty() ? Vec3::Zero() : path.points.front().position;
  this->addWhole(path);
}

void HazardRaster::joinRock(std::size_t piece, std::int64_t birth)
{
  const auto rock = passages_.begin() + std::ptrdiff_t(rockBegin_);
  // In a cell of both the rock's passage comes before the piece's.
  std::inplace_merge(rock, passages_.begin() + std::ptrdiff_t(piece), passages_.end(),
    [](const Passage& a, const Passage& b) { return a.cell < b.cell; });
  if (rock == passages_.end())
  {
    return;
  }
  auto last = rock;
  for (auto next = rock; next != passages_.end(); ++next)
  {
    if (next == rock || next->cell != last->cell)
    {
      last += next == rock ? 0 : 1;
      *last = *next;
      continue;
    }
    // The piece came to be in its cell of birth, and has not entered it.
    last->join(*next, next->entries - (next->cell == birth ? 1 : 0));
  }
  passages_.erase(last + 1, passages_.end());
}

template <class Use>
bool HazardRaster::forPieces(const RockPath& path, Use&& use) const
{
  bool moved = false;
  double before = this->groundUnder(path.points.front());
  for (std::size_t k = 1; k < path.points.size(); ++k)
  {
    const PathPoint &a = path.points[k - 1], &b = path.points[k];
    if (b.time > a.time)
    {
      const double after = this->groundUnder(b);
      use(PathPiece(a, b, path.mass), std::array{ before, after });
      before = after;
      moved = true;
    }
  }
  return moved;
}

void HazardRaster::addWhole(const RockPath& path)
{
  if (path.width > grid_.cellSize && !path.points.empty())
  {
    this->addSwath(path);
    return;
  }
  visits_.clear();
  here_ = -1;
  if (path.points.empty())
  {
    return;
  }
  const bool moved = this->forPieces(path,
    [this](const PathPiece& piece, std::array<double, 2> grounds)
    { this->addPiece(piece, grounds); });
  const PathPoint& last = path.points.back();
  const std::int64_t end = this->cellAt(last.position.x(), last.position.y());
  // Also one that came from beyond and rests on the map's border.
  if (!moved || (path.rested && here_ < 0 && end >= 0))
  {
    this->addVisit(end, maximaAt(last), last.position);
  }
  if (path.rested && here_ >= 0)
  {
    visits_.back().stopped = 1; // that of here_
  }
  std::stable_sort(visits_.begin(), visits_.end(),
    [](const Passage& a, const Passage& b) { return a.cell < b.cell; });
  for (const Passage& visit : visits_)
  {
    Passage* known = passages_.empty() ? nullptr : &passages_.back();
    if (known && &visit != &visits_.front() && known->cell == visit.cell)
    {
      known->join(visit, 1);
      continue;
    }
    this->keep(path, visit);
  }
}

void HazardRaster::addAll(std::int64_t count, const ReadPaths& read)
{
  for (std::int64_t round = 0; round < count; round += kPathsOfRound)
  {
    const std::int64_t end = std::min(count, round + kPathsOfRound);
    std::vector<HazardRaster> parts(
      std::size_t((end - round + kPathsAtOnce - 1) / kPathsAtOnce), HazardRaster(grid_, terrain_));
    forEach(parts.size(), 1,
      [&](std::size_t k)
      {
        const std::int64_t first = round + std::int64_t(k) * kPathsAtOnce;
        read(first, std::min(kPathsAtOnce, end - first),
          [&](const RockPath& path) { parts[k].add(path); });
      });
    for (const HazardRaster& part : parts)
    {
      this->merge(part);
    }
  }
}

void HazardRaster::keep(const RockPath& path, const Passage& visit)
{
  Passage& passage = passages_.emplace_back(visit);
  passage.iteration = path.iteration;
  passage.rock = path.rock;
  passage.blockId = path.blockId;
}

double HazardRaster::groundUnder(const PathPoint& point) const
{
  return terrain_ ? terrain_->elevation(point.position.x(), point.position.y()) : 0.0;
}

void HazardRaster::addSwath(const RockPath& path)
{
  DiscSwath swath(grid_, 0.5 * path.width);
  const bool moved = this->forPieces(path,
    [&](const PathPiece& piece, std::array<double, 2> grounds)
    {
      const auto xs = piece.bounds(0), ys = piece.bounds(1);
      const double longest = std::hypot(xs[1] - xs[0], ys[1] - ys[0]);
      const int parts = std::max(1, int(std::ceil(2.0 * longest / grid_.cellSize)));
      for (int part = 0; part < parts; ++part)
      {
        const double from = double(part) / parts, to = double(part + 1) / parts;
        swath.add(piece.position(from).head<2>(), piece.position(to).head<2>(),
          this->maximaOf(piece, from, to, grounds), this->angleAt(piece.position(to)));
      }
    });
  const PathPoint& last = path.points.back();
  if (!moved)
  {
    const Eigen::Vector2d place = last.position.head<2>();
    swath.add(place, place, maximaAt(last), this->angleAt(last.position));
  }
  if (path.rested)
  {
    swath.stop(this->cellAt(last.position.x(), last.position.y()));
  }
  for (const auto& [cell, visited] : swath.cells())
  {
    this->keep(path, visited.passage);
  }
}

void HazardRaster::merge(const HazardRaster& other)
{
  const auto gridOf = [](const CellGrid& g)
  { return std::tie(g.columns, g.rows, g.cellSize, g.west, g.south); };
  if (gridOf(grid_) != gridOf(other.grid_))
  {
    throw ParameterError("Hazard rasters of different grids cannot be merged");
  }
  passages_.insert(passages_.end(), other.passages_.begin(), other.passages_.end());
  for (const auto& [iteration, count] : other.releasedIn_)
  {
    releasedIn_[iteration] += count;
  }
  released_ += other.released_;
}

const std::vector<Passage>& HazardRaster::sorted()
{
  tbb::parallel_sort(passages_.begin(), passages_.end());
  return passages_;
}

} // namespace rockfall
