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
    , body_(block)
    , recorder_(surface, block, p)
  {
    body_.state.position = rock.position;
    body_.state.orientation = rock.orientation.normalized();
    body_.state.velocity = rock.velocity;
    body_.state.spin = body_.state.orientation.conjugate() * rock.angularVelocity;
    body_.restingSpeed = kRestingSpeed * std::sqrt(std::max(p.gravity, 1e-3) * block.radius());
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
  RockBody body_;
  Recorder recorder_;
  BlockSlopeRun result_;
  std::vector<int> carriers_; ///< Features of the rock that carried in the last lasting step.
};

double BlockSlopeSimulator::longStep() const
{
  const double rim = body_.state.spin.norm() * block_.radius();
  const double speed =
    body_.state.velocity.norm() + rim + parameters_.gravity * parameters_.timeStep;
  const double travel = speed > 0.0 ? kTravelPerStep * block_.radius() / speed : 1e300;
  return std::max(
    std::min({ parameters_.timeStep, travel, parameters_.endTime - body_.state.time }), 1e-12);
}

double BlockSlopeSimulator::impactStep() const
{
  const double frequency = std::sqrt(parameters_.pairPenalty() * block_.largestMobility());
  return std::min(this->longStep(), std::numbers::pi / (kBlockStepsPerImpact * frequency));
}

double BlockSlopeSimulator::energy() const
{
  return kineticEnergy(block_, body_.state) + strainEnergy(block_, body_.state) +
    body_.springEnergy + system_.slopeEnergy() +
    block_.mass() * parameters_.gravity * body_.state.position.z();
}

/// Against every block of the slope.
void BlockSlopeSimulator::findContacts(double reach)
{
  gatherCandidates(body_.placed, body_.state, patch_, reach, candidates_);
  updateContacts(body_.placed, patch_, candidates_, reach, body_.contacts);
}

bool BlockSlopeSimulator::isCalm() const
{
  const double settled = body_.restingSpeed +
    4.0 * parameters_.gravity * std::sqrt(block_.mass() / parameters_.pairPenalty());
  const Vec3 spin = body_.state.angularVelocity();
  return body_.normalEnergy <= 0.5 * block_.mass() * settled * settled &&
    std::all_of(body_.contacts.begin(), body_.contacts.end(),
      [&](const Contact& c)
      {
        const Vec3 v = body_.state.velocity + spin.cross(c.point - body_.state.position);
        return !c.closed() || std::abs(c.normal.dot(v)) <= body_.restingSpeed;
      });
}

bool BlockSlopeSimulator::mayLast(double h) const
{
  bool any = false;
  const Vec3 spin = body_.state.angularVelocity();
  for (const Contact& c : body_.contacts)
  {
    const Vec3 v = body_.state.velocity + spin.cross(c.point - body_.state.position);
    const double approach = -c.normal.dot(v), gap = system_.gap(c);
    if (!c.closed() && approach > body_.restingSpeed && gap < approach * h)
    {
      return false;
    }
    const bool still = std::abs(approach) <= body_.restingSpeed;
    any = any || c.closed() || (still && gap <= 0.5 * parameters_.gravity * h * h);
  }
  return any;
}

void BlockSlopeSimulator::takeStep(double h, bool lasting)
{
  const BlockState before = body_.state;
  const double energyBefore = this->energy();
  SystemRequest request;
  request.duration = h;
  request.lasting = lasting;
  request.gravity = parameters_.gravity;
  request.normalPenalty = parameters_.pairPenalty();
  request.shearPenalty = parameters_.pairPenalty() * parameters_.shearRatio;
  request.friction = surface_.friction();
  request.cohesion = surface_.cohesion();
  request.maxOpenClose = parameters_.maxOpenClose;
  request.acceleration = body_.acceleration;
  request.spinAcceleration = body_.spinAcceleration;
  TrajectorySummary& summary = recorder_.trajectory().summary;
  SystemOutcome outcome;
  for (int cut = 0; !outcome.settled; ++cut)
  {
    const bool last = cut >= parameters_.maxCuts;
    outcome = system_.step(request, body_.contacts, body_.state, last);
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
  body_.springEnergy = outcome.springEnergy;
  body_.normalEnergy = outcome.normalEnergy;
  body_.energy.friction += outcome.frictionWork;

  std::vector<int> carriers;
  for (const Contact& c : body_.contacts)
  {
    if (c.closed())
    {
      carriers.push_back(4 * c.rockFeature + int(c.kind));
    }
  }
  summary.contactSteps += carriers.empty() ? 0 : 1;
  // The lag of the next lasting step, as long as the same features carry.
  body_.acceleration.setZero();
  body_.spinAcceleration.setZero();
  if (lasting)
  {
    body_.energy.damping += energyBefore - this->energy() - outcome.frictionWork;
    const double bound = 3.0 * parameters_.gravity;
    const Vec3 a = (body_.state.velocity - before.velocity) / request.duration;
    const Vec3 b = (body_.state.spin - before.spin) / request.duration;
    if (carriers == carriers_ && a.norm() <= bound && b.norm() * block_.radius() <= bound)
    {
      body_.acceleration = a;
      body_.spinAcceleration = b;
    }
  }
  recorder_.recordBetween(body_, before, body_.state, !carriers.empty());
  recorder_.follow(body_.state);
  if (carriers.empty())
  {
    body_.energy.vibration += relaxStrain(block_, body_.state) + system_.settleSlope();
  }
  carriers_ = lasting ? carriers : std::vector<int>();
}

bool BlockSlopeSimulator::over(double h)
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  const Vec3& p = body_.state.position;
  const double speed = body_.state.velocity.norm() + body_.state.spin.norm() * block_.radius();
  const double still =
    kStillSpeed * std::sqrt(std::max(parameters_.gravity, 1e-3) * block_.radius());
  body_.quietTime = body_.springEnergy > 0.0 && speed < still ? body_.quietTime + h : 0.0;
  if (surface_.terrain().cfeAt(p.x(), p.y()) == 0)
  {
    summary.fate = Fate::LeftDomain;
    return true;
  }
  summary.fate = body_.quietTime >= kStillTime ? Fate::Rested : Fate::Moving;
  return summary.fate == Fate::Rested || body_.state.time >= parameters_.endTime - 1e-9;
}

BlockSlopeRun BlockSlopeSimulator::run()
{
  TrajectorySummary& summary = recorder_.trajectory().summary;
  summary.mass = block_.mass();
  summary.volume = block_.volume();
  recorder_.begin(body_);
  const auto start = std::chrono::steady_clock::now();
  for (bool done = this->over(0.0); !done;)
  {
    const double speed = body_.state.velocity.norm() + body_.state.spin.norm() * block_.radius();
    const auto reachOf = [&](double h)
    { return 1.5 * speed * h + parameters_.gravity * h * h + 1e-6 * block_.radius(); };
    body_.placed.place(block_, body_.state);
    const bool touched = std::any_of(
      body_.contacts.begin(), body_.contacts.end(), [](const Contact& c) { return c.closed(); });
    double h = this->longStep();
    bool lasting = false;
    // A long step is looked at in flight, and where what carries is at rest along its normal.
    if (!touched || this->isCalm())
    {
      this->findContacts(reachOf(h));
      lasting = this->mayLast(h);
    }
    if (!lasting && (touched || !body_.contacts.empty()))
    {
      h = this->impactStep();
      std::erase_if(body_.contacts, [](const Contact& c) { return !c.closed(); });
      this->findContacts(reachOf(h));
    }
    const double time = body_.state.time;
    this->takeStep(h, lasting);
    done = this->over(body_.state.time - time);
  }
  result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result_.unknowns = system_.unknowns();
  result_.blocks = int(system_.slope().blocks.size());

  recorder_.end(body_, body_.springEnergy > 0.0);
  summary.openCloseIterations = result_.solutions;
  const double slope = system_.slopeEnergy();
  summary.energy.strain += slope;
  summary.energy.numerical -= slope;
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
