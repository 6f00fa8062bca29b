#include "terrain/plausible.h"

#include "base/Tally.h"
#include "base/hectare.h"
#include "base/text/numberText.h"
#include "geometry/twins.h"
#include "terrain/Terrain.h"
#include "terrain/doubt.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace rockfall
{

namespace
{

using Point = Eigen::Vector2d;

std::string text(double value)
{
  return numberText(value, 6);
}

/// Doubts on stems and on the means of stands.
Doubt thicknesses(const std::string& of)
{
  return { of,
    "Stems have " + between(plausible::kStemDiameter, 0.01) + " cm: are diameters in cm?" };
}
Doubt slendernesses(const std::string& of)
{
  return { of,
    "Trees are " + between(plausible::kSlenderness) +
      " times as high as thick: are diameters in cm and heights in m?" };
}

std::string highAndThick(double height, double diameter)
{
  return ": " + text(height) + " m high and " + text(100.0 * diameter) + " cm thick";
}

void lookAtTrees(const std::vector<Tree>& trees, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt thick = thicknesses("diameters of trees"), slender = slendernesses("trees");
  Doubt wrong("lengths of lying stems",
    "Lying stems are " + between(kLyingLength) + " m long: is the line one stem?");
  Doubt strong("capacities of trees",
    "Stems hold " + between(kStemCapacity) +
      " times what Dorren and Berger give their diameter: are capacities in kJ?");
  for (const Tree& t : trees)
  {
    const std::string name = featureText(t.feature);
    const bool fits = kStemDiameter.has(t.diameter);
    thick.look(fits, name, t.diameter, " cm", 0.01);
    if (t.lies())
    {
      wrong.look(kLyingLength, name, (t.end - t.position).norm(), " m");
    }
    else
    {
      // A stem that is too thick is told once.
      slender.look(!fits || kSlenderness.has(t.height / t.diameter), name,
        [&] { return highAndThick(t.height, t.diameter); });
    }
    const double share = t.capacity / stemCapacity(t.diameter);
    strong.look(
      !fits || std::isinf(share) || kStemCapacity.has(share), name, t.capacity, " kJ", 1000.0);
  }
  tellAll(notes, thick, slender, wrong, strong);
}

void lookAtNets(const std::vector<Barrier>& barriers, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt high("heights of barriers", "Nets stand " + between(kNetHeight) + " m high: is it in m?");
  Doubt strong("capacities of barriers",
    "Nets are sold for " + between(kNetCapacity, 1000.0) + " kJ: is it in kJ?");
  Doubt endless("barriers", "A barrier without a capacity stops every rock: is it a rock face?");
  Doubt soft("braking ways of barriers", "Nets brake on " + between(kBraking) + " m: is it in m?");
  Doubt worn("residual heights of barriers",
    "Nets keep " + between(kResidual, 0.01) +
      " % of their height at their capacity: is it that height, in %?");
  Doubt roomy("fillings of barriers",
    "Nets are filled by " + between(kNetRoom) + " m³ per m: is it in m³/m?");
  for (const Barrier& b : barriers)
  {
    if (!b.records)
    {
      const std::string name = featureText(b.feature);
      endless.look(!std::isinf(b.capacity), name, [] { return std::string(); });
      soft.look(b.braking == 0.0 || kBraking.has(b.braking), name, b.braking, " m");
      worn.look(std::isnan(b.residual) || b.residual == 0.0 || kResidual.has(b.residual), name,
        b.residual, " %", 0.01);
      roomy.look(std::isinf(b.room) || kNetRoom.has(b.room), name, b.room, " m³/m");
      high.look(kNetHeight, name, b.height, " m");
      strong.look(
        std::isinf(b.capacity) || kNetCapacity.has(b.capacity), name, b.capacity, " kJ", 1000.0);
    }
  }
  tellAll(notes, high, strong, endless, soft, worn, roomy);
}

void lookAtEmbankments(const std::vector<Embankment>& dams, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt high(
    "heights of embankments", "Embankments are " + between(kDamHeight) + " m high: is it in m?");
  Doubt wide("widths of crests", "Crests are " + between(kCrestWidth) + " m wide: is it in m?");
  Doubt flat("sides of embankments",
    "Sides go " + between(kSideSlope) + " m across per m down: is it a number of degrees?");
  for (const Embankment& e : dams)
  {
    const std::string name = featureText(e.feature);
    high.look(std::isnan(e.height) || kDamHeight.has(e.height), name, e.height, " m");
    wide.look(kCrestWidth, name, e.crestWidth, " m");
    flat.look(kSideSlope, name, std::max(e.mountainSlope, e.valleySlope), "");
  }
  tellAll(notes, high, wide, flat);
}

/// Numbers of any ground, of which the slope's own, a class or a structure is named.
class GroundDoubts
{
public:
  explicit GroundDoubts(const std::string& of)
    : steep_("friction angles" + of,
        "Ground has " + between(plausible::kFrictionAngle) + " degrees: is it in degrees?")
    , vague_("deviations of friction angles" + of,
        "φ deviates by up to " + text(plausible::kFrictionDeviation.most) +
          " degrees: is it a deviation?")
    , sticky_("cohesions" + of,
        "Contact points hold " + between(plausible::kCohesion) + " N: is it in N, not Pa?")
    , swapped_("restitutions" + of, "Rt is at least Rn in all tables: is one in the other's place?")
    , wide_("deviations of restitution" + of,
        "Coefficients deviate by up to " + text(plausible::kRestitutionDeviation.most) +
          ": is it a deviation of 0 to 1?")
    , slow_("speeds of restitution" + of,
        "Half of Rn is gone at " + between(plausible::kRestitutionSpeed) + " m/s: is it in m/s?")
  {
    static_assert(std::size(plausible::kYielding) == 13); // as many as yieldingFields()
    for (const YieldingField& field : yieldingFields())
    {
      const PlausibleRange& range = plausible::kYielding[yields_.size()];
      yields_.emplace_back(std::string("values of ") + field.property + of,
        std::string(field.property) + " is " + between(range, field.scale) + unitOf(field) +
          " on ground that yields: is it what was meant?");
    }
  }

  void friction(const SurfaceMaterial& m, const std::string& name)
  {
    const double phi = degrees(m.frictionAngle);
    steep_.look(phi == 0.0 || plausible::kFrictionAngle.has(phi), name, phi, " degrees");
    vague_.look(plausible::kFrictionDeviation, name, degrees(m.frictionAngleDeviation), " degrees");
    sticky_.look(plausible::kCohesion, name, m.cohesion, " N");
  }

  void restitution(const SurfaceMaterial& m, const std::string& name)
  {
    const double rn = m.restitution, rt = m.tangentialRestitution;
    swapped_.look(m.restitutionModel == RestitutionModel::Velocity || rn <= rt, name,
      [&] { return " with Rn " + text(rn) + " and Rt " + text(rt); });
    slow_.look(m.restitutionModel != RestitutionModel::SpeedDependent ||
        plausible::kRestitutionSpeed.has(m.restitutionSpeed),
      name, m.restitutionSpeed, " m/s");
    wide_.look(plausible::kRestitutionDeviation, name, m.restitutionDeviation, "");
    for (std::size_t k = 0; k < yields_.size(); ++k)
    {
      const YieldingField& field = yieldingFields()[k];
      const double value = m.yielding.*field.member;
      yields_[k].look(std::isinf(value) || plausible::kYielding[k].has(value), name, value,
        unitOf(field), field.scale);
    }
  }

  void tell(std::vector<std::string>& notes) const
  {
    tellAll(notes, steep_, vague_, sticky_, swapped_, wide_, slow_);
    for (const Doubt& doubt : yields_)
    {
      doubt.tell(notes);
    }
  }

private:
  static std::string unitOf(const YieldingField& field)
  {
    return *field.unit ? " " + std::string(field.unit) : std::string();
  }

  Doubt steep_, vague_, sticky_, swapped_, wide_, slow_;
  std::vector<Doubt> yields_; ///< In the order of yieldingFields().
};

void lookAtMaterials(const Structures& structures, std::vector<std::string>& notes)
{
  GroundDoubts doubts(" of structures");
  const auto look = [&](const auto& item)
  {
    if (item.material > 0)
    {
      const SurfaceMaterial& material = structures.materials[std::size_t(item.material) - 1];
      doubts.friction(material, featureText(item.feature));
      doubts.restitution(material, featureText(item.feature));
    }
  };
  std::for_each(structures.embankments.begin(), structures.embankments.end(), look);
  std::for_each(structures.trees.begin(), structures.trees.end(), look);
  doubts.tell(notes);
}

/// Words for structures of a kind that are there twice.
struct TwinWords
{
  const char* kind;
  const char* effect; ///< Of both at one place.
};

/// Notes structures at the place of an earlier one.
template <class Item>
void tellTwice(const TwinWords& words, const std::vector<const Item*>& items,
  const std::vector<int>& earlier, std::vector<std::string>& notes)
{
  Tally twice;
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    twice.look(earlier[i] >= 0,
      [&]
      {
        const std::int64_t other = items[std::size_t(earlier[i])]->feature, own = items[i]->feature;
        return other == own ? "two parts of " + featureText(own)
                            : "features " + std::to_string(other) + " and " + std::to_string(own);
      });
  }
  twice.tell(notes, "",
    " of " + std::to_string(items.size()) + " " + words.kind + " stand within " +
      text(kTwinDistance) + " m of another one, first ",
    std::string(". ") + words.effect + ": was something given twice?");
}

std::string placeText(const Point& p)
{
  return "(" + numberText(p.x(), 9) + ", " + numberText(p.y(), 9) + ")";
}

std::string stretchText(const SharedStretch& stretch, const Point& origin)
{
  return " over " + numberText(stretch.length, 3) + " m, from " + placeText(stretch.from + origin) +
    " to " + placeText(stretch.to + origin);
}

/// Notes structures on a part of an earlier one, and those that go back on their own line or cross it.
template <class Item>
void tellStretches(const TwinWords& words, const std::vector<const Item*>& items,
  const std::vector<SharedStretch>& stretches, const Point& origin, std::vector<std::string>& notes)
{
  Tally others, selves, crossed;
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    const SharedStretch& stretch = stretches[i];
    const std::string own = featureText(items[i]->feature);
    const bool self = stretch.earlier == int(i);
    selves.look(self, [&] { return own + stretchText(stretch, origin); });
    others.look(stretch.earlier >= 0 && !self,
      [&]
      {
        const std::int64_t other = items[std::size_t(stretch.earlier)]->feature;
        return own + " on " + (other == items[i]->feature ? "another part of " : "") +
          featureText(other) + stretchText(stretch, origin);
      });
    crossed.look(stretch.crossing && !self,
      [&] { return own + " at " + placeText(*stretch.crossing + origin); });
  }
  const std::string of = " of " + std::to_string(items.size()) + " " + words.kind;
  others.tell(notes, "",
    of + " stand within " + text(kTwinDistance) +
      " m of another one over a part of their length, first ",
    std::string(". ") + words.effect + " there: was something given twice?");
  selves.tell(notes, "", of + " go back on their own line, first ",
    ". They are at work once there: is the line as it was meant?");
  crossed.tell(notes, "", of + " cross their own line, first ", ": are its points in their order?");
}

/// Forests of single stems that leave no room to walk in.
void tellCrowds(const std::vector<Tree>& trees, std::vector<std::string>& notes)
{
  using plausible::kBasalArea;
  constexpr double side = 50.0, hectares = side * side / kHectare; // m
  std::map<std::pair<double, double>, double> areas;               // m²
  for (const Tree& tree : trees)
  {
    if (tree.lies())
    {
      continue;
    }
    const Point at = tree.position / side;
    areas[{ std::floor(at.x()), std::floor(at.y()) }] +=
      0.25 * M_PI * tree.diameter * tree.diameter;
  }
  Doubt dense("squares of 50 m with trees",
    "Stems have up to " + text(kBasalArea.most) +
      " m² a hectare at breast height: was a forest given twice, or are its diameters others?");
  for (const auto& [place, area] : areas)
  {
    const double ofHectare = area / hectares;
    dense.look(ofHectare <= kBasalArea.most, "one with ",
      [&] { return numberText(ofHectare, 3) + " m² a hectare"; });
  }
  dense.tell(notes);
}

template <class Item>
void linesTwice(const TwinWords& words, const std::vector<const Item*>& items,
  const std::vector<PlanLines>& lines, const Point& origin, std::vector<std::string>& notes)
{
  PlanLines whole;
  for (const PlanLines& line : lines)
  {
    whole.push_back(line.front());
  }
  tellTwice(words, items, earlierLines(whole), notes);
  tellStretches(words, items, sharedStretches(lines), origin, notes);
}

template <class Item>
void linesTwice(const TwinWords& words, const std::vector<const Item*>& items, const Point& origin,
  std::vector<std::string>& notes)
{
  std::vector<PlanLines> lines;
  for (const Item* item : items)
  {
    lines.push_back({ item->points });
  }
  linesTwice(words, items, lines, origin, notes);
}

template <class Item, class Takes>
std::vector<const Item*> those(const std::vector<Item>& all, Takes&& takes)
{
  std::vector<const Item*> list;
  for (const Item& item : all)
  {
    if (takes(item))
    {
      list.push_back(&item);
    }
  }
  return list;
}

} // namespace

void askAfterNumbers(const Structures& structures, std::vector<std::string>& notes)
{
  lookAtEmbankments(structures.embankments, notes);
  lookAtTrees(structures.trees, notes);
  lookAtNets(structures.barriers, notes);
  lookAtMaterials(structures, notes);
}

void askAfterGround(const Terrain& terrain, std::vector<std::string>& notes)
{
  using namespace plausible;
  GroundDoubts own(" of the ground");
  Doubt rough(
    "roughnesses of the ground", "Roughness is " + between(kRoughness) + " m: is it in m?");
  Doubt wave("lengths of roughness",
    "Roughness is alike over 0, or " + between(kRoughnessLength) + " m: is it in m?");
  Doubt high(
    "heights of obstacles", "Obstacles are " + between(kObstacle) + " m high: are they in m?");
  const auto surface = [&](const Roughness& r, const std::string& where)
  {
    const bool raised = !kRoughness.has(std::abs(r.mean));
    rough.look(!raised && kRoughness.has(r.deviation), where,
      [&]
      {
        return raised ? " with a mean of " + text(r.mean) + " m"
                      : " with a deviation of " + text(r.deviation) + " m";
      });
    wave.look(r.length == 0.0 || kRoughnessLength.has(r.length), where, r.length, " m");
    high.look(kObstacle, where, r.highestObstacle(), " m");
  };
  own.friction(terrain.material(), "the slope's own");
  own.restitution(terrain.material(), "the slope's own");
  surface(terrain.roughness(), "the slope's own");
  for (const MaterialClasses* classes : { &terrain.restitutionClasses(), &terrain.jointClasses() })
  {
    for (std::size_t k = 0; k < classes->names.size(); ++k)
    {
      const std::string where = "class \"" + classes->names[k] + "\"";
      classes == &terrain.jointClasses() ? own.friction(classes->materials[k], where)
                                         : own.restitution(classes->materials[k], where);
      if (k < classes->roughness.size())
      {
        surface(classes->roughness[k], where);
      }
    }
  }
  tellAll(notes, own, rough, wave, high);
}

void askAfterFrequency(double perYear, std::vector<std::string>& notes)
{
  if (!plausible::kRocksPerYear.has(perYear))
  {
    notes.push_back("The rocks together fall " + numberText(perYear, 4) +
      " times a year: are frequencies rocks per year, not return periods?");
  }
}

void askAfterStands(std::span<const Stand> stands, std::vector<std::string>& notes, bool cells)
{
  using namespace plausible;
  Doubt dense("stands",
    "Stems of a hectare have " + between(kBasalArea) +
      " m² at breast height: are stems_ha per hectare and diameters in cm?");
  Doubt mixed("shares of conifers",
    "Conifers are " + between(kConifers, 0.01) + " % of the stems: is it in %?");
  Doubt thick = thicknesses("mean diameters of stands"), slender = slendernesses("stands");
  Doubt strong("stands by their factors",
    "Factors of species are " + between(kStemCapacity) + ": are they of the capacity?");
  for (const Stand& s : stands)
  {
    const std::string name = featureText(s.feature);
    strong.look(kStemCapacity, name,
      kStemCapacity.has(s.coniferFactor) ? s.broadleafFactor : s.coniferFactor, "");
    const bool fits = kStemDiameter.has(s.diameterMean);
    thick.look(fits, name, s.diameterMean, " cm", 0.01);
    slender.look(!fits || kSlenderness.has(s.height / s.diameterMean), name,
      [&] { return highAndThick(s.height, s.diameterMean); });
    mixed.look(s.conifers == 0.0 || kConifers.has(s.conifers), name, s.conifers, " %", 0.01);
    const double square =
      s.diameterMean * s.diameterMean + s.diameterDeviation * s.diameterDeviation;
    const double area = s.stemsPerHectare * 0.25 * M_PI * square;
    dense.look(kBasalArea.has(area), name,
      [&]
      {
        return ": " + text(s.stemsPerHectare) + " stems of " + text(100.0 * s.diameterMean) +
          " cm, " + numberText(area, 3) + " m²";
      });
  }
  tellAll(notes, thick, slender, strong, dense, mixed);
  if (cells)
  {
    return;
  }
  Doubt twice("stands", "Their stems add up: was something given twice?");
  std::vector<PlanRings> grounds;
  for (const Stand& s : stands)
  {
    grounds.push_back(s.rings);
  }
  const std::vector<SharedGround> shared = sharedGround(grounds);
  for (std::size_t k = 0; k < stands.size(); ++k)
  {
    twice.look(shared[k].earlier < 0, featureText(stands[k].feature),
      [&]
      {
        return ", which shares " + text(shared[k].area) + " m² with feature " +
          std::to_string(stands[std::size_t(shared[k].earlier)].feature);
      });
  }
  twice.tell(notes);
}

void askAfterTwins(
  const Structures& structures, std::vector<std::string>& notes, const Point& origin)
{
  const auto all = [](const auto&) { return true; };
  linesTwice(TwinWords{ "embankments", "The higher one counts" },
    those(structures.embankments, all), origin, notes);
  constexpr const char* both = "Each takes its capacity";
  const auto stand = those(structures.trees, [](const Tree& t) { return !t.lies(); });
  std::vector<Point> stems;
  for (const Tree* tree : stand)
  {
    stems.push_back(tree->position);
  }
  tellTwice(TwinWords{ "trees", both }, stand, earlierPoints(stems), notes);
  const auto lie = those(structures.trees, [](const Tree& t) { return t.lies(); });
  std::vector<PlanLines> axes;
  for (const Tree* tree : lie)
  {
    axes.push_back({ { tree->position, tree->end } });
  }
  linesTwice(TwinWords{ "lying stems", both }, lie, axes, origin, notes);
  tellCrowds(structures.trees, notes);
  linesTwice(TwinWords{ "barriers", both },
    those(structures.barriers, [](const Barrier& b) { return !b.records; }), origin, notes);
}

} // namespace rockfall
