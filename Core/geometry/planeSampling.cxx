#include "geometry/planeSampling.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace rockfall
{

namespace
{

/// Sides that are in the wrong order by no more have not crossed, m: places of corners are rounded.
constexpr double kRounding = 1e-6;

/// The piece that a share of all belongs to, and the place in it, 0 to 1.
std::pair<std::size_t, double> pick(const std::vector<double>& cumulated, double share)
{
  const double wanted = share * cumulated.back();
  auto found = std::upper_bound(cumulated.begin(), cumulated.end(), wanted);
  found = found == cumulated.end() ? found - 1 : found;
  const auto piece = std::size_t(found - cumulated.begin());
  const double before = piece > 0 ? cumulated[piece - 1] : 0.0;
  const double size = cumulated[piece] - before;
  return { piece, size > 0.0 ? std::clamp((wanted - before) / size, 0.0, 1.0) : 0.0 };
}

} // namespace

struct PolygonSampler::Side
{
  double x0, y0, x1, y1; ///< y0 < y1
  double at(double y) const { return x0 + (y - y0) / (y1 - y0) * (x1 - x0); }
};

PolygonSampler::PolygonSampler(const std::vector<std::vector<Vec3>>& rings)
{
  std::vector<Side> sides;
  std::vector<double> heights;
  for (const std::vector<Vec3>& ring : rings)
  {
    for (std::size_t k = 0; k < ring.size(); ++k)
    {
      const Vec3& a = ring[k];
      const Vec3& b = ring[(k + 1) % ring.size()];
      heights.push_back(a.y());
      if (a.y() != b.y())
      {
        const bool up = a.y() < b.y();
        const Vec3& low = up ? a : b;
        const Vec3& high = up ? b : a;
        sides.push_back({ low.x(), low.y(), high.x(), high.y() });
      }
    }
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    { return std::tie(a.y0, a.x0, a.y1, a.x1) < std::tie(b.y0, b.x0, b.y1, b.x1); });

  std::vector<const Side*> across; // sides that the slab at hand meets
  auto next = sides.begin();
  for (std::size_t k = 0; k + 1 < heights.size(); ++k)
  {
    const double y0 = heights[k], y1 = heights[k + 1];
    std::erase_if(across, [&](const Side* side) { return side->y1 <= y0; });
    for (; next != sides.end() && next->y0 <= y0; ++next)
    {
      across.push_back(&*next);
    }
    this->addSlab(across, y0, y1);
  }
}

void PolygonSampler::addSlab(std::vector<const Side*>& across, double y0, double y1)
{
  // Sides that cross have another order at one border than in the middle. Each pass takes the slab
  // up to its lowest such crossing, found so far, and goes on above it.
  std::vector<double> tops{ y1 };
  for (double low = y0; !tops.empty();)
  {
    const double high = tops.back(), middle = 0.5 * (low + high);
    std::sort(across.begin(), across.end(),
      [&](const Side* a, const Side* b) { return a->at(middle) < b->at(middle); });
    double cut = high;
    for (std::size_t i = 0; i + 1 < across.size(); ++i)
    {
      const double below = across[i]->at(low) - across[i + 1]->at(low);
      const double above = across[i]->at(high) - across[i + 1]->at(high);
      const double crossing = low + below / (below - above) * (high - low);
      if (std::max(below, above) > kRounding && crossing > low && crossing < cut)
      {
        cut = crossing;
      }
    }
    if (cut < high)
    {
      tops.push_back(cut);
      continue;
    }
    for (std::size_t i = 0; i + 1 < across.size(); i += 2)
    {
      const Side &left = *across[i], &right = *across[i + 1];
      const Trapezoid t{ low, high, left.at(low), right.at(low), left.at(high), right.at(high) };
      trapezoids_.push_back(t);
      cumulated_.push_back(this->area() +
        0.5 * (high - low) *
          (std::max(0.0, t.right0 - t.left0) + std::max(0.0, t.right1 - t.left1)));
    }
    low = high;
    tops.pop_back();
  }
}

std::vector<std::array<Eigen::Vector2d, 4>> PolygonSampler::pieces() const
{
  std::vector<std::array<Eigen::Vector2d, 4>> all;
  for (const Trapezoid& t : trapezoids_)
  {
    all.push_back({ { { t.left0, t.y0 }, { std::max(t.left0, t.right0), t.y0 },
      { std::max(t.left1, t.right1), t.y1 }, { t.left1, t.y1 } } });
  }
  return all;
}

Eigen::Vector2d PolygonSampler::at(double u, double v, double w) const
{
  const Trapezoid& t = trapezoids_[pick(cumulated_, u).first];
  // The share of the area below the height s is (a s + (b − a) s²/2) / ((a + b)/2), a and b being
  // the widths below and above.
  const double a = std::max(0.0, t.right0 - t.left0), b = std::max(0.0, t.right1 - t.left1);
  const double root = std::sqrt(a * a + v * (b * b - a * a));
  const double s = a + root > 0.0 ? v * (a + b) / (a + root) : v;
  const double left = t.left0 + s * (t.left1 - t.left0);
  const double right = t.right0 + s * (t.right1 - t.right0);
  return { left + w * (right - left), t.y0 + s * (t.y1 - t.y0) };
}

LineSampler::LineSampler(const std::vector<std::vector<Vec3>>& lines)
{
  double length = 0.0;
  for (const std::vector<Vec3>& line : lines)
  {
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
    {
      segments_.push_back({ line[k], line[k + 1] });
      length += (line[k + 1] - line[k]).head<2>().norm();
      cumulated_.push_back(length);
    }
  }
}

Vec3 LineSampler::at(double u) const
{
  const auto [piece, s] = pick(cumulated_, u);
  const auto& [a, b] = segments_[piece];
  return a + s * (b - a);
}

} // namespace rockfall
