#include "rock/parameters.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "law/settings.h"
#include "rock/rockContacts.h"

#include <cmath>
#include <limits>
#include <string>

namespace rockfall
{

void Fragmentation::validate() const
{
  const auto require = [](bool good, double value, const char* field, const char* wanted)
  {
    if (!good || !std::isfinite(value))
    {
      throw ParameterError(std::string(field) + " is " + numberText(value) + wanted);
    }
  };
  const char* const share = ", it must be 0 to 1";
  require(this->energy >= 0.0, this->energy, "FragmentationEnergy",
    " J/m³, it must be finite and not negative");
  require(this->fractalDimension >= 0.0 && this->fractalDimension <= 3.0, this->fractalDimension,
    "FractalDimension", ", it must be 0 to 3");
  require(this->leastVolume >= 0.0, this->leastVolume, "LeastFragment",
    " m³, it must be finite and not negative");
  require(this->survival >= 0.0 && this->survival <= 1.0, this->survival, "SurvivalRate", share);
  require(this->loss >= 0.0 && this->loss <= 1.0, this->loss, "FragmentationLoss", share);
  require(this->spread >= 0.0 && this->spread <= radians(90.0), degrees(this->spread),
    "FragmentSpread", "°, it must be 0 to 90");
  if (this->on) // Three have no default: 0 says that nothing is typed.
  {
    require(this->energy > 0.0, this->energy, "FragmentationEnergy",
      " J/m³, with Fragmentation it must be positive");
    require(this->fractalDimension > 0.0 && this->fractalDimension < 3.0, this->fractalDimension,
      "FractalDimension", ", with Fragmentation it must be more than 0 and less than 3");
    require(this->leastVolume >= kLeastVolume, this->leastVolume, "LeastFragment",
      " m³, with Fragmentation it must be at least 1e-9 m³, the volume of the smallest piece to be "
      "followed");
  }
}

void SimulationParameters::validate() const
{
  const auto positive = [](double value, const char* field, const char* unit)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(std::string(field) + " is " + numberText(value) +
        ", it must be a positive, finite number of " + unit);
    }
  };
  const auto atLeast = [](auto value, auto least, const char* field)
  {
    if (!(value >= least))
    {
      throw ParameterError(std::string(field) + " is " + numberText(value) +
        ", it must be at least " + numberText(least));
    }
  };
  const auto atMost = [](double value, double most, const char* field, const char* unit)
  {
    if (value > most)
    {
      throw ParameterError(std::string(field) + " is " + numberText(value) + unit +
        ", it must be at most " + numberText(most));
    }
  };
  positive(this->timeStep, "TimeStep", "seconds");
  if (this->timeStep < kLeastTimeStep)
  {
    throw ParameterError("TimeStep is " + numberText(this->timeStep) + " s, it must be at least " +
      numberText(kLeastTimeStep) + " s: no run of such steps ends");
  }
  if (this->timeStep > kMostTimeStep)
  {
    throw ParameterError("TimeStep is " + numberText(this->timeStep) + " s, it must be at most " +
      numberText(kMostTimeStep) + " s: is it in milliseconds?");
  }
  positive(this->endTime, "EndTime", "seconds");
  atMost(this->endTime, kMostEndTime, "EndTime", " s");
  positive(this->outputInterval, "OutputInterval", "seconds");
  if (!(this->normalPenalty >= 0.0) || !std::isfinite(this->normalPenalty))
  {
    throw ParameterError("NormalPenalty is " + numberText(this->normalPenalty) +
      " N/m, it must be finite and not negative (0: by mass)");
  }
  atMost(this->normalPenalty, kMostPenalty, "NormalPenalty", " N/m");
  positive(this->shearRatio, "ShearPenaltyRatio", "(no unit)");
  atMost(this->shearRatio, kMostShearRatio, "ShearPenaltyRatio", "");
  if (!(this->rockRestitution >= 0.0 && this->rockRestitution <= 1.0))
  {
    throw ParameterError(
      "RockRestitution is " + numberText(this->rockRestitution) + ", it must be 0 to 1");
  }
  if (!(this->rockFrictionAngle >= 0.0 && this->rockFrictionAngle <= radians(89.0)))
  {
    throw ParameterError("RockFrictionAngle is " + numberText(degrees(this->rockFrictionAngle)) +
      "°, it must be 0 to 89");
  }
  if (!(this->rockCohesion >= 0.0) || !std::isfinite(this->rockCohesion))
  {
    throw ParameterError("RockCohesion is " + numberText(this->rockCohesion) +
      " N, it must be finite and not negative");
  }
  atMost(this->rockCohesion, kMostCohesion, "RockCohesion", " N");
  validateRockContacts(this->rockContactPairs);
  this->fragmentation.validate();
  if (this->fragmentation.on && this->rockRockContact)
  {
    throw ParameterError("Fragmentation and RockRockContact are both on: rocks that break fall "
                         "alone, one of the two must be 0");
  }
  if (!(this->gravity >= 0.0) || !std::isfinite(this->gravity))
  {
    throw ParameterError(
      "Gravity is " + numberText(this->gravity) + " m/s², it must be finite and not negative");
  }
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
