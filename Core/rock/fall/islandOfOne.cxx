#include "rock/fall/islandOfOne.h"

#include "law/settings.h"
#include "rock/fall/Fall.h"
#include "rock/fall/atStructures.h"
#include "rock/fall/contactPhase.h"
#include "rock/parts/OverlapRecovery.h"
#include "rock/restitution.h"
#include "solve/island/SoftSolver.h"

namespace rockfall
{

namespace
{

/// Working memory, of a thread.
struct Work
{
  SoftSolver solver;
  std::vector<IslandBody> bodies;
  std::vector<IslandContact> contacts;
};

} // namespace

IslandContact touchOnSlope(const Fall& fall, int number, Contact& c)
{
  const RockBody& body = fall.body;
  const BlockState& state = body.state;
  const double approach = approachOf(state, state.angularVelocity(), c.point, c.normal);
  const bool down =
    comesDown(approach, state.velocity.norm(), fall.parameters.gravity, body.block.radius());
  const int ground = fall.surface.restitutionClass(c.cfe);
  const SurfaceMaterial& material = fall.surface.terrain().restitutionMaterial(ground);
  IslandContact k;
  k.restitution = fall.surface.restitutionAt(fall.impact.touchAt(c.cfe, c.point));
  if (material.restitutionModel == RestitutionModel::Velocity && down)
  {
    k.restitution = 1.0; // Rv is taken off the whole velocity when the impact is over
  }
  else if (material.restitutionModel == RestitutionModel::SpeedDependent)
  {
    k.restitutionSpeed = material.restitutionSpeed;
  }
  k.resting = body.restingSpeed;
  k.contact = &c;
  k.closed = c.closed();
  k.first = number;
  k.friction = c.friction;
  k.cohesion = c.cohesion;
  if (c.closed() && fall.impact.pending())
  {
    k.reboundSpeed = bounceLeft(c, approach); // begun where impacts are resolved in time
  }
  return k;
}

bool isPressedIn(Fall& fall, StepKind kind)
{
  if (!fall.pressed && kind != StepKind::Lasting)
  {
    return false;
  }
  const double loose = fall.pressed ? kLooseOverlap : kFirm;
  fall.pressed = isDeep(fall.body, loose * fall.body.block.radius());
  return fall.pressed;
}

void stepAsIsland(Fall& fall, double h)
{
  RockBody& body = fall.body;
  if (!body.stiff)
  {
    body.energy.vibration += relaxStrain(body.block, body.state);
  }
  body.before = body.state;
  fall.struckAtOnce = 0;
  body.springEnergyBefore = body.springEnergy;
  body.contactsBefore = body.contacts;
  const double energyBefore = body.mechanicalEnergy(fall.parameters.gravity) + body.springEnergy;
  thread_local Work work;
  work.solver.setStiffness(
    { fall.springs.leastPenalty(), fall.parameters.shearRatio, fall.parameters.rigid });
  work.bodies.assign(1, {});
  work.bodies[0].block = &body.block;
  work.bodies[0].state = &body.state;
  work.contacts.clear();
  for (Contact& c : body.contacts)
  {
    work.contacts.push_back(touchOnSlope(fall, 0, c));
  }
  StepRequest request;
  request.duration = h;
  request.gravity = fall.parameters.gravity;
  request.substeps = substepsOf(h, fall.parameters.timeStep);
  TrajectorySummary& summary = fall.recorder.trajectory().summary;
  IslandOutcome solved;
  for (int cut = 0; !solved.accepted; ++cut)
  {
    const Accept accept = cut < kIslandCuts ? Accept::Settled : Accept::Any;
    solved = work.solver.step(request, work.bodies, work.contacts, accept);
    summary.openCloseIterations += solved.iterations;
    summary.cutSteps += !solved.accepted;
    request.duration *= solved.accepted ? 1.0 : 0.5;
  }
  if (fall.structures.solid() && undoAtTrees(fall, request.duration))
  {
    return;
  }
  ++summary.contactSteps;
  summary.unsettledSteps += !solved.settled;
  commitStep(fall, StepKind::Lasting, work.bodies[0].onSlope, energyBefore, 0.0, false);
  body.acceleration.setZero();
  body.spinAcceleration.setZero();
}

} // namespace rockfall
