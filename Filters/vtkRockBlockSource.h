/**
 * @class   vtkRockBlockSource
 * @brief   makes rock blocks: one by properties, or one per row of a table of rockfall sources
 *
 * The output has the real polygonal faces of every block in world coordinates, in double precision.
 * Cell arrays: BlockId, and beside it the properties of the block, Density, Volume, YoungModulus,
 * PoissonRatio, Velocity, AngularVelocity and Shape (see rockFieldData.h).
 *
 * All values are taken as they come and checked when the source runs, so that a bad one gives one
 * error that names it instead of being changed silently.
 */
#ifndef vtkRockBlockSource_h
#define vtkRockBlockSource_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

#include <string> // for FileName

class ROCKFALLFILTERS_EXPORT vtkRockBlockSource : public vtkPolyDataAlgorithm
{
public:
  static vtkRockBlockSource* New();
  vtkTypeMacro(vtkRockBlockSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ShapeType
  {
    CUBE = 0,
    TETRAHEDRON = 1,
    OCTAHEDRON = 2,
    DODECAHEDRON = 3,
    ICOSAHEDRON = 4,
    BOX = 5,
    EOTA_111 = 6,
    EOTA_221 = 7,
    FROM_FILE = 8
  };

  ///@{
  /**
   * The shape, one of ShapeType. Default CUBE.
   */
  vtkSetMacro(Shape, int);
  vtkGetMacro(Shape, int);
  ///@}

  ///@{
  /**
   * Volume in m³, positive. A box has that of its Lengths instead. Default 1.
   */
  vtkSetMacro(Volume, double);
  vtkGetMacro(Volume, double);
  ///@}

  ///@{
  /**
   * Edge lengths of a box along x, y and z in metres, positive. Default 1, 1, 1.
   */
  vtkSetVector3Macro(Lengths, double);
  vtkGetVector3Macro(Lengths, double);
  ///@}

  ///@{
  /**
   * File of the shape FROM_FILE: points (.csv, .xyz, .txt) or a mesh (.vtp, .vtk, .stl, .ply,
   * .obj). A mesh must be closed with its faces outward.
   */
  vtkSetStdStringFromCharMacro(ShapeFileName);
  vtkGetCharFromStdStringMacro(ShapeFileName);
  ///@}

  enum ShapeFileModeType
  {
    CONVEX_HULL = 0,
    AS_IT_IS = 1
  };

  ///@{
  /**
   * What is taken of a mesh file: its convex hull (the default), or its faces as they are, which
   * must then be those of a convex polyhedron.
   */
  vtkSetMacro(ShapeFileMode, int);
  vtkGetMacro(ShapeFileMode, int);
  ///@}

  ///@{
  /**
   * Whether a shape from a file is scaled to Volume (the default) or keeps its size.
   */
  vtkSetMacro(ScaleToVolume, bool);
  vtkGetMacro(ScaleToVolume, bool);
  vtkBooleanMacro(ScaleToVolume, bool);
  ///@}

  ///@{
  /**
   * Where the centroid is at release, in world coordinates, m. The default is some 2 m over the top
   * of the bi-planar test slope.
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * Angles in degrees about x, y and z, applied in the order of vtkTransform's RotateZ, RotateX,
   * RotateY. Default 0, 0, 0.
   */
  vtkSetVector3Macro(Orientation, double);
  vtkGetVector3Macro(Orientation, double);
  ///@}

  ///@{
  /**
   * Velocity at release, m/s. Default 0, 0, 0.
   */
  vtkSetVector3Macro(Velocity, double);
  vtkGetVector3Macro(Velocity, double);
  ///@}

  ///@{
  /**
   * Angular velocity at release about the world's x, y and z, rad/s. Default 0, 0, 0.
   */
  vtkSetVector3Macro(AngularVelocity, double);
  vtkGetVector3Macro(AngularVelocity, double);
  ///@}

  ///@{
  /**
   * Density in kg/m³, positive. Default 2500.
   */
  vtkSetMacro(Density, double);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * Young's modulus in Pa, positive. Default 1e10.
   */
  vtkSetMacro(YoungModulus, double);
  vtkGetMacro(YoungModulus, double);
  ///@}

  ///@{
  /**
   * Poisson's ratio, 0 to 0.49, dimensionless. Default 0.1.
   */
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * Rockfall sources: a point layer of any kind that OGR opens, or a CSV table with columns x, y,
   * z. One block per row; what a row does not say (columns shape, volume, density, vx, vy, vz, wx,
   * wy, wz, rx, ry, rz, lx, ly, lz) is as the properties say. Empty (the default): one block by the
   * properties alone.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Coordinate system of the slope, as WKT or "EPSG:n": the points of a layer in another one are
   * brought to it. Empty (the default): they are taken as they are. The output says in its field
   * array TerrainCRS in which one it is, if that is known.
   */
  vtkSetStdStringFromCharMacro(TargetCRS);
  vtkGetCharFromStdStringMacro(TargetCRS);
  ///@}

  ///@{
  /**
   * BlockId of the first block; the others follow. Sources that are to be appended need numbers of
   * their own. Default 1, so that a block has the number of its row.
   */
  vtkSetMacro(FirstBlockId, vtkIdType);
  vtkGetMacro(FirstBlockId, vtkIdType);
  ///@}

  vtkRockBlockSource(const vtkRockBlockSource&) = delete;
  void operator=(const vtkRockBlockSource&) = delete;

protected:
  vtkRockBlockSource();
  ~vtkRockBlockSource() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  int Shape = CUBE;
  double Volume = 1.0;
  double Lengths[3] = { 1.0, 1.0, 1.0 };
  std::string ShapeFileName;
  int ShapeFileMode = CONVEX_HULL;
  bool ScaleToVolume = true;
  double Center[3] = { 5.0, 50.0, 58.0 };
  double Orientation[3] = { 0.0, 0.0, 0.0 };
  double Velocity[3] = { 0.0, 0.0, 0.0 };
  double AngularVelocity[3] = { 0.0, 0.0, 0.0 };
  double Density = 2500.0;
  double YoungModulus = 1e10;
  double PoissonRatio = 0.1;
  std::string FileName;
  std::string TargetCRS;
  vtkIdType FirstBlockId = 1;
};

#endif
