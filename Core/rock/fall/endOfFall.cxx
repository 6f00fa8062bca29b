#include "rock/fall/endOfFall.h"

#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "terrain/walls.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

void checkLeft(Fall& fall)
{
  RockBody& body = fall.body;
  const Terrain& terrain = fall.surface.terrain();
  const Vec3& p = body.state.position;
  const double r = body.block.radius();
  bool left =
    !(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= terrain.width() && p.y() <= terrain.height());
  if (!left && !fall.ground.isClearAt(body, p, 0.0) && terrain.cfeAt(p.x(), p.y()) == 0)
  {
    // Over a hole it has left once it is below everything around; the bound costs next to nothing.
    const double x0 = p.x() - r, x1 = p.x() + r, y0 = p.y() - r, y1 = p.y() + r;
    left = p.z() < terrain.lowest() - 2.0 * r ||
      (p.z() + r < fall.surface.maxHeight(x0, x1, y0, y1) &&
        p.z() + r < lowestNode(fall.surface, x0, x1, y0, y1));
  }
  if (left)
  {
    fall.end(terrain.isHole(p.x(), p.y()) ? Fate::LostInNodata : Fate::LeftDomain);
  }
}

void followRest(Fall& fall, double h, bool touching)
{
  RockBody& body = fall.body;
  const double r = body.block.radius();
  const double speed = body.state.velocity.norm() + body.state.spin.norm() * r;
  const double still =
    kStillSpeed * std::sqrt(std::max(fall.parameters.gravity, kLeastGravity) * r);
  body.quietTime = touching && speed < still ? body.quietTime + h : 0.0;
}

void checkEnd(Fall& fall, double h)
{
  RockBody& body = fall.body;
  if (!body.done)
  {
    checkLeft(fall);
  }
  if (body.done)
  {
    return;
  }
  followRest(fall, h, anyClosed(body.contacts));
  if (body.quietTime >= kStillTime)
  {
    fall.end(Fate::Rested);
  }
  else if (body.state.time >= fall.parameters.endTime - kTooShort)
  {
    fall.end(Fate::Moving);
  }
}

} // namespace rockfall
