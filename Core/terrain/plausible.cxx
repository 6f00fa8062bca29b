#include "terrain/plausible.h"

#include "base/hectare.h"
#include "base/text/numberText.h"
#include "geometry/twins.h"
#include "terrain/Terrain.h"
#include "terrain/doubt.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
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

void lookAtTrees(const std::vector<Tree>& trees, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt thick("Stems have " + between(kStemDiameter, 0.01) + " cm: are diameters in cm?");
  Doubt slender("Trees are " + between(kSlenderness) +
    " times as high as thick: are diameters in cm and heights in m?");
  Doubt wrong("Lying stems are " + between(kLyingLength) + " m long: is the line one stem?");
  Doubt strong("Stems hold " + between(kStemCapacity) +
    " times what Dorren and Berger give their diameter: are capacities in kJ?");
  for (const Tree& t : trees)
  {
    const bool fits = kStemDiameter.has(t.diameter);
    thick.look(fits, t.feature, [&] { return " with " + text(100.0 * t.diameter) + " cm"; });
    if (t.lies())
    {
      const double length = (t.end - t.position).norm();
      wrong.look(
        kLyingLength.has(length), t.feature, [&] { return " with " + text(length) + " m"; });
    }
    else
    {
      // A stem that is too thick is told once.
      slender.look(!fits || kSlenderness.has(t.height / t.diameter), t.feature,
        [&] {
          return ": " + text(t.height) + " m high and " + text(100.0 * t.diameter) + " cm thick";
        });
    }
    const double share = t.capacity / stemCapacity(t.diameter);
    strong.look(!fits || std::isinf(share) || kStemCapacity.has(share), t.feature,
      [&] { return " with " + text(t.capacity / 1000.0) + " kJ"; });
  }
  thick.tell("diameters of trees", notes);
  slender.tell("trees", notes);
  wrong.tell("lengths of lying stems", notes);
  strong.tell("capacities of trees", notes);
}

void lookAtNets(const std::vector<Barrier>& barriers, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt high("Nets stand " + between(kNetHeight) + " m high: is it in m?");
  Doubt strong("Nets are sold for " + between(kNetCapacity, 1000.0) + " kJ: is it in kJ?");
  Doubt endless("A barrier without a capacity stops every rock: is it a rock face?");
  Doubt soft("Nets brake on " + between(kBraking) + " m: is it in m?");
  Doubt worn("Nets keep " + between(kResidual, 0.01) +
    " % of their height at their capacity: is it that height, in %?");
  Doubt roomy("Nets are filled by " + between(kNetRoom) + " m³ per m: is it in m³/m?");
  for (const Barrier& b : barriers)
  {
    if (!b.records)
    {
      endless.look(!std::isinf(b.capacity), b.feature, [] { return std::string(); });
      soft.look(b.braking == 0.0 || kBraking.has(b.braking), b.feature,
        [&] { return " with " + text(b.braking) + " m"; });
      worn.look(std::isnan(b.residual) || b.residual == 0.0 || kResidual.has(b.residual), b.feature,
        [&] { return " with " + text(100.0 * b.residual) + " %"; });
      roomy.look(std::isinf(b.room) || kNetRoom.has(b.room), b.feature,
        [&] { return " with " + text(b.room) + " m³/m"; });
      high.look(
        kNetHeight.has(b.height), b.feature, [&] { return " with " + text(b.height) + " m"; });
      strong.look(std::isinf(b.capacity) || kNetCapacity.has(b.capacity), b.feature,
        [&] { return " with " + text(b.capacity / 1000.0) + " kJ"; });
    }
  }
  high.tell("heights of barriers", notes);
  strong.tell("capacities of barriers", notes);
  endless.tell("barriers", notes);
  soft.tell("braking ways of barriers", notes);
  worn.tell("residual heights of barriers", notes);
  roomy.tell("fillings of barriers", notes);
}

void lookAtEmbankments(const std::vector<Embankment>& dams, std::vector<std::string>& notes)
{
  using namespace plausible;
  Doubt high("Embankments are " + between(kDamHeight) + " m high: is it in m?");
  Doubt wide("Crests are " + between(kCrestWidth) + " m wide: is it in m?");
  Doubt flat(
    "Sides go " + between(kSideSlope) + " m across per m down: is it a number of degrees?");
  for (const Embankment& e : dams)
  {
    high.look(std::isnan(e.height) || kDamHeight.has(e.height), e.feature,
      [&] { return " with " + text(e.height) + " m"; });
    wide.look(kCrestWidth.has(e.crestWidth), e.feature,
      [&] { return " with " + text(e.crestWidth) + " m"; });
    const double side = std::max(e.mountainSlope, e.valleySlope);
    flat.look(kSideSlope.has(side), e.feature, [&] { return " with " + text(side); });
  }
  high.tell("heights of embankments", notes);
  wide.tell("widths of crests", notes);
  flat.tell("sides of embankments", notes);
}

/// Numbers of any ground, of which the slope's own, a class or a structure is named.
class GroundDoubts
{
public:
  template <class Name>
  void friction(const SurfaceMaterial& m, const Name& name)
  {
    const double phi = degrees(m.frictionAngle);
    steep_.look(phi == 0.0 || plausible::kFrictionAngle.has(phi), name,
      [&] { return " with " + text(phi) + " degrees"; });
    const double deviation = degrees(m.frictionAngleDeviation);
    vague_.look(plausible::kFrictionDeviation.has(deviation), name,
      [&] { return " with " + text(deviation) + " degrees"; });
    sticky_.look(plausible::kCohesion.has(m.cohesion), name,
      [&] { return " with " + text(m.cohesion) + " N"; });
  }

  template <class Name>
  void restitution(const SurfaceMaterial& m, const Name& name)
  {
    const double rn = m.restitution, rt = m.tangentialRestitution;
    swapped_.look(m.restitutionModel == RestitutionModel::Velocity || rn <= rt, name,
      [&] { return " with Rn " + text(rn) + " and Rt " + text(rt); });
    slow_.look(m.restitutionModel != RestitutionModel::SpeedDependent ||
        plausible::kRestitutionSpeed.has(m.restitutionSpeed),
      name, [&] { return " with " + text(m.restitutionSpeed) + " m/s"; });
    wide_.look(plausible::kRestitutionDeviation.has(m.restitutionDeviation), name,
      [&] { return " with " + text(m.restitutionDeviation); });
    for (std::size_t k = 0; k < yields_.size(); ++k)
    {
      const YieldingField& field = yieldingFields()[k];
      const double value = m.yielding.*field.member;
      yields_[k].look(std::isinf(value) || plausible::kYielding[k].has(value), name,
        [&] { return " with " + text(value / field.scale) + unitOf(field); });
    }
  }

  void tell(const std::string& of, std::vector<std::string>& notes) const
  {
    const auto tell = [&](const Doubt& doubt, const std::string& what)
    { doubt.tell((what + " of " + of).c_str(), notes); };
    tell(steep_, "friction angles");
    tell(vague_, "deviations of friction angles");
    tell(sticky_, "cohesions");
    tell(swapped_, "restitutions");
    tell(wide_, "deviations of restitution");
    tell(slow_, "speeds of restitution");
    for (std::size_t k = 0; k < yields_.size(); ++k)
    {
      tell(yields_[k], std::string("values of ") + yieldingFields()[k].property);
    }
  }

private:
  static std::string unitOf(const YieldingField& field)
  {
    return *field.unit ? " " + std::string(field.unit) : std::string();
  }

  static std::vector<Doubt> yieldingDoubts()
  {
    static_assert(std::size(plausible::kYielding) == 13); // as many as yieldingFields()
    std::vector<Doubt> doubts;
    for (const YieldingField& field : yieldingFields())
    {
      const PlausibleRange& range = plausible::kYielding[doubts.size()];
      doubts.emplace_back(std::string(field.property) + " is " + between(range, field.scale) +
        unitOf(field) + " on ground that yields: is it what was meant?");
    }
    return doubts;
  }

  std::vector<Doubt> yields_ = yieldingDoubts();
  Doubt steep_{ "Ground has " + between(plausible::kFrictionAngle) +
    " degrees: is it in degrees?" };
  Doubt sticky_{ "Contact points hold " + between(plausible::kCohesion) +
    " N: is it in N, not Pa?" };
  Doubt slow_{ "Half of Rn is gone at " + between(plausible::kRestitutionSpeed) +
    " m/s: is it in m/s?" };
  Doubt wide_{ "Coefficients deviate by up to " + text(plausible::kRestitutionDeviation.most) +
    ": is it a deviation of 0 to 1?" };
  Doubt vague_{ "φ deviates by up to " + text(plausible::kFrictionDeviation.most) +
    " degrees: is it a deviation?" };
  Doubt swapped_{ "Rt is at least Rn in all tables: is one in the other's place?" };
};

void lookAtMaterials(const Structures& structures, std::vector<std::string>& notes)
{
  GroundDoubts doubts;
  const auto look = [&](const auto& item)
  {
    if (item.material > 0)
    {
      const SurfaceMaterial& material = structures.materials[std::size_t(item.material) - 1];
      doubts.friction(material, item.feature);
      doubts.restitution(material, item.feature);
    }
  };
  std::for_each(structures.embankments.begin(), structures.embankments.end(), look);
  std::for_each(structures.trees.begin(), structures.trees.end(), look);
  doubts.tell("structures", notes);
}

/// Words for structures of a kind that are there twice.
struct TwinWords
{
  const char* kind;
  const char* effect; ///< Of both at one place.
};

std::string featureText(std::int64_t feature)
{
  return "feature " + std::to_string(feature);
}

/// Notes structures at the place of an earlier one.
template <class Item>
void tellTwice(const TwinWords& words, const std::vector<const Item*>& items,
  const std::vector<int>& earlier, std::vector<std::string>& notes)
{
  std::int64_t count = 0;
  std::string first;
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    if (earlier[i] >= 0 && ++count == 1)
    {
      const std::int64_t other = items[std::size_t(earlier[i])]->feature, own = items[i]->feature;
      first = other == own ? "two parts of " + featureText(own)
                           : "features " + std::to_string(other) + " and " + std::to_string(own);
    }
  }
  if (count > 0)
  {
    notes.push_back(std::to_string(count) + " of " + std::to_string(items.size()) + " " +
      words.kind + " stand within " + text(kTwinDistance) + " m of another one, first " + first +
      ". " + words.effect + ": was something given twice?");
  }
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
  std::int64_t others = 0, selves = 0, crossed = 0;
  std::string first, self, cross;
  for (std::size_t i = 0; i < items.size(); ++i)
  {
    const SharedStretch& stretch = stretches[i];
    const std::string own = featureText(items[i]->feature);
    if (stretch.earlier == int(i) && ++selves == 1)
    {
      self = own + stretchText(stretch, origin);
    }
    else if (stretch.earlier >= 0 && stretch.earlier != int(i) && ++others == 1)
    {
      const Item& other = *items[std::size_t(stretch.earlier)];
      first = own + " on " + (other.feature == items[i]->feature ? "another part of " : "") +
        featureText(other.feature) + stretchText(stretch, origin);
    }
    if (stretch.earlier != int(i) && stretch.crossing && ++crossed == 1)
    {
      cross = own + " at " + placeText(*stretch.crossing + origin);
    }
  }
  const std::string of = " of " + std::to_string(items.size()) + " " + words.kind;
  if (others > 0)
  {
    notes.push_back(std::to_string(others) + of + " stand within " + text(kTwinDistance) +
      " m of another one over a part of their length, first " + first + ". " + words.effect +
      " there: was something given twice?");
  }
  if (selves > 0)
  {
    notes.push_back(std::to_string(selves) + of + " go back on their own line, first " + self +
      ". They are at work once there: is the line as it was meant?");
  }
  if (crossed > 0)
  {
    notes.push_back(std::to_string(crossed) + of + " cross their own line, first " + cross +
      ": are its points in their order?");
  }
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
  Doubt dense("Stems have up to " + text(kBasalArea.most) +
    " m² a hectare at breast height: was a forest given twice, or are its diameters others?");
  for (const auto& [place, area] : areas)
  {
    const double ofHectare = area / hectares;
    dense.look(ofHectare <= kBasalArea.most, std::string("one with "),
      [&] { return numberText(ofHectare, 3) + " m² a hectare"; });
  }
  dense.tell("squares of 50 m with trees", notes);
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
  GroundDoubts own;
  Doubt rough("Roughness is " + between(kRoughness) + " m: is it in m?");
  Doubt wave("Roughness is alike over 0, or " + between(kRoughnessLength) + " m: is it in m?");
  Doubt high("Obstacles are " + between(kObstacle) + " m high: are they in m?");
  const auto surface = [&](const Roughness& r, const std::string& where)
  {
    const bool raised = !kRoughness.has(std::abs(r.mean));
    rough.look(!raised && kRoughness.has(r.deviation), where,
      [&]
      {
        return raised ? " with a mean of " + text(r.mean) + " m"
                      : " with a deviation of " + text(r.deviation) + " m";
      });
    wave.look(r.length == 0.0 || kRoughnessLength.has(r.length), where,
      [&] { return " with " + text(r.length) + " m"; });
    high.look(kObstacle.has(r.highestObstacle()), where,
      [&] { return " with " + text(r.highestObstacle()) + " m"; });
  };
  own.friction(terrain.material(), std::string("the slope's own"));
  own.restitution(terrain.material(), std::string("the slope's own"));
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
  own.tell("the ground", notes);
  rough.tell("roughnesses of the ground", notes);
  wave.tell("lengths of roughness", notes);
  high.tell("heights of obstacles", notes);
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
  Doubt dense("Stems of a hectare have " + between(kBasalArea) +
    " m² at breast height: are stems_ha per hectare and diameters in cm?");
  Doubt mixed("Conifers are " + between(kConifers, 0.01) + " % of the stems: is it in %?");
  Doubt thick("Stems have " + between(kStemDiameter, 0.01) + " cm: are diameters in cm?");
  Doubt slender("Trees are " + between(kSlenderness) +
    " times as high as thick: are diameters in cm and heights in m?");
  Doubt strong("Factors of species are " + between(kStemCapacity) + ": are they of the capacity?");
  for (const Stand& s : stands)
  {
    const double factor = kStemCapacity.has(s.coniferFactor) ? s.broadleafFactor : s.coniferFactor;
    strong.look(kStemCapacity.has(factor), s.feature, [&] { return " with " + text(factor); });
    const bool fits = kStemDiameter.has(s.diameterMean);
    thick.look(fits, s.feature, [&] { return " with " + text(100.0 * s.diameterMean) + " cm"; });
    slender.look(!fits || kSlenderness.has(s.height / s.diameterMean), s.feature,
      [&] {
        return ": " + text(s.height) + " m high and " + text(100.0 * s.diameterMean) + " cm thick";
      });
    mixed.look(s.conifers == 0.0 || kConifers.has(s.conifers), s.feature,
      [&] { return " with " + text(100.0 * s.conifers) + " %"; });
    const double square =
      s.diameterMean * s.diameterMean + s.diameterDeviation * s.diameterDeviation;
    const double area = s.stemsPerHectare * 0.25 * M_PI * square;
    dense.look(kBasalArea.has(area), s.feature,
      [&]
      {
        return ": " + text(s.stemsPerHectare) + " stems of " + text(100.0 * s.diameterMean) +
          " cm, " + numberText(area, 3) + " m²";
      });
  }
  thick.tell("mean diameters of stands", notes);
  slender.tell("stands", notes);
  strong.tell("stands by their factors", notes);
  dense.tell("stands", notes);
  mixed.tell("shares of conifers", notes);
  if (cells)
  {
    return;
  }
  Doubt twice("Their stems add up: was something given twice?");
  std::vector<PlanRings> grounds;
  for (const Stand& s : stands)
  {
    grounds.push_back(s.rings);
  }
  const std::vector<SharedGround> shared = sharedGround(grounds);
  for (std::size_t k = 0; k < stands.size(); ++k)
  {
    twice.look(shared[k].earlier < 0, stands[k].feature,
      [&]
      {
        return ", which shares " + text(shared[k].area) + " m² with feature " +
          std::to_string(stands[std::size_t(shared[k].earlier)].feature);
      });
  }
  twice.tell("stands", notes);
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
