#pragma once

/// @file
/// How rocks travel through the pipeline: polygons with the block's properties beside them.
///
/// | array           | on    | what                                                    |
/// |-----------------|-------|---------------------------------------------------------|
/// | BlockId         | cells | the polygons of one block have one number               |
/// | Density         | cells | kg/m³                                                   |
/// | Volume          | cells | m³                                                      |
/// | YoungModulus    | cells | Pa                                                      |
/// | PoissonRatio    | cells |                                                         |
/// | Material        | cells | its name, for contacts of rocks; empty: none            |
/// | Velocity        | cells | at release, m/s                                         |
/// | AngularVelocity | cells | at release, about the world's axes, rad/s               |
/// | Shape           | cells | number of the shape as in the rock source               |
/// | ShapeName       | field | names of all shapes, that of shape n at place n         |
/// | SourceId        | cells | number of the source that the block is of               |
/// | SourceName      | cells | its name                                                |
/// | Frequency       | cells | how often it falls, 1/a; not there if it is not known   |
///
/// and what is drawn in each iteration (ReleaseUncertainty):
///
/// | array             | on    | what                                                           |
/// |-------------------|-------|----------------------------------------------------------------|
/// | PositionDeviation | cells | horizontal and vertical standard deviation, m                  |
/// | AttitudeLaw       | cells | 0 as given, 1 any rotation, 2 deviating                        |
/// | AttitudeDeviation | cells | standard deviation of the angle about each axis, degrees       |
/// | VolumeLaw         | cells | 0 as it is, else the law by which it is drawn                  |
/// | VolumeParameters  | cells | mean, deviation, minimum, maximum (m³) and exponent of the law |
///
/// Every cell of a block repeats the block's values, so that any of VTK's filters can cut, move and
/// append rocks and they stay whole.
///
/// Rocks that move in time have no text on cells: VTK's temporal interpolator takes each cell array
/// for numbers and ends the program. Their names are in field arrays, one entry per block:
///
/// | array      | on    | what                                   |
/// |------------|-------|----------------------------------------|
/// | NamedBlock | field | BlockId of the block named there       |
/// | Material   | field | as above                               |
/// | SourceName | field | as above                               |

#include "geometry/shapes.h"
#include "rock/Rock.h"

#include "vtkSmartPointer.h" // for arrays

#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

class vtkCellArray;
class vtkFieldData;
class vtkIdTypeArray;
class vtkPoints;
class vtkPolyData;
class vtkStringArray;

namespace rockfall::filters
{

/// A rock to be released, with the name of what it is like.
struct ReleasedRock
{
  Rock rock;
  Shape shape = Shape::File;
  std::int64_t sourceId = 0;
  std::string sourceName;
  /// How often it falls, 1/a; NaN if it is not known.
  double frequency = std::numeric_limits<double>::quiet_NaN();
  int state = -1; ///< MotionState in which a simulation left it; −1: it comes from none.
};

/// Appends the faces of a block, placed with x ↦ rotation · x + shift.
void appendFaces(const Polyhedron& shape, const Mat3& rotation, const Vec3& shift,
  vtkPoints* points, vtkCellArray* polygons);

/// Writes rocks, their positions being world coordinates.
void writeRocks(std::span<const ReleasedRock> rocks, vtkPolyData* output);

/// Names of blocks, in field data.
class BlockNames
{
public:
  /// Adds the arrays to `field`.
  explicit BlockNames(vtkFieldData* field);
  ~BlockNames();

  void append(const Rock& rock, const std::string& sourceName);

private:
  vtkSmartPointer<vtkIdTypeArray> block_;
  vtkSmartPointer<vtkStringArray> material_, sourceName_;
};

/// Blocks of the field array NamedBlock; empty if it is not there.
std::set<std::int64_t> namedBlocks(vtkPolyData* input);

/// Reads rocks from polygons; `origin` is taken off the world coordinates first. Polydata without
/// BlockId is one block; properties without an array have their defaults. Throws DataError or
/// GeometryError, naming the block, DataError also for points of single precision that are rounded
/// by more than a thousandth of the block. Blocks of a simulation's output have a `state`.
std::vector<ReleasedRock> readRocks(vtkPolyData* input, const Vec3& origin);

} // namespace rockfall::filters
