#include "terrain/BoxIndex.h"

namespace rockfall
{

namespace
{

/// Boxes spread evenly fill 0.63 of as many cells; below this part of them the extent is sparse.
constexpr double kSparse = 0.3;
/// Cells that the box of a tree or an embankment lies in at most.
constexpr double kMostCellsOfBox = 16.0;

} // namespace

BoxIndex::BoxIndex(std::span<const FlatBox> boxes)
{
  if (boxes.empty())
  {
    return;
  }
  west_ = south_ = std::numeric_limits<double>::infinity();
  east_ = north_ = -west_;
  for (const FlatBox& b : boxes)
  {
    west_ = std::min(west_, b.xMin);
    east_ = std::max(east_, b.xMax);
    south_ = std::min(south_, b.yMin);
    north_ = std::max(north_, b.yMax);
  }
  // About as many cells as boxes. Where most of the extent is empty (woods far apart, one tree by
  // itself) as many in what is occupied, but neither more than kMostCellsOfBox for a box nor
  // smaller than the boxes are.
  const double width = east_ - west_, height = north_ - south_;
  double size = std::max({ std::sqrt(width * height / double(boxes.size())),
    std::max(width, height) / double(boxes.size() + 1), 1e-3 });
  const double filled = this->filledPart(boxes, size);
  if (filled < kSparse)
  {
    double extent = 0.0;
    for (const FlatBox& b : boxes)
    {
      extent += std::max(b.xMax - b.xMin, b.yMax - b.yMin) / double(boxes.size());
    }
    size =
      std::min(size, std::max(size * std::sqrt(std::max(filled, 1.0 / kMostCellsOfBox)), extent));
  }
  inverse_ = 1.0 / size;
  columns_ = int(width * inverse_) + 1;
  rows_ = int(height * inverse_) + 1;
  begins_.assign(std::size_t(columns_) * rows_ + 1, 0);
  tops_.assign(std::size_t(columns_) * rows_, -std::numeric_limits<double>::infinity());
  first_.resize(boxes.size());
  const auto each = [&](auto&& use)
  {
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      const FlatBox& b = boxes[i];
      int c0 = 0, c1 = -1, r0 = 0, r1 = -1;
      this->cells(b.xMin, b.xMax, b.yMin, b.yMax, c0, c1, r0, r1);
      first_[i] = { c0, r0 };
      for (int r = r0; r <= r1; ++r)
      {
        for (int c = c0; c <= c1; ++c)
        {
          use(i, std::size_t(r) * columns_ + c);
        }
      }
    }
  };
  each(
    [&](std::size_t i, std::size_t cell)
    {
      ++begins_[cell + 1];
      tops_[cell] = std::max(tops_[cell], boxes[i].top);
    });
  for (std::size_t k = 1; k < begins_.size(); ++k)
  {
    begins_[k] += begins_[k - 1];
  }
  items_.resize(begins_.back());
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  each([&](std::size_t i, std::size_t cell) { items_[next[cell]++] = std::uint32_t(i); });
}

double BoxIndex::filledPart(std::span<const FlatBox> boxes, double size) const
{
  const std::size_t columns = std::size_t((east_ - west_) / size) + 1;
  const std::size_t rows = std::size_t((north_ - south_) / size) + 1;
  std::vector<bool> filled(columns * rows, false);
  std::size_t count = 0;
  for (const FlatBox& b : boxes)
  {
    const std::size_t c = std::size_t((0.5 * (b.xMin + b.xMax) - west_) / size);
    const std::size_t r = std::size_t((0.5 * (b.yMin + b.yMax) - south_) / size);
    const auto cell = filled.begin() + std::ptrdiff_t(r * columns + c);
    count += *cell ? 0 : 1;
    *cell = true;
  }
  return double(count) / double(filled.size());
}

double BoxIndex::top(double xMin, double xMax, double yMin, double yMax) const
{
  double highest = -std::numeric_limits<double>::infinity();
  int c0 = 0, c1 = -1, r0 = 0, r1 = -1;
  if (this->cells(xMin, xMax, yMin, yMax, c0, c1, r0, r1))
  {
    for (int r = r0; r <= r1; ++r)
    {
      for (int c = c0; c <= c1; ++c)
      {
        highest = std::max(highest, tops_[std::size_t(r) * columns_ + c]);
      }
    }
  }
  return highest;
}

} // namespace rockfall
