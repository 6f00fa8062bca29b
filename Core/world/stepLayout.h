#pragma once

/// @file
/// Facts of all rocks and pairs of an island that come before the loops over each of them.

#include "world/IslandWork.h"

#include <cstddef>

namespace rockfall
{

/// Rocks, pairs or contacts that are counted together.
constexpr std::size_t kPartSize = 128;

inline std::size_t partsOf(std::size_t count)
{
  return (count + kPartSize - 1) / kPartSize;
}

/// Gives rocks, pairs and contacts their places in the system; returns how many rocks have one.
std::size_t layOut(WorldState& world, const Island& island, IslandWork& work);

/// Speeds that the rocks of an island may add to each other's within a step.
void findPushes(const Island& island, IslandWork& work);

} // namespace rockfall
