#pragma once

/// @file
/// Inputs that come by pipeline: made one polydata and looked at once, before any filter uses it.
///
/// A reader of the file formats of others checks little, and a filter may be fed by any code: cells
/// that point at points which are not there, arrays shorter than what they belong to, NaN for the
/// number of a block. Composite data (Group Datasets, multi-block files, partitioned data sets) are
/// taken as if their parts had been appended, but rocks, which are one polydata or one part.
/// Unstructured grids of points, lines and polygons are taken as polydata.

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

class vtkDataObject;
class vtkFieldData;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace rockfall::filters
{

/// Role of an input, which decides what its arrays must hold.
enum class InputKind
{
  Terrain,
  Rocks,
  Trajectories, ///< "The Input"
  Lines,        ///< To be drawn across trajectories.
  Shape,        ///< Of a rock or a rock mass.
  Crossings,    ///< Of a collector: "The Input's part 1".
  Any,          ///< "The Input", of which arrays need hold nothing.
};

constexpr const char* kShapeInput = "The Shape input"; ///< Its name in messages.

/// Lets a port take polydata and unstructured grids, by themselves or in composite data, which come
/// in one piece then instead of leaf by leaf.
void acceptPolyData(vtkInformation* port);

/// The latest change of a data object, and of the parts of composite data.
vtkMTimeType timeOf(vtkDataObject* data);

/// An input of a filter, taken again only if it has changed.
class Input
{
public:
  /// `number` is that of a repeated input, from 1; 0 if there is one only.
  explicit Input(InputKind kind, int number = 0)
    : kind_(kind)
    , number_(number)
  {
  }

  /// Takes what is connected; null if nothing is. Never throws: ranks have to agree first. Is there
  /// a problem, what is returned can be asked for its cells and field data all the same: it is
  /// empty.
  vtkPolyData* take(vtkInformationVector* connections, int connection = 0);
  vtkPolyData* take(vtkDataObject* data);

  /// Message of what is wrong with the input, without an end; empty if nothing is.
  const std::string& problem() const { return problem_; }
  /// Throws DataError if there is a problem.
  void require() const;

private:
  std::string name() const;

  InputKind kind_;
  int number_;
  vtkDataObject* data_ = nullptr;     ///< The one that was taken ...
  vtkMTimeType time_ = 0;             ///< ... as it was then.
  vtkSmartPointer<vtkPolyData> made_; ///< Of parts, or in the place of what is damaged.
  std::string problem_;
};

/// Throws DataError, beginning with `name` ("The Rocks input"), unless every cell is of points that
/// are there and finite, every array has a tuple for each, and those of this kind hold what they
/// must.
void checkPolyData(vtkPolyData* data, InputKind kind, const std::string& name);

/// Throws ParameterError if a property has more than 100 values, of which each makes arrays or rows.
void requireFew(std::size_t values, const char* property);

/// The points of a property's list of coordinates: ParaView would hand on whole threes only, without
/// a word of what is left over. Throws ParameterError where it is.
std::vector<std::array<double, 3>> drawnPoints(const std::vector<double>& coordinates);

/// Throws DataError unless each array has a tuple for each of `count` points or cells (`of`).
void checkTuples(vtkFieldData* data, vtkIdType count, const std::string& name, const char* of);

/// The parts of composite data that are not empty; of other data they themselves, of null none.
std::vector<vtkDataObject*> leavesOf(vtkDataObject* data);

/// The image that it is, or that its parts have one of; null if it is null. Throws DataError,
/// beginning with `name`, if there are several or other parts.
vtkImageData* oneImage(vtkDataObject* data, const std::string& name);

/// An unstructured grid's cells in the order that polydata have: points, lines, polygons. Throws
/// DataError, beginning with `name`, if there are others.
vtkSmartPointer<vtkPolyData> polyDataOf(vtkUnstructuredGrid* grid, const std::string& name);

/// The parts of composite data as one. Throws DataError, beginning with `name`, if they are not
/// alike. `data` may be a polydata or an unstructured grid itself.
vtkSmartPointer<vtkPolyData> onePolyData(
  vtkDataObject* data, InputKind kind, const std::string& name);

} // namespace rockfall::filters
