#pragma once

/// @file
/// How deep rocks are in each other, by looking at all pairs.

#include "contact/pairs.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace rockfall::testing
{

/// The deepest overlap of two of `count` rocks, m: number i is blockOf(i), at stateOf(i).
template <class BlockOf, class StateOf>
double deepestOverlap(int count, BlockOf&& blockOf, StateOf&& stateOf)
{
  std::vector<PlacedBlock> placed(count);
  std::vector<PairBody> bodies(count);
  std::vector<int> byX(count);
  std::iota(byX.begin(), byX.end(), 0);
  double largest = 0.0;
  for (int i = 0; i < count; ++i)
  {
    placed[i].place(blockOf(i), stateOf(i));
    bodies[i].update(placed[i]);
    largest = std::max(largest, bodies[i].radius);
  }
  std::sort(byX.begin(), byX.end(),
    [&](int i, int j) { return bodies[i].position.x() < bodies[j].position.x(); });
  double deepest = 0.0;
  for (int a = 0; a < count; ++a)
  {
    for (int b = a + 1; b < count; ++b)
    {
      const PairBody& first = bodies[std::min(byX[a], byX[b])];
      const PairBody& second = bodies[std::max(byX[a], byX[b])];
      if (bodies[byX[b]].position.x() - bodies[byX[a]].position.x() > 2.0 * largest)
      {
        break;
      }
      if ((first.position - second.position).norm() < first.radius + second.radius)
      {
        // Apart they may be told quickly; how deep needs the best axis of all.
        if (findAxis(first, second, {}, 0.0).distance < 0.0)
        {
          deepest = std::max(deepest, -bestAxis(first, second).distance);
        }
      }
    }
  }
  return deepest;
}

} // namespace rockfall::testing
