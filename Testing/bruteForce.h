#pragma once

/// @file
/// The entrance rules by brute force over all pairs, without pruning: the oracle of the search.

#include "contact/ground/detection.h"
#include "contact/ground/features.h"

namespace rockfall::testing
{

/// Admits every pair within `reach` (m).
inline void findEntrancesBruteForce(
  const PlacedBlock& rock, const SurfacePatch& patch, double reach, std::vector<Contact>& contacts)
{
  const Polyhedron& shape = rock.block().shape();
  const auto look = [&](const std::optional<Contact>& c)
  {
    if (c)
    {
      admit(patch, *c, contacts);
    }
  };
  for (int i = 0; i < int(patch.triangles.size()); ++i)
  {
    for (int v = 0; v < int(rock.vertices().size()) && patch.triangles[i].cfe != 0; ++v)
    {
      look(vertexFace(rock, v, patch, i, reach));
    }
  }
  for (int i = 0; i < int(patch.nodes.size()); ++i)
  {
    for (int f = 0; f < int(shape.faces().size()); ++f)
    {
      look(faceVertex(rock, f, patch, i, reach));
    }
  }
  for (int i = 0; i < int(patch.ridges.size()); ++i)
  {
    for (int e = 0; e < int(shape.edges().size()); ++e)
    {
      look(edgeEdge(rock, e, patch, i, reach));
    }
  }
}

} // namespace rockfall::testing
