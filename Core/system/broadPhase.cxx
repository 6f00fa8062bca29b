#include "system/broadPhase.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rockfall
{

namespace
{

constexpr std::size_t kPart = 256; // rocks that one thread looks after at a time

struct Entry
{
  std::int64_t row, column;
  int index;
};

bool before(const Entry& a, const Entry& b)
{
  return a.row != b.row ? a.row < b.row
                        : (a.column != b.column ? a.column < b.column : a.index < b.index);
}

std::int64_t cellOf(double x, double size)
{
  return std::int64_t(std::floor(x / size));
}

} // namespace

std::vector<std::array<int, 2>> findNear(std::span<const BroadBox> boxes)
{
  // Level k has cells of 2ᵏ m, no smaller than the diameters of its rocks.
  std::vector<int> level(boxes.size(), 0);
  int lowest = 1 << 20, highest = -(1 << 20);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    if (boxes[i].present)
    {
      level[i] = int(std::ceil(std::log2(std::max(2.0 * boxes[i].radius, 1e-9))));
      lowest = std::min(lowest, level[i]);
      highest = std::max(highest, level[i]);
    }
  }
  std::vector<std::vector<std::array<int, 2>>> parts((boxes.size() + kPart - 1) / kPart);
  std::vector<Entry> entries;
  for (int k = lowest; k <= highest; ++k)
  {
    const double size = std::ldexp(1.0, k);
    entries.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      if (boxes[i].present && level[i] == k)
      {
        entries.push_back(
          { cellOf(boxes[i].center.y(), size), cellOf(boxes[i].center.x(), size), int(i) });
      }
    }
    if (entries.empty())
    {
      continue;
    }
    std::sort(entries.begin(), entries.end(), before);
    // Rocks of this level and of all below it look for those of this level.
    const auto search = [&](std::size_t i, std::vector<std::array<int, 2>>& found)
    {
      const BroadBox& a = boxes[i];
      if (!a.present || level[i] > k)
      {
        return;
      }
      const std::int64_t row = cellOf(a.center.y(), size), column = cellOf(a.center.x(), size);
      for (std::int64_t r = row - 1; r <= row + 1; ++r)
      {
        auto entry =
          std::lower_bound(entries.begin(), entries.end(), Entry{ r, column - 1, -1 }, before);
        for (; entry != entries.end() && entry->row == r && entry->column <= column + 1; ++entry)
        {
          const int j = entry->index;
          if (j == int(i) || (level[i] == k && j < int(i)))
          {
            continue;
          }
          const BroadBox& b = boxes[j];
          const double reach = a.radius + b.radius;
          if ((a.moves || b.moves) && (a.center - b.center).squaredNorm() <= reach * reach)
          {
            found.push_back({ std::min(int(i), j), std::max(int(i), j) });
          }
        }
      }
    };
    forEach(parts.size(), 1,
      [&](std::size_t part)
      {
        const std::size_t end = std::min(boxes.size(), (part + 1) * kPart);
        for (std::size_t i = part * kPart; i < end; ++i)
        {
          search(i, parts[part]);
        }
      });
  }
  std::vector<std::array<int, 2>> pairs;
  for (const std::vector<std::array<int, 2>>& found : parts)
  {
    pairs.insert(pairs.end(), found.begin(), found.end());
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace rockfall
