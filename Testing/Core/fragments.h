#pragma once

/// @file
/// A cube over flat ground that may break.

#include "rock/fragmentation.h"
#include "slopes.h"

#include <gtest/gtest.h>

#include <vector>

namespace rockfall::testing
{

constexpr double kDensity = 2500.0; // kg/m³

inline Fragmentation lawOf(double energy, double leastVolume, double dimension = 2.0)
{
  Fragmentation law;
  law.on = true;
  law.energy = energy;
  law.leastVolume = leastVolume;
  law.fractalDimension = dimension;
  return law;
}

inline Terrain flatGround(double restitution = 0.6)
{
  return makeSlope(
    41, 5.0, [](double, double) { return 0.0; }, material(restitution, 30.0));
}

/// A cube of 1 m³ whose lower face is `height` over flat ground.
inline Rock dropped(double height)
{
  Rock rock;
  rock.blockId = 7;
  rock.shape = makeShape(Shape::Cube, 1.0);
  rock.density = kDensity;
  rock.position = Vec3(100.0, 100.0, height + 0.5);
  return rock;
}

inline std::vector<Trajectory> runOf(const Terrain& slope, const std::vector<Rock>& rocks,
  const Fragmentation& law, int iterations = 1, int threads = 1,
  ImpactResolution resolution = ImpactResolution::Springs)
{
  SimulationParameters p;
  p.fragmentation = law;
  p.iterations = iterations;
  p.threads = threads;
  p.endTime = 20.0;
  p.impactResolution = resolution;
  TrajectoryStore store;
  EXPECT_TRUE(runEnsemble(slope, rocks, p, store));
  return store.take();
}

inline double sumOf(const EnergyAudit& e)
{
  return e.kinetic + e.strain + e.friction + e.restitution + e.vibration + e.damping +
    e.structures + e.scars + e.rolling + e.breaking + e.exchanged + e.numerical;
}

} // namespace rockfall::testing
