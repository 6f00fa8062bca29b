#pragma once

/// @file
/// What Barrier Design tells beside its tables.

#include "results/designTables.h"

#include <string>
#include <vector>

namespace rockfall::filters
{

/// The note on sources of one number in several runs.
std::vector<std::string> sourceNotes(const std::vector<DesignLine>& lines);

/// Notes on rocks that pass together and differ in their frequencies, and on all that were
/// `released`.
std::vector<std::string> frequencyNotes(
  const std::vector<DesignLine>& lines, const FrequencyRange& released);

/// Notes on design values that are not what one may think: energies of a design mass below those of
/// the rocks, energies above the last class, tables that the factors are not in.
std::vector<std::string> factorNotes(
  const std::vector<DesignLine>& lines, const PartialFactors& factors);

} // namespace rockfall::filters
