#include "rock/parameters.h"

#include "base/require.h"
#include "law/settings.h"
#include "rock/rockContacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace rockfall
{

void Fragmentation::validate() const
{
  const auto check = [](bool good, double value, const char* field, const char* wanted)
  {
    if (!good || !std::isfinite(value))
    {
      throw ParameterError(std::string(field) + " is " + numberText(value) + wanted);
    }
  };
  const char* const share = ", it must be 0 to 1";
  check(this->energy >= 0.0, this->energy, "FragmentationEnergy",
    " J/m³, it must be finite and not negative");
  check(this->fractalDimension >= 0.0 && this->fractalDimension <= 3.0, this->fractalDimension,
    "FractalDimension", ", it must be 0 to 3");
  check(this->leastVolume >= 0.0, this->leastVolume, "LeastFragment",
    " m³, it must be finite and not negative");
  check(this->survival >= 0.0 && this->survival <= 1.0, this->survival, "SurvivalRate", share);
  check(this->loss >= 0.0 && this->loss <= 1.0, this->loss, "FragmentationLoss", share);
  check(this->spread >= 0.0 && this->spread <= radians(90.0), degrees(this->spread),
    "FragmentSpread", "°, it must be 0 to 90");
  if (this->on) // Three have no default: 0 says that nothing is typed.
  {
    check(this->energy > 0.0, this->energy, "FragmentationEnergy",
      " J/m³, with Fragmentation it must be positive");
    check(this->fractalDimension > 0.0 && this->fractalDimension < 3.0, this->fractalDimension,
      "FractalDimension", ", with Fragmentation it must be more than 0 and less than 3");
    check(this->leastVolume >= kLeastVolume, this->leastVolume, "LeastFragment",
      " m³, with Fragmentation it must be at least 1e-9 m³, the volume of the smallest piece to be "
      "followed");
  }
}

double SimulationParameters::penaltyFor(double mass) const
{
  const double ofLoneRock = kSlopeFrequency * kSlopeFrequency * mass;
  return std::max(this->pairPenalty(), this->normalPenalty == 0.0 ? ofLoneRock : 0.0);
}

double SimulationParameters::pairPenalty() const
{
  return this->normalPenalty > 0.0 ? this->normalPenalty : kPublishedPenalty;
}

void SimulationParameters::validate() const
{
  const auto positive = [](double value, const char* field, const char* unit)
  {
    require(value > 0.0 && std::isfinite(value), field, value, "",
      std::string("a positive, finite number of ") + unit);
  };
  const auto notNegative =
    [](double value, const char* field, const char* unit, const char* further = "")
  {
    require(value >= 0.0 && std::isfinite(value), field, value, unit,
      std::string("finite and not negative") + further);
  };
  const auto atLeast = [](double value, double least, const char* field)
  { require(value >= least, field, value, "", "at least " + numberText(least)); };
  const auto atMost = [](double value, double most, const char* field, const char* unit)
  { require(!(value > most), field, value, unit, "at most " + numberText(most)); };
  positive(this->timeStep, "TimeStep", "seconds");
  require(this->timeStep >= kLeastTimeStep, "TimeStep", this->timeStep, " s",
    "at least " + numberText(kLeastTimeStep) + " s: no run of such steps ends");
  require(this->timeStep <= kMostTimeStep, "TimeStep", this->timeStep, " s",
    "at most " + numberText(kMostTimeStep) + " s: is it in milliseconds?");
  positive(this->endTime, "EndTime", "seconds");
  atMost(this->endTime, kMostEndTime, "EndTime", " s");
  positive(this->outputInterval, "OutputInterval", "seconds");
  notNegative(this->normalPenalty, "NormalPenalty", " N/m", " (0: by mass)");
  atMost(this->normalPenalty, kMostPenalty, "NormalPenalty", " N/m");
  positive(this->shearRatio, "ShearPenaltyRatio", "(no unit)");
  atMost(this->shearRatio, kMostShearRatio, "ShearPenaltyRatio", "");
  require(this->rockRestitution >= 0.0 && this->rockRestitution <= 1.0, "RockRestitution",
    this->rockRestitution, "", "0 to 1");
  require(this->rockFrictionAngle >= 0.0 && this->rockFrictionAngle <= radians(89.0),
    "RockFrictionAngle", degrees(this->rockFrictionAngle), "°", "0 to 89");
  notNegative(this->rockCohesion, "RockCohesion", " N");
  atMost(this->rockCohesion, kMostCohesion, "RockCohesion", " N");
  validateRockContacts(this->rockContactPairs);
  this->fragmentation.validate();
  if (this->fragmentation.on && this->rockRockContact)
  {
    throw ParameterError("Fragmentation and RockRockContact are both on: rocks that break fall "
                         "alone, one of the two must be 0");
  }
  notNegative(this->gravity, "Gravity", " m/s²");
  atMost(this->gravity, kMostGravity, "Gravity", " m/s²");
  if (this->endTime / this->outputInterval > 1e7)
  {
    throw ParameterError("OutputInterval is " + numberText(this->outputInterval) +
      " s, which makes more than 10,000,000 samples in EndTime " + numberText(this->endTime) +
      " s");
  }
  atLeast(this->iterations, 1, "Iterations");
  if (this->iterations > kMostIterations)
  {
    throw ParameterError("Iterations is " + std::to_string(this->iterations) +
      ", it must be at most 10,000,000: more fit into runs of their own, each with its "
      "FirstIteration");
  }
  atLeast(this->firstIteration, 0, "FirstIteration");
  if (this->firstIteration > std::numeric_limits<int>::max() - this->iterations)
  {
    throw ParameterError("FirstIteration is " + std::to_string(this->firstIteration) + ", with " +
      std::to_string(this->iterations) + " Iterations it goes beyond 2,147,483,647");
  }
  atLeast(this->threads, 0, "NumberOfThreads");
  atMost(this->threads, kMostThreads, "NumberOfThreads", "");
  atLeast(this->maxOpenClose, 2, "MaximumOpenClose");
  atMost(this->maxOpenClose, kMostOpenClose, "MaximumOpenClose", "");
  atLeast(this->maxCuts, 0, "MaximumCuts");
  atMost(this->maxCuts, kMostCuts, "MaximumCuts", "");
}

} // namespace rockfall
