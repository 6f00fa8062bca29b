#pragma once

/// @file
/// The properties of a run in words, to compare runs by.

#include "rock/parameters.h"

#include <string>

namespace rockfall
{

/// The properties that decide how a rock moves, one a line: "TimeStep 0.005 s". Those of rocks that
/// hit each other, or break, only if they do.
std::string statementOf(const SimulationParameters& parameters);

} // namespace rockfall
