#include "rock/parts/Scar.h"

#include "law/settings.h"

#include <algorithm>
#include <vector>

namespace rockfall
{

namespace
{

/// Pieces that a long motion is followed in at most, and one.
constexpr std::size_t kMostBreaks = 13;

} // namespace

void Scar::sink(double depth, int ground, const Contact& contact)
{
  if (!this->open())
  {
    *this = Scar();
    lowest_ = std::max(0.0, contact.distance);
  }
  surface_.normal = contact.normal;
  surface_.offset =
    contact.normal.dot(contact.point - contact.distance * contact.normal + depth_ * Vec3::UnitZ());
  depth_ = depth;
  deepest_ = std::max(deepest_, depth);
  ground_ = ground;
  turned_ = false;
}

void Scar::rise(double by)
{
  depth_ = std::max(0.0, depth_ - by);
}

void Scar::touch(const Contact& contact)
{
  turned_ = true;
  if (contact.kind == ContactKind::VertexFace)
  {
    surface_.normal = contact.normal;
  }
  const Vec3 place = contact.point - contact.distance * contact.normal + depth_ * Vec3::UnitZ();
  surface_.offset = surface_.normal.dot(place);
}

double Scar::book(double volume, const Vec3& way, const Submerged& end)
{
  area_ = end.area;
  lowest_ = end.lowest;
  if (volume > 0.0)
  {
    length_ += (way - way.dot(surface_.normal) * surface_.normal).norm();
  }
  return volume;
}

double Scar::sweep(const Vec3& from, const PlacedBlock& rock)
{
  const Vec3 way = rock.position() - from;
  const double s = way.norm();
  if (!(s > kNoWay))
  {
    return 0.0;
  }
  const double start = area_;
  const Submerged end = submerged(rock, surface_, way / s);
  return this->book(0.5 * (start + end.area) * s, way, end);
}

double Scar::sweep(const Vec3& way, const Poses& at, bool turns)
{
  if (!(way.norm() > kNoWay))
  {
    return 0.0;
  }
  return turns ? this->sweepTurning(way, at(1.0)) : this->sweepStraight(way, at);
}

double Scar::sweepTurning(const Vec3& way, const PlacedBlock& rock)
{
  const double before = lowest_, areaBefore = area_;
  const double s = way.norm();
  const Submerged end = submerged(rock, surface_, way / s);
  if (before >= 0.0 && end.lowest >= 0.0)
  {
    return this->book(0.0, way, end);
  }
  // From where the lowest corner is level the area grows as the square of the way.
  const double passed = before / (before - end.lowest);
  const double volume = before >= 0.0 ? (1.0 - passed) * end.area / 3.0
    : end.lowest >= 0.0               ? passed * areaBefore / 3.0
                                      : 0.5 * (areaBefore + end.area);
  return this->book(s * volume, way, end);
}

double Scar::sweepStraight(const Vec3& way, const Poses& at)
{
  const double s = way.norm();
  const Vec3 direction = way / s;
  // Heights of the corners over the surface at both ends tell where they pass it.
  const auto heightsOf = [&](const PlacedBlock& rock)
  {
    std::vector<double> heights;
    for (const Vec3& v : rock.vertices())
    {
      heights.push_back(surface_.normal.dot(v) - surface_.offset);
    }
    return heights;
  };
  const std::vector<double> before = heightsOf(at(0.0)), after = heightsOf(at(1.0));
  std::vector<double> breaks = { 0.0, 1.0 };
  for (std::size_t v = 0; v < before.size(); ++v)
  {
    if ((before[v] < 0.0) != (after[v] < 0.0))
    {
      breaks.push_back(before[v] / (before[v] - after[v]));
    }
  }
  std::sort(breaks.begin(), breaks.end());
  if (breaks.size() > kMostBreaks)
  {
    breaks.resize(kMostBreaks); // a sphere: so many corners that none of them matters
    for (std::size_t k = 0; k < kMostBreaks; ++k)
    {
      breaks[k] = double(k) / double(kMostBreaks - 1);
    }
  }
  double volume = 0.0;
  for (std::size_t k = 1; k < breaks.size(); ++k)
  {
    const double length = breaks[k] - breaks[k - 1];
    if (length < kSameBreak && k + 1 < breaks.size())
    {
      continue;
    }
    // Simpson: exact for what is quadratic. Just inside of a break, where a face may dive in at
    // once.
    const double inside = kSameBreak * length;
    const auto areaAt = [&](double fraction)
    { return submerged(at(fraction), surface_, direction).area; };
    const double low = areaAt(breaks[k - 1] + inside);
    const double middle = areaAt(0.5 * (breaks[k - 1] + breaks[k]));
    volume += s * length * (low + 4.0 * middle + areaAt(breaks[k] - inside)) / 6.0;
  }
  return this->book(volume, way, submerged(at(1.0), surface_, direction));
}

} // namespace rockfall
