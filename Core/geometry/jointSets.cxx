#include "geometry/jointSets.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/random.h"
#include "base/require.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Sets that differ by less cut each other into wedges too thin to be blocks.
constexpr double leastAngle = radians(1.0);

/// Joints are counted from the one at the offset on.
constexpr double mostSpacings = 1e6;
/// Of spacings to their mean.
constexpr double mostDeviation = 10.0;

/// Memory of a block until it is released, B: its polyhedron and its faces with their arrays.
constexpr double bytesPerBlock = 8000.0;

std::string setName(std::size_t number)
{
  return "joint set " + std::to_string(number + 1);
}

std::string describe(const JointSet& set, std::size_t number)
{
  return setName(number) + " (dip " + numberText(std::round(degrees(set.dip) * 1e6) / 1e6) +
    "°, dip direction " + numberText(std::round(degrees(set.dipDirection) * 1e6) / 1e6) +
    "°, spacing " + numberText(set.spacing) + " m)";
}

/// Least and greatest height of the vertices along a direction.
std::array<double, 2> span(const Polyhedron& body, const Vec3& direction)
{
  std::array<double, 2> range{ INFINITY, -INFINITY };
  for (const Vec3& v : body.vertices())
  {
    range[0] = std::min(range[0], direction.dot(v));
    range[1] = std::max(range[1], direction.dot(v));
  }
  return range;
}

/// Area of the body's shadow along a unit direction, by Cauchy's formula.
double shadow(const Polyhedron& body, const Vec3& direction)
{
  double area = 0.0;
  for (std::size_t f = 0; f < body.faces().size(); ++f)
  {
    area +=
      facePlane(body.vertices(), body.faces()[f]).area * std::abs(body.normals()[f].dot(direction));
  }
  return 0.5 * area;
}

/// Two unit vectors across a normal.
std::array<Vec3, 2> across(const Vec3& normal)
{
  const Vec3 first = normal.unitOrthogonal();
  return { first, normal.cross(first) };
}

void checkSets(const Polyhedron& mass, std::span<const JointSet> sets, const MassCut& how)
{
  if (sets.empty())
  {
    throw ParameterError("JointSets is empty: a rock mass is cut by at least one joint set");
  }
  for (std::size_t i = 0; i < sets.size(); ++i)
  {
    sets[i].validate(setName(i));
    if (sets[i].spacing < how.leastThickness && how.slivers == SliverRule::Refuse)
    {
      throw ParameterError(describe(sets[i], i) + " cuts into slivers: MinimumThickness is " +
        numberText(how.leastThickness) + " m");
    }
    for (std::size_t j = 0; j < i; ++j)
    {
      const Vec3 n = sets[i].normal(), m = sets[j].normal();
      const double angle = std::atan2(n.cross(m).norm(), std::abs(n.dot(m)));
      if (angle < leastAngle)
      {
        throw ParameterError(describe(sets[j], j) + " and " + describe(sets[i], i) +
          " are parallel within 1°: make one set of them");
      }
    }
  }
  const double expected = expectedBlocks(mass, sets);
  if (!(expected <= double(how.mostBlocks)))
  {
    throw ParameterError("The joint sets would cut the rock mass of " +
      numberText(mass.integrals().volume) + " m³ into some " + numberText(std::round(expected)) +
      " blocks of " + numberText(mass.integrals().volume / expected) +
      " m³ on average, more than MaximumRocks, which is " + std::to_string(how.mostBlocks) +
      "; they would take some " + numberText(std::ceil(expected * bytesPerBlock / 1e8) / 10.0) +
      " GB of memory before the first of them falls");
  }
}

/// Blocks that these joints make; a mean over all offsets does not tell.
[[noreturn]] void failCount(
  const Polyhedron& mass, const std::string& set, double expected, const MassCut& how)
{
  throw ParameterError(set + " cuts the rock mass of " + numberText(mass.integrals().volume) +
    " m³ into more blocks than MaximumRocks, which is " + std::to_string(how.mostBlocks) +
    "; such joints make some " + numberText(std::round(expected)) + " on average");
}

/// By how much volumes of the parts may differ from that of the whole, m³: where the points of a
/// face are off its plane, as single precision leaves them, it depends on how a face is divided.
double looseVolume(const Polyhedron& mass)
{
  double loose = 0.0;
  for (const std::vector<int>& face : mass.faces())
  {
    const FacePlane plane = facePlane(mass.vertices(), face);
    loose += 2.0 * plane.area * plane.deviation;
  }
  return loose;
}

} // namespace

Vec3 JointSet::normal() const
{
  return { std::sin(this->dip) * std::sin(this->dipDirection),
    std::sin(this->dip) * std::cos(this->dipDirection), std::cos(this->dip) };
}

void JointSet::validate(const std::string& name) const
{
  const std::string of = name + ": ";
  // The way from degrees and back may leave the last digit of 90°.
  const double right = degrees(this->dip);
  require(right >= 0.0 && right <= 90.0 + 1e-9, of + "dip", right, " degrees", "0 to 90");
  const double direction = degrees(this->dipDirection);
  require(std::abs(direction) <= 360.0 + 1e-9, of + "dip direction", direction, " degrees",
    "-360 to 360");
  require(this->spacing > 0.0 && std::isfinite(this->spacing), of + "spacing", this->spacing, " m",
    "positive and finite");
  require(std::abs(this->offset) <= mostSpacings * this->spacing, of + "offset", this->offset, " m",
    "within a million spacings");
  require(this->spacingDeviation >= 0.0 && this->spacingDeviation <= mostDeviation * this->spacing,
    of + "spacing deviation", this->spacingDeviation, " m", "0 to ten times the spacing");
  const double tilt = degrees(this->orientationDeviation);
  require(tilt >= 0.0 && tilt <= 45.0, of + "orientation deviation", tilt, " degrees", "0 to 45");
}

void MassCut::validate() const
{
  if (this->slivers < SliverRule::Refuse || this->slivers > SliverRule::Keep)
  {
    throw ParameterError("Slivers is " + std::to_string(int(this->slivers)) +
      ", it must be 0 (refuse), 1 (drop) or 2 (keep)");
  }
  const auto notNegative = [](double value, const char* field, const char* unit)
  { require(value >= 0.0 && std::isfinite(value), field, value, unit, "finite and at least 0"); };
  notNegative(this->leastThickness, "MinimumThickness", " m");
  notNegative(this->leastVolume, "MinimumVolume", " m³");
  require(this->mostBlocks >= 1, "MaximumRocks", double(this->mostBlocks), "", "at least 1");
}

double expectedBlocks(const Polyhedron& mass, std::span<const JointSet> sets)
{
  const double volume = mass.integrals().volume;
  double blocks = 1.0;
  for (std::size_t i = 0; i < sets.size(); ++i)
  {
    const Vec3 n = sets[i].normal();
    const auto [low, high] = span(mass, n);
    blocks += (high - low) / sets[i].spacing;
    for (std::size_t j = 0; j < i; ++j)
    {
      const Vec3 line = n.cross(sets[j].normal());
      const double sine = line.norm();
      if (sine == 0.0)
      {
        continue;
      }
      blocks += shadow(mass, line / sine) * sine / (sets[i].spacing * sets[j].spacing);
      for (std::size_t k = 0; k < j; ++k)
      {
        blocks += volume * std::abs(line.dot(sets[k].normal())) /
          (sets[i].spacing * sets[j].spacing * sets[k].spacing);
      }
    }
  }
  return blocks;
}

std::vector<CuttingPlane> jointPlanes(
  const Polyhedron& mass, const JointSet& set, std::size_t number, std::uint64_t seed)
{
  const Vec3 normal = set.normal(), centre = mass.integrals().centroid;
  const std::array<double, 2> ends = span(mass, normal);
  double low = ends[0] - normal.dot(centre), high = ends[1] - normal.dot(centre);
  if (set.orientationDeviation > 0.0)
  {
    // A tilted joint enters the mass from beside it.
    low = -mass.radius();
    high = mass.radius();
  }
  std::vector<CuttingPlane> planes;
  const auto add = [&](double place, std::uint64_t draw)
  {
    if (place < low || place > high)
    {
      return;
    }
    CuttingPlane plane{ normal, 0.0 };
    if (set.orientationDeviation > 0.0)
    {
      const auto [s, t] = normalDeviates(seed, std::uint32_t(number), Draw::JointTilt, draw);
      const auto [a, b] = across(normal);
      const Vec3 turn = set.orientationDeviation * (s * a + t * b);
      const double angle = turn.norm();
      plane.normal =
        angle > 0.0 ? (Eigen::AngleAxisd(angle, turn / angle) * normal).normalized() : normal;
    }
    plane.offset = plane.normal.dot(centre + place * normal);
    planes.push_back(plane);
  };
  if (set.spacingDeviation == 0.0)
  {
    const double first = std::ceil((low - set.offset) / set.spacing);
    for (double k = first; set.offset + k * set.spacing <= high; k += 1.0)
    {
      add(set.offset + k * set.spacing, std::uint64_t(std::int64_t(k)));
    }
    return planes;
  }
  // Log-normal with this mean and deviation; from the one at `offset` up, then down.
  const double ratio = set.spacingDeviation / set.spacing;
  const double sigma = std::sqrt(std::log1p(ratio * ratio));
  const double mu = std::log(set.spacing) - 0.5 * sigma * sigma;
  const auto spacing = [&](std::int64_t k)
  {
    return std::exp(mu +
      sigma * normalDeviate(seed, std::uint32_t(number), Draw::JointSpacing, std::uint64_t(k)));
  };
  double place = set.offset;
  for (std::int64_t k = 0; place <= high; ++k)
  {
    add(place, std::uint64_t(k));
    place += spacing(k);
  }
  place = set.offset;
  for (std::int64_t k = -1; place >= low; --k)
  {
    place -= spacing(k);
    add(place, std::uint64_t(k));
  }
  std::sort(planes.begin(), planes.end(),
    [](const CuttingPlane& a, const CuttingPlane& b) { return a.offset < b.offset; });
  return planes;
}

CutMass cutMass(
  const Polyhedron& mass, std::span<const JointSet> sets, const MassCut& how, const Vec3& origin)
{
  how.validate();
  checkSets(mass, sets, how);
  const double tolerance = cutTolerance * 2.0 * mass.radius();
  std::vector<ConvexPiece> pieces(1);
  pieces.front().points = mass.vertices();
  pieces.front().faces = mass.faces();
  std::int64_t made = 1;
  for (std::size_t i = 0; i < sets.size(); ++i)
  {
    const std::vector<CuttingPlane> planes = jointPlanes(mass, sets[i], i, how.seed);
    std::vector<ConvexPiece> finer;
    bool cuts = false;
    for (ConvexPiece& piece : pieces)
    {
      std::vector<ConvexPiece> parts;
      parts.push_back(std::move(piece));
      for (const CuttingPlane& plane : planes)
      {
        stayWanted();
        // Joints of one set that are parallel meet the last part only.
        const std::size_t count = parts.size();
        for (std::size_t k = sets[i].orientationDeviation > 0.0 ? 0 : count - 1; k < count; ++k)
        {
          ConvexPiece below, above;
          if (cutPiece(parts[k], plane, tolerance, below, above))
          {
            parts[k] = std::move(below);
            parts.push_back(std::move(above));
            cuts = true;
            if (++made > how.mostBlocks)
            {
              failCount(mass, describe(sets[i], i), expectedBlocks(mass, sets), how);
            }
          }
        }
      }
      std::move(parts.begin(), parts.end(), std::back_inserter(finer));
    }
    if (!cuts)
    {
      const auto [low, high] = span(mass, sets[i].normal());
      throw ParameterError(describe(sets[i], i) + " cuts nothing: the rock mass is " +
        numberText(high - low) + " m wide across it. Take a smaller spacing or another offset");
    }
    pieces = std::move(finer);
  }

  CutMass result;
  result.blocks.reserve(pieces.size());
  std::string smallest;
  double least = INFINITY, total = 0.0;
  for (const ConvexPiece& piece : pieces)
  {
    stayWanted();
    const VolumeIntegrals integrals = integrateSimplices(piece.points, piece.faces);
    const double thickness = thicknessOf(piece);
    const auto name = [&]
    {
      const Vec3 at = integrals.centroid + origin;
      return "at (" + numberText(at.x()) + ", " + numberText(at.y()) + ", " + numberText(at.z()) +
        "), is " + numberText(thickness) + " m thick and has " + numberText(integrals.volume) +
        " m³";
    };
    total += integrals.volume;
    const bool sliver = thickness < how.leastThickness || integrals.volume < how.leastVolume;
    if (sliver)
    {
      ++result.slivers;
      result.sliverVolume += integrals.volume;
      if (integrals.volume < least)
      {
        least = integrals.volume;
        smallest = name();
      }
      if (how.slivers != SliverRule::Keep)
      {
        continue;
      }
    }
    try
    {
      result.blocks.push_back(Polyhedron::fromFaces(piece.points, piece.faces, "the cut block"));
    }
    catch (const GeometryError& error)
    {
      throw GeometryError("A cut block, " + name() + ", is too thin to be a block: " +
        error.what() + ". Drop slivers, with a MinimumThickness above that");
    }
  }
  if (result.slivers > 0 && how.slivers == SliverRule::Refuse)
  {
    throw GeometryError("The joint sets cut the rock mass into slivers: " +
      std::to_string(result.slivers) + " of the " + std::to_string(pieces.size()) +
      " blocks are thinner than MinimumThickness, " + numberText(how.leastThickness) +
      " m, or smaller than MinimumVolume, " + numberText(how.leastVolume) + " m³. The smallest, " +
      smallest + "; all of them have " + numberText(result.sliverVolume) +
      " m³. Take other spacings or offsets, or let Slivers say to drop or to keep them");
  }
  if (result.blocks.empty())
  {
    throw GeometryError("The joint sets leave nothing of the rock mass: all " +
      std::to_string(pieces.size()) + " blocks are slivers, and dropped");
  }
  const double volume = mass.integrals().volume;
  if (std::abs(total - volume) > 1e-10 * volume + looseVolume(mass))
  {
    throw GeometryError("The blocks that the joint sets cut have " + numberText(total) +
      " m³, but the rock mass has " + numberText(volume) + " m³");
  }
  return result;
}

} // namespace rockfall
