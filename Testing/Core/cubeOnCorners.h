#pragma once

/// @file
/// A cube on the four corners of its lower face, one of them a little higher: springs that hang
/// together.

#include "piles.h"

#include "solve/island/IslandSolver.h"

#include <vector>

namespace rockfall::testing
{

/// Not copied: bodies and contacts point into it.
struct CubeOnCorners
{
  Rock cube = brick(Vec3(1.0, 1.0, 1.0), Vec3(0.0, 0.0, 0.5), 0);
  Block block{ cube.shape, cube.density, cube.youngModulus, cube.poissonRatio };
  BlockState state;
  std::vector<Contact> corners{ 4 };
  std::vector<IslandContact> contacts{ 4 };
  std::vector<IslandBody> bodies{ 1 };
  IslandSolver solver; ///< Gauss–Seidel.

  CubeOnCorners()
  {
    state.position.z() = 0.5;
    for (int k = 0; k < 4; ++k)
    {
      Contact& c = corners[std::size_t(k)];
      c.point = Vec3(k % 2 - 0.5, k / 2 - 0.5, 0.0);
      c.distance = k == 0 ? 1e-5 : 0.0;
      c.stiffness = c.shearStiffness = 1e9;
      contacts[std::size_t(k)].contact = &c;
      contacts[std::size_t(k)].first = 0;
      contacts[std::size_t(k)].friction = 0.5;
    }
    bodies[0].block = &block;
    bodies[0].state = &state;
    solver.method = IslandMethod::Crowd;
  }
  CubeOnCorners(const CubeOnCorners&) = delete;
  CubeOnCorners& operator=(const CubeOnCorners&) = delete;

  IslandOutcome step(Accept accept)
  {
    return solver.step(lastingStep(0.005, kGravity, 12), bodies, contacts, accept);
  }
};

} // namespace rockfall::testing
