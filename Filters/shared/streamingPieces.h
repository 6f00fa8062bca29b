#pragma once

/// @file
/// Parallel runs: which of the ranks has the work.

class vtkInformation;
class vtkInformationVector;

namespace rockfall::filters
{

/// True where another piece than the first is asked for, as on every rank of a parallel run but the
/// first. Sources leave these pieces empty, and a run is computed by the first rank alone: there a
/// filter's outputs stay empty, which is no error.
bool isFurtherPiece(vtkInformationVector* outputs);

/// True on every rank of a parallel run but the first.
bool isFurtherRank();

/// Asks an input for the piece of this rank: writers would ask for all of it, on every rank.
void requestOwnPiece(vtkInformation* input);

} // namespace rockfall::filters
