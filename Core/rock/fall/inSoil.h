#pragma once

/// @file
/// A rock in ground that yields (SoilUnderRock): when its hard surface Λ moves, and flight over it.

namespace rockfall
{

struct Fall;

/// Λ sinks under what comes down within a step of `h` (s), or rises with the rock. Whether it did:
/// contacts and candidates are then out of date.
bool followScar(Fall& fall, double h);
void closeScar(Fall& fall); ///< The rock is out of the ground.
/// The rock goes on through soil, over nothing but slope and far from Λ for steps of `small` (s).
/// Whether anything was done.
bool flyOverScar(Fall& fall, double small);
void flyThroughSoil(Fall& fall, double duration); ///< As free flight, braked.
void yieldInStep(Fall& fall, double h);           ///< After a step of contact of `h` (s).

} // namespace rockfall
