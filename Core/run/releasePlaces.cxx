#include "run/releasePlaces.h"

#include "base/abort.h"
#include "base/random.h"
#include "base/require.h"
#include "base/text/numberText.h"
#include "base/text/pointText.h"
#include "geometry/planeSampling.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

namespace rockfall
{

namespace
{

/// Memory of a rock until it is released, B: its polyhedron and its faces with their arrays.
constexpr double bytesPerRock = 8000.0;

/// A line or an area is drawn if there is no layer.
std::string rowName(const std::string& layer, const SourceRow& row)
{
  return layer.empty() ? "Points" : layer + ", row " + std::to_string(row.row);
}

/// A whole number of rocks with this mean.
double rounded(double mean, std::uint64_t seed, std::uint64_t draw)
{
  const double whole = std::floor(mean);
  return whole + (uniformDeviate(seed, 0, Draw::SourceNumber, draw) < mean - whole ? 1.0 : 0.0);
}

void refuseTooMany(double rocks, const ReleaseDefaults& defaults, const std::string& what)
{
  if (!(rocks <= double(defaults.mostRocks)))
  {
    throw ParameterError(what + numberText(rocks) + " rocks, more than MaximumRocks, which is " +
      std::to_string(defaults.mostRocks) + "; they would take some " +
      numberText(std::ceil(rocks * bytesPerRock / 1e9)) +
      " GB of memory before the first of them falls");
  }
}

/// Places of equal chance in a disc and in a ball of radius 1.
Vec3 inDisc(double u, double v)
{
  const double r = std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
  return { r * std::cos(angle), r * std::sin(angle), 0.0 };
}

Vec3 inBall(double u, double v, double w)
{
  const double r = std::cbrt(u), z = 2.0 * w - 1.0, angle = 2.0 * std::numbers::pi * v;
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return r * Vec3(across * std::cos(angle), across * std::sin(angle), z);
}

/// A source with all that is needed to draw places from it.
class Sampler
{
public:
  Sampler(const SourceRow& row, const ReleaseDefaults& defaults, const std::string& name)
    : row_(row)
    , clusterRadius_(defaults.clusterRadius)
  {
    double size = 0.0;
    if (row.geometry == SourceGeometry::Polygon)
    {
      polygon_.emplace(row.parts);
      size = polygon_->area();
    }
    else if (row.geometry == SourceGeometry::Line)
    {
      line_.emplace(row.parts);
      size = line_->length();
    }
    const bool point = row.geometry == SourceGeometry::Point;
    if (!point && !(size > 0.0))
    {
      throw DataError(name + (polygon_ ? ": the polygon has no area" : ": the line has no length"));
    }
    byIntensity_ = !point && !row.amount && (row.intensity || defaults.intensity > 0.0);
    rocks_ = byIntensity_ ? rounded(row.intensity.value_or(defaults.intensity) * size,
                              defaults.seed, std::uint64_t(row.row) << 32)
                          : double(row.amount.value_or(defaults.amount));
  }

  double rocks() const { return rocks_; }
  bool byIntensity() const { return byIntensity_; }
  /// Whether the source has one place only.
  bool isPlace() const { return row_.geometry == SourceGeometry::Point && clusterRadius_ == 0.0; }
  Vec3 at(std::uint64_t seed, std::uint32_t attempt, std::uint64_t draw, bool overGround) const
  {
    if (this->isPlace())
    {
      return row_.position;
    }
    // Attempts take every second number, so that a place has three of its own.
    const auto [u, v] = uniformDeviates(seed, 2 * attempt, Draw::SourcePlace, draw);
    if (row_.geometry == SourceGeometry::Point)
    {
      const double w = uniformDeviate(seed, 2 * attempt + 1, Draw::SourcePlace, draw);
      return row_.position + clusterRadius_ * (overGround ? inDisc(u, v) : inBall(u, v, w));
    }
    if (line_)
    {
      return line_->at(u);
    }
    const double w = uniformDeviate(seed, 2 * attempt + 1, Draw::SourcePlace, draw);
    const Eigen::Vector2d place = polygon_->at(u, v, w);
    return { place.x(), place.y(), row_.parts.front().front().z() };
  }

private:
  const SourceRow& row_;
  double clusterRadius_ = 0.0;
  std::optional<PolygonSampler> polygon_;
  std::optional<LineSampler> line_;
  bool byIntensity_ = false;
  double rocks_ = 0.0;
};

bool onTerrain(const Terrain& terrain, const Vec3& world)
{
  const Vec3 local = world - terrain.geometry().origin();
  return terrain.cfeAt(local.x(), local.y()) != 0;
}

bool isSteep(const Terrain& terrain, std::int64_t cfe, double leastCosine)
{
  return terrain.hasCfe(cfe) && terrain.cfe(cfe).normal.z() <= leastCosine;
}

std::int64_t steepCfes(const Terrain& terrain, double leastCosine)
{
  std::int64_t steep = 0;
  for (std::int64_t cfe = 1; cfe <= terrain.cfeCapacity(); ++cfe)
  {
    stayWanted();
    steep += isSteep(terrain, cfe, leastCosine);
  }
  return steep;
}

/// In plan, m².
double areaOf(const Terrain& terrain, std::int64_t cfes)
{
  const double cell = terrain.geometry().cellSize;
  return 0.5 * cell * cell * double(cfes);
}

Eigen::AlignedBox2d boundsOf(const Terrain& terrain)
{
  const Eigen::Vector2d corner = terrain.geometry().origin().head<2>();
  return { corner, corner + Eigen::Vector2d(terrain.width(), terrain.height()) };
}

Eigen::AlignedBox2d boundsOf(std::span<const SourceRow> sources)
{
  Eigen::AlignedBox2d all;
  for (const SourceRow& source : sources)
  {
    if (source.geometry == SourceGeometry::Point)
    {
      all.extend(source.position.head<2>());
    }
    for (const std::vector<Vec3>& part : source.parts)
    {
      for (const Vec3& p : part)
      {
        all.extend(p.head<2>());
      }
    }
  }
  return all;
}

} // namespace

void ReleaseDefaults::validate() const
{
  require(this->amount >= 1, "Amount", double(this->amount), "", "at least 1");
  const auto notNegative = [](double value, const char* field, const char* unit)
  { require(value >= 0.0 && std::isfinite(value), field, value, unit, "finite and at least 0"); };
  notNegative(this->intensity, "Intensity", " rocks per m or m²");
  notNegative(this->height, "ReleaseHeight", " m");
  notNegative(this->clusterRadius, "ClusterRadius", " m");
  require(this->mostRocks >= 1, "MaximumRocks", double(this->mostRocks), "", "at least 1");
}

std::string whyNoGround(const Terrain& terrain, double x, double y)
{
  const Eigen::AlignedBox2d slope = boundsOf(terrain);
  return slope.contains(Eigen::Vector2d(x, y))
    ? " lies on nodata of the slope: there is no CFE under it"
    : " is outside the slope: it spans " + boundsText(slope);
}

void requireOverlap(std::span<const SourceRow> sources, const Terrain& terrain,
  const std::string& layer, const std::string& layerCrs)
{
  const Eigen::AlignedBox2d own = boundsOf(sources), slope = boundsOf(terrain);
  if (own.intersects(slope))
  {
    return;
  }
  std::string why;
  if (layerCrs.empty())
  {
    why = ". The layer does not say in which CRS it is, so its coordinates were taken as they are";
  }
  else if (terrain.geometry().crs.empty())
  {
    why = ". The layer is in " + layerCrs +
      ", the terrain does not say in which CRS it is, so the coordinates were taken as they are";
  }
  throw DataError(layer + ": the sources do not overlap the terrain: they span " + boundsText(own) +
    ", the terrain spans " + boundsText(slope) + why);
}

std::vector<ReleasePlace> releasePlaces(std::span<const SourceRow> sources, const Terrain* terrain,
  const ReleaseDefaults& defaults, const std::string& layer)
{
  defaults.validate();
  if (layer.empty() && sources.front().geometry == SourceGeometry::Point &&
    defaults.intensity > 0.0)
  {
    throw ParameterError("Intensity is " + numberText(defaults.intensity) +
      " rocks per m or m²: the place in Center has neither length nor area, Amount says how many "
      "rocks it has");
  }
  std::vector<Sampler> samplers;
  double rocks = 0.0, most = -1.0;
  std::size_t largest = 0;
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    samplers.emplace_back(sources[k], defaults, rowName(layer, sources[k]));
    rocks += samplers.back().rocks();
    if (samplers.back().rocks() > most)
    {
      most = samplers.back().rocks();
      largest = k;
    }
  }
  refuseTooMany(rocks, defaults,
    layer.empty() ? "Amount makes "
                  : layer + ": the sources make (row " + std::to_string(sources[largest].row) +
        " alone " + numberText(most) + ") ");

  std::vector<ReleasePlace> places;
  places.reserve(std::size_t(rocks));
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    const SourceRow& source = sources[k];
    const bool point = samplers[k].isPlace();
    for (std::uint64_t i = 0; i < std::uint64_t(samplers[k].rocks()); ++i)
    {
      stayWanted();
      ReleasePlace place;
      place.source = k;
      place.draw = (std::uint64_t(source.row) << 32) + i;
      std::uint32_t attempt = 0;
      place.overGround = terrain &&
        (source.height || defaults.onGround ||
          std::isnan(samplers[k].at(defaults.seed, attempt, place.draw, false).z()));
      place.position = samplers[k].at(defaults.seed, attempt, place.draw, place.overGround);
      place.height = source.height.value_or(defaults.height);
      // A point that is given with its z is left to the simulation, which says what is wrong.
      bool placed = !terrain || (point && !place.overGround) || onTerrain(*terrain, place.position);
      while (!placed && !point && !samplers[k].byIntensity() && ++attempt < kMostDrawsOfSource)
      {
        place.position = samplers[k].at(defaults.seed, attempt, place.draw, place.overGround);
        placed = onTerrain(*terrain, place.position);
      }
      if (!placed && samplers[k].byIntensity())
      {
        continue; // its part of the area is not on the terrain
      }
      if (!placed)
      {
        const std::string name = layer.empty() ? "Center" : rowName(layer, source);
        throw DataError(point ? name + ": the point " + numberText(source.position.x()) + ", " +
              numberText(source.position.y()) +
              whyNoGround(*terrain, source.position.x(), source.position.y())
                              : name + ": none of " + std::to_string(kMostDrawsOfSource) +
              " places is on the terrain: the source spans " +
              boundsText(boundsOf({ &source, 1 })) + ", the terrain " +
              boundsText(boundsOf(*terrain)));
      }
      places.push_back(place);
    }
  }
  if (places.empty())
  {
    throw DataError(layer +
      ": there is no rock: every amount is 0, or intensity times size makes none on the terrain");
  }
  return places;
}

struct PlaceRedrawer::Samplers
{
  std::vector<Sampler> samplers;
  const Terrain* terrain = nullptr;
  std::uint64_t seed = 0;
};

PlaceRedrawer::PlaceRedrawer(std::span<const SourceRow> sources, const Terrain* terrain,
  const ReleaseDefaults& defaults, const std::string& layer)
  : samplers_(std::make_unique<Samplers>())
{
  for (const SourceRow& source : sources)
  {
    samplers_->samplers.emplace_back(source, defaults, rowName(layer, source));
  }
  samplers_->terrain = terrain;
  samplers_->seed = defaults.seed;
}

PlaceRedrawer::~PlaceRedrawer() = default;

bool PlaceRedrawer::hasOthers(const ReleasePlace& place) const
{
  return !samplers_->samplers[place.source].isPlace();
}

bool PlaceRedrawer::redraw(ReleasePlace& place, std::uint32_t attempt) const
{
  place.position = samplers_->samplers[place.source].at(
    samplers_->seed, kMostDrawsOfSource + attempt, place.draw, place.overGround);
  return !samplers_->terrain || onTerrain(*samplers_->terrain, place.position);
}

double steepArea(const Terrain& terrain, double threshold)
{
  return areaOf(terrain, steepCfes(terrain, std::cos(threshold)));
}

std::vector<ReleasePlace> steepPlaces(
  const Terrain& terrain, double threshold, const ReleaseDefaults& defaults)
{
  defaults.validate();
  const double cosine = std::cos(threshold);
  const std::int64_t steep = steepCfes(terrain, cosine);
  if (steep == 0)
  {
    throw DataError("SlopeThreshold is " + numberText(degrees(threshold)) +
      " degrees, and no CFE of the terrain is as steep");
  }
  const double area = areaOf(terrain, steep);
  const double rocks = defaults.intensity > 0.0
    ? rounded(defaults.intensity * area, defaults.seed, 0)
    : double(defaults.amount);
  refuseTooMany(rocks, defaults,
    "SlopeThreshold takes " + numberText(area) + " m² of the terrain, on which are to be ");
  if (rocks == 0.0)
  {
    throw DataError("Intensity " + numberText(defaults.intensity) + " makes no rock on the " +
      numberText(area) + " m² that SlopeThreshold takes");
  }

  // A further pass gives every rock its CFE, without a list of them all.
  std::vector<ReleasePlace> places((std::size_t(rocks)));
  std::vector<std::pair<std::int64_t, std::size_t>> wanted;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    places[i].draw = i;
    const double u = uniformDeviate(defaults.seed, 0, Draw::SourcePlace, i);
    wanted.emplace_back(std::min(steep - 1, std::int64_t(u * double(steep))), i);
  }
  std::sort(wanted.begin(), wanted.end());
  auto next = wanted.begin();
  std::int64_t ordinal = 0;
  for (std::int64_t cfe = 1; cfe <= terrain.cfeCapacity() && next != wanted.end(); ++cfe)
  {
    stayWanted();
    if (!isSteep(terrain, cfe, cosine))
    {
      continue;
    }
    for (; next != wanted.end() && next->first == ordinal; ++next)
    {
      ReleasePlace& place = places[next->second];
      auto [s, t] = uniformDeviates(defaults.seed, 1, Draw::SourcePlace, place.draw);
      if (s + t > 1.0)
      {
        s = 1.0 - s;
        t = 1.0 - t;
      }
      const auto nodes = terrain.cfe(cfe).nodes;
      place.position = nodes[0] + s * (nodes[1] - nodes[0]) + t * (nodes[2] - nodes[0]) +
        terrain.geometry().origin();
      place.overGround = true;
      place.height = defaults.height;
    }
    ++ordinal;
  }
  return places;
}

} // namespace rockfall
