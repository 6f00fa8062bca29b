#include "BlockSlope/blockSlope.h"

#include "BlockSlope/BlockSystem.h"
#include "base/errors.h"
#include "contact/ground/detection.h"
#include "law/settings.h"
#include "rock/parts/Recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace rockfall
{

namespace
{

/// Steps per half period of an impact on the springs between blocks.
constexpr double kBlockStepsPerImpact = 10.0;

class BlockSlopeSimulator
{
public:
  BlockSlopeSimulator(const Surface& surface, const Rock& rock, const Block& block,
    const SimulationParameters& p, SlopeBlocks slope)
    : surface_(surface)
    , block_(block)
    , parameters_(p)
    , system_(block, std::move(slope))
    , recorder_(surface, block, p.outputInterval)
  {
    state_.position = rock.position;
    state_.orientation = rock.orientation.normalized();
    state_.velocity = rock.velocity;
    state_.spin = state_.orientation.conjugate() * rock.angularVelocity;
    restingSpeed_ = kRestingSpeed * std::sqrt(std::max(p.gravity, 1e-3) * block.radius());
    const Terrain& terrain = surface.terrain();
    gatherPatch(surface, 0.0, terrain.width(), 0.0, terrain.height(), patch_);
    recorder_.trajectory().summary.blockId = rock.blockId;
  }

  BlockSlopeRun run();

private:
  double impactStep() const;
  double longStep() const;
  void findContacts(double reach);
  bool isCalm() const;
  bool mayLast(double h) const;
  void takeStep(double h, bool lasting);
  bool over(double h); ///< Rested, left, or out of time?
  double energy() const;

  const Surface& surface_;
  const Block& block_;
  const SimulationParameters& parameters_;
  BlockSystem system_;
  SurfacePatch patch_; ///< All of the slope.
  CandidatePairs candidates_;
  BlockState state_;
  PlacedBlock placed_;
  std::vector<Contact> contacts_;
  Recorder recorder_;
  BlockSlopeRun result_;
  double springEnergy_ = 0.0;
  double normalEnergy_ = 0.0;
  double restingSpeed_ = 0.0;
  double quietTime_ = 0.0;
  Vec3 acceleration_ = Vec3::Zero();
  Vec3 spinAcceleration_ = Vec3::Zero();
  std::vector<int> carriers_; ///< Features of the rock that carried in the last lasting step.
};

double BlockSlopeSimulator::longStep() const
{
  const double rim = state_.spin.norm() * block_.radius();
  const double speed = state_.velocity.norm() + rim + parameters_.gravity * parameters_.timeStep;
  const double travel = speed > 0.0 ? kTravelPerStep * block_.radius() / speed : 1e300;
  return std::max(
    std::min({ parameters_.timeStep, travel, parameters_.endTime - state_.time }), 1e-12);
}

double BlockSlopeSimulator::impactStep() const
{
  const double frequency = std::sqrt(parameters_.normalPenalty * block_.largestMobility());
  return std::min(this->longStep(), std::numbers::pi / (kBlockStepsPerImpact * frequency));
}

double BlockSlopeSimulator::energy() const
{
  return kineticEnergy(block_, state_) + strainEnergy(block_, state_) + springEnergy_ +
    system_.slopeEnergy() + block_.mass() * parameters_.gravity * state_.position.z();
}

/// Against every block of the slope.
void BlockSlopeSimulator::findContacts(double reach)
{
  gatherCandidates(placed_, state_, patch_, reach, candidates_);
  updateContacts(placed_, patch_, candidates_, reach, contacts_);
}

bool BlockSlopeSimulator::isCalm() const
{
  const double settled = restingSpeed_ +
    4.0 * parameters_.gravity * std::sqrt(block_.mass() / parameters_.normalPenalty);
  const Vec3 spin = state_.angularVelocity();
  return normalEnergy_ <= 0.5 * block_.mass() * settled * settled &&
    std::all_of(contacts_.begin(), contacts_.end(),
      [&](const Contact& c)
      {
        const Vec3 v = state_.velocity + spin.cross(c.point - state_.position);
        return !c.closed() || std::abs(c.normal.dot(v)) <= restingSpeed_;
      });
}

bool BlockSlopeSimulator::mayLast(double h) const
{
  bool any = false;
  const Vec3 spin = state_.angularVelocity();
  for (const Contact& c : contacts_)
  {
    const Vec3 v = state_.velocity + spin.cross(c.point - state_.position);
    const double approach = -c.normal.dot(v), gap = system_.gap(c);
    if (!c.closed() && approach > restingSpeed_ && gap < approach * h)
    {
      return false;
    }
    const bool still = std::abs(approach) <= restingSpeed_;
    any = any || c.closed() || (still && gap <= 0.5 * parameters_.gravity * h * h);
  }
  return any;
}

void BlockSlopeSimulator::takeStep(double h, bool lasting)
{
  const BlockState before = state_;
  const double energyBefore = this->energy();
  SystemRequest request;
  request.duration = h;
  request.lasting = lasting;
  request.gravity = parameters_.gravity;
  request.normalPenalty = parameters_.normalPenalty;
  request.shearPenalty = parameters_.normalPenalty * parameters_.shearRatio;
  request.friction = surface_.friction();
  request.cohesion = surface_.cohesion();
  request.maxOpenClose = parameters_.maxOpenClose;
  request.acceleration = acceleration_;
  request.spinAcceleration = spinAcceleration_;
  TrajectorySummary& summary = recorder_.trajectory().summary;
  SystemOutcome outcome;
  for (int cut = 0; !outcome.settled; ++cut)
  {
    const bool last = cut >= parameters_.maxCuts;
    outcome = system_.step(request, contacts_, state_, last);
    result_.solutions += outcome.iterations;
    if (outcome.settled || last)
    {
      break;
    }
    ++summary.cutSteps;
    request.duration *= 0.5;
  }
  summary.unsettledSteps += outcome.settled ? 0 : 1;
  ++result_.steps;
  springEnergy_ = outcome.springEnergy;
  normalEnergy_ = outcome.normalEnergy;
  summary.energy.friction += outcome.frictionWork;

  std::vector<int> carriers;
  for (const Contact& c : contacts_)
  {
    if (c.closed())
    {
      carriers.push_back(4 * c.rockFeature + int(c.kind));
    }
  }
  summary.contactSteps += carriers.empty() ? 0 : 1;
  // The lag of the next lasting step, as long as the same features carry.
  acceleration_.setZero();
  spinAcceleration_.setZero();
  if (lasting)
  {
    summary.energy.damping += energyBefore - this->energy() - outcome.frictionWork;
    const double bound = 3.0 * parameters_.gravity;
    const Vec3 a = (state_.velocity - before.velocity) / request.duration;
    const Vec3 b = (state_.spin - before.spin) / request.duration;
    if (carriers == carriers_ && a.norm() <= bound && b.norm() * block_.radius() <= bound)
    {
      acceleration_ = a;
      spinAcceleration_ = b;
    }
  }
  recorder_.recordBetween(before, state_, !carriers.empty());
  recorder_.follow(state_);
  if (carriers.empty())
  {
    summary.energy.vibration += relaxStrain(block_, state_) + system_.settleSlope();
  }
  carriers_ = lasting ? carriers : std::vector<int>();
}

bool BlockSlopeSimulator::over(double h)
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  const Vec3& p = state_.position;
  const double speed = state_.velocity.norm() + state_.spin.norm() * block_.radius();
  const double still =
    kStillSpeed * std::sqrt(std::max(parameters_.gravity, 1e-3) * block_.radius());
  quietTime_ = springEnergy_ > 0.0 && speed < still ? quietTime_ + h : 0.0;
  if (surface_.terrain().cfeAt(p.x(), p.y()) == 0)
  {
    summary.fate = Fate::LeftDomain;
    return true;
  }
  summary.fate = quietTime_ >= kStillTime ? Fate::Rested : Fate::Moving;
  return summary.fate == Fate::Rested || state_.time >= parameters_.endTime - 1e-9;
}

BlockSlopeRun BlockSlopeSimulator::run()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  summary.mass = block_.mass();
  summary.volume = block_.volume();
  const double before = this->energy();
  recorder_.begin(state_);
  const auto start = std::chrono::steady_clock::now();
  for (bool done = this->over(0.0); !done;)
  {
    const double speed = state_.velocity.norm() + state_.spin.norm() * block_.radius();
    const auto reachOf = [&](double h)
    { return 1.5 * speed * h + parameters_.gravity * h * h + 1e-6 * block_.radius(); };
    placed_.place(block_, state_);
    const bool touched =
      std::any_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.closed(); });
    double h = this->longStep();
    bool lasting = false;
    // A long step is looked at in flight, and where what carries is at rest along its normal.
    if (!touched || this->isCalm())
    {
      this->findContacts(reachOf(h));
      lasting = this->mayLast(h);
    }
    if (!lasting && (touched || !contacts_.empty()))
    {
      h = this->impactStep();
      std::erase_if(contacts_, [](const Contact& c) { return !c.closed(); });
      this->findContacts(reachOf(h));
    }
    const double time = state_.time;
    this->takeStep(h, lasting);
    done = this->over(state_.time - time);
  }
  result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result_.unknowns = system_.unknowns();
  result_.blocks = int(system_.slope().blocks.size());

  recorder_.end(state_, springEnergy_ > 0.0);
  summary.stop = state_.position;
  summary.endTime = state_.time;
  summary.runOut = (state_.position - summary.start).head<2>().norm();
  summary.openCloseIterations = result_.solutions;
  EnergyAudit& e = summary.energy;
  e.kinetic = kineticEnergy(block_, state_);
  e.strain = strainEnergy(block_, state_) + springEnergy_ + system_.slopeEnergy();
  e.released = before - block_.mass() * parameters_.gravity * state_.position.z();
  e.numerical = e.released - (e.kinetic + e.strain + e.friction + e.vibration + e.damping);
  result_.trajectory = std::move(recorder_.trajectory());
  return std::move(result_);
}

} // namespace

BlockSlopeRun simulateOnBlockSlope(const Terrain& terrain, const Rock& rock,
  const SimulationParameters& parameters, SlopeModel model, double depth)
{
  parameters.validate();
  rock.validate();
  if (terrain.cfeAt(rock.position.x(), rock.position.y()) == 0)
  {
    throw PlacementError("block " + std::to_string(rock.blockId) + " is not over the slope");
  }
  const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
  const Surface surface(terrain, parameters.seed, 0);
  SlopeBlockMaterial material;
  material.density = rock.density;
  material.youngModulus = rock.youngModulus;
  material.poissonRatio = rock.poissonRatio;
  material.depth = depth;
  return BlockSlopeSimulator(
    surface, rock, block, parameters, makeSlopeBlocks(surface, model, material))
    .run();
}

} // namespace rockfall
