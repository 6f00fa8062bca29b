#include "contact/pair/broadPhase.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Rocks that one thread looks after at a time.
constexpr std::size_t kRocksOfTask = 256;

/// Cells of a map along an axis at most; the three numbers of a cell are one of 63 bits.
constexpr int kBits = 21;
constexpr double kMostCellsOfAxis = double((1 << kBits) - 4);

std::int64_t cellNumber(std::int64_t x, std::int64_t y, std::int64_t z)
{
  return (z << (2 * kBits)) + (y << kBits) + x;
}

bool overlap(const Vec3& a, double ra, const Vec3& b, double rb)
{
  const double reach = ra + rb;
  return (a - b).squaredNorm() <= reach * reach;
}

} // namespace

std::array<std::int64_t, 3> BroadPhase::cellOf(const Map& map, const Vec3& x) const
{
  std::array<std::int64_t, 3> cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    // From 1 on: there is a cell before the first one, and one behind the last.
    const double number = std::floor((x[axis] - lower_[axis]) / map.size);
    cell[axis] = 1 + std::int64_t(std::clamp(number, -1.0, kMostCellsOfAxis));
  }
  return cell;
}

const BroadPhase::Entry* BroadPhase::atOrAfter(const Map& map, std::int64_t cell) const
{
  const Entry* entries = entries_.data();
  return std::lower_bound(entries + map.first, entries + map.last, cell,
    [](const Entry& entry, std::int64_t number) { return entry.cell < number; });
}

void BroadPhase::place(std::span<const BroadBox> boxes)
{
  count_ = boxes.size();
  entries_.clear();
  maps_.clear();
  order_.clear();
  Vec3 upper = Vec3::Constant(-1e300);
  lower_.setConstant(1e300);
  double largest = 1e-9;
  for (const BroadBox& box : boxes)
  {
    largest = box.present ? std::max(largest, box.radius) : largest;
  }
  largest *= 1.0 + 1e-9;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    if (boxes[i].present)
    {
      // By power of two of the size first: rocks of half the largest size and more are of one map.
      int power = 0;
      std::frexp(std::max(boxes[i].radius, 1e-9) / largest, &power);
      order_.push_back({ power, 0, std::int64_t(i) });
      lower_ = lower_.cwiseMin(boxes[i].center);
      upper = upper.cwiseMax(boxes[i].center);
    }
  }
  const auto oneSize = [](const auto& a, const auto& b) { return a[0] < b[0]; };
  if (!std::is_sorted(order_.begin(), order_.end(), oneSize))
  {
    std::stable_sort(order_.begin(), order_.end(), oneSize);
  }
  for (std::size_t first = 0; first < order_.size();)
  {
    Map map{ first, first, 0.0, 0.0 };
    for (; map.last < order_.size() && order_[map.last][0] == order_[first][0]; ++map.last)
    {
      map.largestRadius =
        std::max(map.largestRadius, boxes[std::size_t(order_[map.last][2])].radius);
    }
    // A hair more than a diameter, so that rounding puts nothing two cells away.
    map.size = std::max({ 2.0 * map.largestRadius * (1.0 + 1e-9), 1e-9,
      (upper - lower_).maxCoeff() / (kMostCellsOfAxis - 4.0) });
    for (std::size_t k = map.first; k < map.last; ++k)
    {
      const auto cell = this->cellOf(map, boxes[std::size_t(order_[k][2])].center);
      order_[k][1] = cellNumber(cell[0], cell[1], cell[2]);
    }
    std::sort(
      order_.begin() + std::ptrdiff_t(map.first), order_.begin() + std::ptrdiff_t(map.last));
    maps_.push_back(map);
    first = map.last;
  }
  entries_.reserve(order_.size());
  for (const auto& [power, cell, index] : order_)
  {
    const BroadBox& box = boxes[std::size_t(index)];
    entries_.push_back({ box.center, box.radius, cell, int(index), box.moves });
  }
}

void BroadPhase::searchOwn(const Map& map, std::size_t first, std::size_t last, Found& found) const
{
  // The half of the neighbouring cells that comes later: four rows, through which a pointer each
  // goes on as the cells do, and what follows in the own row.
  const std::array<std::int64_t, 4> rows = { cellNumber(-1, 1, 0), cellNumber(-1, -1, 1),
    cellNumber(-1, 0, 1), cellNumber(-1, 1, 1) };
  const Entry* const end = entries_.data() + map.last;
  std::array<const Entry*, 4> next;
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    next[k] = this->atOrAfter(map, entries_[first].cell + rows[k]);
  }
  for (std::size_t e = first; e < last; ++e)
  {
    const Entry& a = entries_[e];
    const auto meet = [&](const Entry& b)
    {
      if (overlap(a.center, a.radius, b.center, b.radius) && (a.moves || b.moves))
      {
        found.push_back({ std::min(a.index, b.index), std::max(a.index, b.index) });
      }
    };
    for (const Entry* b = &a + 1; b != end && b->cell <= a.cell + 1; ++b)
    {
      meet(*b);
    }
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      const std::int64_t cell = a.cell + rows[k];
      while (next[k] != end && next[k]->cell < cell)
      {
        ++next[k];
      }
      for (const Entry* b = next[k]; b != end && b->cell <= cell + 2; ++b)
      {
        meet(*b);
      }
    }
  }
}

void BroadPhase::searchLarger(
  const Map& map, std::size_t first, std::size_t last, Found& found) const
{
  const Entry* const end = entries_.data() + map.last;
  for (std::size_t e = first; e < last; ++e)
  {
    const Entry& a = entries_[e];
    const auto cell = this->cellOf(map, a.center);
    for (int row = 0; row < 9; ++row)
    {
      const std::int64_t from =
        cellNumber(cell[0] - 1, cell[1] + row % 3 - 1, cell[2] + row / 3 - 1);
      for (const Entry* b = this->atOrAfter(map, from); b != end && b->cell <= from + 2; ++b)
      {
        if (overlap(a.center, a.radius, b->center, b->radius) && (a.moves || b->moves))
        {
          found.push_back({ std::min(a.index, b->index), std::max(a.index, b->index) });
        }
      }
    }
  }
}

std::span<const std::array<int, 2>> BroadPhase::pairs()
{
  // Rocks of each map and of all maps of smaller ones look for those of this map.
  const std::size_t parts = (entries_.size() + kRocksOfTask - 1) / kRocksOfTask;
  parts_.resize(std::max(parts, parts_.size()));
  forEach(parts, 1,
    [&](std::size_t part)
    {
      Found& found = parts_[part];
      found.clear();
      const std::size_t first = part * kRocksOfTask,
                        last = std::min(entries_.size(), first + kRocksOfTask);
      for (const Map& map : maps_)
      {
        const std::size_t from = std::max(first, map.first), to = std::min(last, map.last);
        if (from < to)
        {
          this->searchOwn(map, from, to, found);
        }
        if (first < map.first)
        {
          this->searchLarger(map, first, std::min(last, map.first), found);
        }
      }
    });
  // In order: by the first of the two, then each list for itself.
  firsts_.assign(count_ + 1, 0);
  for (std::size_t part = 0; part < parts; ++part)
  {
    for (const std::array<int, 2>& pair : parts_[part])
    {
      ++firsts_[std::size_t(pair[0])];
    }
  }
  std::size_t sum = 0;
  for (std::size_t& first : firsts_)
  {
    sum += std::exchange(first, sum);
  }
  pairs_.resize(sum);
  for (std::size_t part = 0; part < parts; ++part)
  {
    for (const std::array<int, 2>& pair : parts_[part])
    {
      pairs_[firsts_[std::size_t(pair[0])]++] = pair;
    }
  }
  forEach(count_, kRocksOfTask,
    [&](std::size_t i)
    {
      const std::size_t first = i == 0 ? 0 : firsts_[i - 1]; // each is at the end of its list now
      std::sort(
        pairs_.begin() + std::ptrdiff_t(first), pairs_.begin() + std::ptrdiff_t(firsts_[i]));
    });
  return pairs_;
}

void BroadPhase::within(const Vec3& center, double radius, std::vector<int>& found) const
{
  found.clear();
  for (const Map& map : maps_)
  {
    const Vec3 reach = Vec3::Constant((radius + map.largestRadius) * (1.0 + 1e-9));
    const auto from = this->cellOf(map, center - reach), to = this->cellOf(map, center + reach);
    const auto look = [&](const Entry* b, const Entry* end, std::int64_t last)
    {
      for (; b != end && b->cell <= last; ++b)
      {
        if (overlap(center, radius, b->center, b->radius))
        {
          found.push_back(b->index);
        }
      }
    };
    const Entry* const end = entries_.data() + map.last;
    if (std::size_t((to[1] - from[1] + 1) * (to[2] - from[2] + 1)) > map.last - map.first)
    {
      look(entries_.data() + map.first, end, end[-1].cell);
      continue;
    }
    for (std::int64_t z = from[2]; z <= to[2]; ++z)
    {
      for (std::int64_t y = from[1]; y <= to[1]; ++y)
      {
        look(this->atOrAfter(map, cellNumber(from[0], y, z)), end, cellNumber(to[0], y, z));
      }
    }
  }
  std::sort(found.begin(), found.end());
}

std::vector<std::array<int, 2>> findNear(std::span<const BroadBox> boxes)
{
  BroadPhase map;
  map.place(boxes);
  const std::span<const std::array<int, 2>> pairs = map.pairs();
  return { pairs.begin(), pairs.end() };
}

} // namespace rockfall
