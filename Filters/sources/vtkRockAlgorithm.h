/**
 * @class   vtkRockAlgorithm
 * @brief   what all sources of rocks have
 *
 * Superclass of vtkRockBlockSource and vtkJointedRockMass. Input port 1, optional, is the terrain,
 * from vtkDEMToCFESource. Port 2, optional, is a shape: a surface, or points of which it is the
 * convex hull. Port 0 is not used: ParaView's Python connects whatever is active to the first input
 * of a proxy if none is named.
 *
 * All values are taken as they come and checked when the source runs, so that a bad one gives one
 * error that names it instead of being changed silently.
 */
#ifndef vtkRockAlgorithm_h
#define vtkRockAlgorithm_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

#include <string> // for names

namespace rockfall
{
namespace filters // VTK's wrappers read no nested name
{
class IdleProperties;
}
}

class ROCKFALLFILTERS_EXPORT vtkRockAlgorithm : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkRockAlgorithm, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Where the centroid is at release, in world coordinates, m; with PlaceOnGround only x and y
   * count. The default is some 2 m over the top of the bi-planar test slope.
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * Edge lengths of a box, or whole axes of an ellipsoid, along x, y and z in metres, positive.
   */
  vtkSetVector3Macro(Lengths, double);
  vtkGetVector3Macro(Lengths, double);
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
   * Kind of rock whose density, Young's modulus and Poisson's ratio are taken instead of the
   * properties: 0 (the default) none, then granite, gneiss, basalt, limestone, dolomite, sandstone,
   * shale.
   */
  vtkSetMacro(Material, int);
  vtkGetMacro(Material, int);
  ///@}

  ///@{
  /**
   * Name of the material where rocks hit each other (RockContactFile of
   * vtkRockfallSimulation). Empty (the default) takes the name of Material, if that is not 0.
   */
  vtkSetStdStringFromCharMacro(MaterialName);
  vtkGetCharFromStdStringMacro(MaterialName);
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
   * Whether what is given by Center stands over the ground, whatever its z: points, or a mass as a
   * whole. Default off.
   */
  vtkSetMacro(PlaceOnGround, bool);
  vtkGetMacro(PlaceOnGround, bool);
  vtkBooleanMacro(PlaceOnGround, bool);
  ///@}

  ///@{
  /**
   * Height over ground of the lowest part in m, not negative, of what has no z. Default 0.
   */
  vtkSetMacro(ReleaseHeight, double);
  vtkGetMacro(ReleaseHeight, double);
  ///@}

  ///@{
  /**
   * Number from which all that is drawn once is drawn, not negative. Default 1.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * More rocks than this are an error, at least 1.
   */
  vtkSetMacro(MaximumRocks, int);
  vtkGetMacro(MaximumRocks, int);
  ///@}

  ///@{
  /**
   * Name of sources that have none of their own. Empty (the default): "source" and the number.
   */
  vtkSetStdStringFromCharMacro(SourceName);
  vtkGetCharFromStdStringMacro(SourceName);
  ///@}

  ///@{
  /**
   * BlockId of the first block; the others follow. Sources that are to be appended need numbers of
   * their own. Default 1, so that a block has the number of its row.
   */
  vtkSetMacro(FirstBlockId, vtkIdType);
  vtkGetMacro(FirstBlockId, vtkIdType);
  ///@}

  vtkRockAlgorithm(const vtkRockAlgorithm&) = delete;
  void operator=(const vtkRockAlgorithm&) = delete;

protected:
  vtkRockAlgorithm();
  ~vtkRockAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /// Makes the blocks, or throws. `terrain` and `shape` are null where nothing is connected.
  virtual void MakeBlocks(vtkPolyData* terrain, vtkPolyData* shape, vtkPolyData* blocks) = 0;
  /// Throws ParameterError unless Seed is at least 0.
  void CheckSeed() const;
  /// Numbers that a Material replaces.
  void FindIdleOfMaterial(rockfall::filters::IdleProperties& idle) const;

  double Center[3] = { 5.0, 50.0, 58.0 };
  double Lengths[3] = { 1.0, 1.0, 1.0 };
  double Orientation[3] = { 0.0, 0.0, 0.0 };
  double Velocity[3] = { 0.0, 0.0, 0.0 };
  int Material = 0;
  std::string MaterialName;
  double Density = 2500.0;
  double YoungModulus = 1e10;
  double PoissonRatio = 0.1;
  bool PlaceOnGround = false;
  double ReleaseHeight = 0.0;
  int Seed = 1;
  int MaximumRocks = 1000000;
  std::string SourceName;
  vtkIdType FirstBlockId = 1;
};

#endif
