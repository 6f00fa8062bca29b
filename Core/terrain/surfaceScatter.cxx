// The numbers of materials that a realisation draws, per iteration, impact or place.

#include "terrain/Surface.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

double restitutionOf(const SurfaceMaterial& m, double deviate)
{
  return std::clamp(m.restitution + m.restitutionDeviation * deviate, 0.0, 1.0);
}

double frictionOf(const SurfaceMaterial& m, double deviate)
{
  const double angle = m.frictionAngle + m.frictionAngleDeviation * deviate;
  return std::tan(std::clamp(angle, 0.0, radians(89.0)));
}

} // namespace

DeviationPer deviationPerFrom(double number)
{
  if (number != 0.0 && number != 1.0 && number != 2.0)
  {
    throw ParameterError("DeviationPer is " + numberText(number) +
      ", it must be 0 (iteration), 1 (impact) or 2 (place)");
  }
  return DeviationPer(int(number));
}

void Surface::drawMaterials()
{
  const auto deviate = [&](Draw purpose, double deviation, int number)
  {
    return drawn_ && deviation > 0.0
      ? normalDeviate(seed_, iteration_, purpose, std::uint64_t(number))
      : 0.0;
  };
  const auto restitution = [&](const SurfaceMaterial& m, int k)
  { return rockfall::restitutionOf(m, deviate(Draw::Restitution, m.restitutionDeviation, k)); };
  const auto friction = [&](const SurfaceMaterial& m, int k)
  { return frictionOf(m, deviate(Draw::FrictionAngle, m.frictionAngleDeviation, k)); };
  restitution_ = restitution(terrain_->material(), 0);
  friction_ = friction(terrain_->material(), 0);
  const Obstacles* const obstacles = terrain_->obstacles();
  const int built = obstacles ? int(obstacles->structures().materials.size()) : 0;
  for (int k = 1; k <= terrain_->restitutionClasses().count() + built; ++k)
  {
    restitutions_.push_back(restitution(terrain_->restitutionMaterial(k), k));
  }
  for (int k = 1; k <= terrain_->jointClasses().count() + built; ++k)
  {
    frictions_.push_back(friction(terrain_->jointMaterial(k), k));
  }
}

double Surface::deviate(DeviationPer per, Draw purpose, const GroundTouch& touch) const
{
  // A stream of its own for each of the three; what a touch is drawn for has one number, whatever
  // classes meet there.
  const Draw stream = Draw(std::uint32_t(purpose) | std::uint32_t(per) << 8);
  if (per == DeviationPer::Impact)
  {
    return normalDeviate(seed_, iteration_, stream, std::uint64_t(touch.rock) << 32 | touch.impact);
  }
  const GridGeometry& g = terrain_->geometry();
  return normalDeviate(seed_, iteration_, stream,
    squareAt(g.xOrigin + touch.position.x(), g.yOrigin + touch.position.y(), kPlaceSize));
}

double Surface::restitutionAt(const GroundTouch& touch) const
{
  const int number = terrain_->restitutionClassOf(touch.cfe);
  const SurfaceMaterial& m = terrain_->restitutionMaterial(number);
  const DeviationPer per = this->perOf(m);
  if (per == DeviationPer::Iteration || !(m.restitutionDeviation > 0.0))
  {
    return this->restitutionOf(number);
  }
  return rockfall::restitutionOf(m, this->deviate(per, Draw::Restitution, touch));
}

double Surface::frictionAt(const GroundTouch& touch) const
{
  const int number = terrain_->jointClassOf(touch.cfe);
  const SurfaceMaterial& m = terrain_->jointMaterial(number);
  const DeviationPer per = this->perOf(m);
  if (per == DeviationPer::Iteration || !(m.frictionAngleDeviation > 0.0))
  {
    return number == 0 ? friction_ : frictions_[std::size_t(number) - 1];
  }
  return frictionOf(m, this->deviate(per, Draw::FrictionAngle, touch));
}

double Surface::softnessAt(int restitutionClass, const Vec3& place) const
{
  const YieldingGround& ground = terrain_->restitutionMaterial(restitutionClass).yielding;
  if (!drawn_ || !ground.deviates())
  {
    return 1.0;
  }
  const GridGeometry& g = terrain_->geometry();
  return std::exp(ground.deviation *
    RoughField{ seed_, iteration_ }.gaussian(
      g.xOrigin + place.x(), g.yOrigin + place.y(), ground.deviationLength, Draw::Softness));
}

double Surface::largestRestitution() const
{
  double largest = 0.0;
  for (int k = 0; k <= terrain_->restitutionClasses().count(); ++k)
  {
    const SurfaceMaterial& m = terrain_->restitutionMaterial(k);
    largest = std::max(largest,
      this->perOf(m) == DeviationPer::Iteration ? this->restitutionOf(k)
                                                : rockfall::restitutionOf(m, largestDeviate));
  }
  return largest;
}

} // namespace rockfall
