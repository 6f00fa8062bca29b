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

/// Where a request passes update extents on, asks the inputs of these ports for the piece of this
/// rank: writers would ask for all of it, on every rank.
void requestOwnPieces(vtkInformation* request, vtkInformationVector** inputs, int ports);

} // namespace rockfall::filters
