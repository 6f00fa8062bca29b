#include "rock/fall/Fall.h"

#include "geometry/roundBody.h"
#include "law/settings.h"
#include "rock/Rock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

RockBody bodyOf(const Rock& rock, const Block& block, const SimulationParameters& p)
{
  RockBody body(block);
  body.state.position = rock.position;
  body.state.orientation = rock.orientation.normalized();
  body.state.velocity = rock.velocity;
  body.state.spin = body.state.orientation.conjugate() * rock.angularVelocity;
  body.restingSpeed =
    kRestingSpeed * std::sqrt(std::max(p.gravity, kLeastGravity) * block.radius());
  const double contacts = std::sqrt(p.penaltyFor(block.mass()) * block.largestMobility());
  body.stiff =
    p.rigid || block.strainFrequency() >= std::min(kStiffBesideContacts * contacts, kFastVibration);
  body.ringing = body.stiff ? 0.0 : 2.0 * std::numbers::pi / block.strainFrequency();
  return body;
}

} // namespace

Fall::Fall(const Surface& s, const Rock& rock, const Block& block, const SimulationParameters& p,
  std::uint32_t number)
  : surface(s)
  , parameters(p)
  , body(bodyOf(rock, block, p))
  , impulses(this->body.stiff && !s.terrain().givesWay() &&
      p.impactResolution == ImpactResolution::Impulse && !isRound(block.shape().layout()))
  , springs(s, p, block)
  , structures(s)
  , ground(s, p.gravity)
  , impact(s, p, number, this->impulses)
  , soil(s, p.gravity)
  , recorder(s, block, p)
{
}

void Fall::end(Fate fate)
{
  this->recorder.trajectory().summary.fate = fate;
  this->body.done = true;
}

} // namespace rockfall
