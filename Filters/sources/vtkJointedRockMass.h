/**
 * @class   vtkJointedRockMass
 * @brief   cuts a rock mass by joint sets into the blocks that fall
 *
 * Input port 1, optional, is the terrain, from vtkDEMToCFESource: the mass can then be set down on
 * the ground. Port 2, optional, is the mass FROM_FILE. Port 0 is not used: ParaView's Python connects whatever is active to the first input
 * of a proxy if none is named.
 *
 * A box or a closed convex surface is cut by planes right through (persistence 1): Shi's block
 * cutting of a mass without joints that end in it. The output is that of vtkRockBlockSource: the
 * faces of every block in world coordinates, with the block's properties as cell arrays. Field
 * arrays SliverCount and SliverVolume tell what was left out or kept of blocks that are too thin or
 * too small.
 *
 * All values are taken as they come and checked when the source runs, so that a bad one gives one
 * error that names it instead of being changed silently.
 */
#ifndef vtkJointedRockMass_h
#define vtkJointedRockMass_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

#include <array>  // for a joint set's numbers
#include <string> // for file names
#include <vector> // for JointSets

class ROCKFALLFILTERS_EXPORT vtkJointedRockMass : public vtkPolyDataAlgorithm
{
public:
  static vtkJointedRockMass* New();
  vtkTypeMacro(vtkJointedRockMass, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum MassShapeType
  {
    BOX = 0,
    FROM_FILE = 1
  };

  ///@{
  /**
   * The mass, one of MassShapeType. Default BOX.
   */
  vtkSetMacro(MassShape, int);
  vtkGetMacro(MassShape, int);
  ///@}

  ///@{
  /**
   * Centroid of the box in world coordinates, m; of PlaceOnGround only x and y count. Default 5,
   * 50, 58.
   */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * Edge lengths of the box along its x, y and z in metres, positive. Default 3, 3, 3.
   */
  vtkSetVector3Macro(Lengths, double);
  vtkGetVector3Macro(Lengths, double);
  ///@}

  ///@{
  /**
   * Angles of the box in degrees about x, y and z, as those of vtkRockBlockSource. The joints do
   * not turn with it. Default 0, 0, 0.
   */
  vtkSetVector3Macro(Orientation, double);
  vtkGetVector3Macro(Orientation, double);
  ///@}

  ///@{
  /**
   * Closed convex surface of the mass in world coordinates (.stl, .ply, .obj, or the points of its
   * convex hull), unless it comes by port 2.
   */
  vtkSetStdStringFromCharMacro(MassFileName);
  vtkGetCharFromStdStringMacro(MassFileName);
  ///@}

  ///@{
  /**
   * The joint sets. Of each dip and dip direction (degrees; clockwise from +y), mean spacing (m),
   * offset of one joint along the upward normal from the mass's centroid (m), standard deviation of
   * the spacing (m, log-normal) and of the orientation (degrees). Default: three sets that cut the
   * default box into 27 cubes.
   */
  void SetNumberOfJointSets(int number);
  int GetNumberOfJointSets();
  void SetJointSet(int index, double dip, double dipDirection, double spacing, double offset,
    double spacingDeviation, double orientationDeviation);
  ///@}

  enum SliverRule
  {
    REFUSE = 0,
    DROP = 1,
    KEEP = 2
  };

  ///@{
  /**
   * The rule for blocks that are too thin or too small, one of SliverRule. Default REFUSE:
   * they are an error.
   */
  vtkSetMacro(Slivers, int);
  vtkGetMacro(Slivers, int);
  ///@}

  ///@{
  /**
   * Blocks thinner (m) or smaller (m³) than this are slivers; not negative. Default 0.01 and 0.001.
   */
  vtkSetMacro(MinimumThickness, double);
  vtkGetMacro(MinimumThickness, double);
  vtkSetMacro(MinimumVolume, double);
  vtkGetMacro(MinimumVolume, double);
  ///@}

  ///@{
  /**
   * More blocks than this, as foretold from the sets, are an error that says what they would take;
   * at least 1. Default 100,000.
   */
  vtkSetMacro(MaximumRocks, int);
  vtkGetMacro(MaximumRocks, int);
  ///@}

  ///@{
  /**
   * Number from which deviations are drawn, not negative. Default 1.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Whether the mass as a whole is set down on the terrain. Default off.
   */
  vtkSetMacro(PlaceOnGround, bool);
  vtkGetMacro(PlaceOnGround, bool);
  vtkBooleanMacro(PlaceOnGround, bool);
  ///@}

  ///@{
  /**
   * Height over ground to which it is raised then, m, not negative. Default 0.
   */
  vtkSetMacro(ReleaseHeight, double);
  vtkGetMacro(ReleaseHeight, double);
  ///@}

  ///@{
  /**
   * Velocity at release of all blocks, m/s. Default 0, 0, 0.
   */
  vtkSetVector3Macro(Velocity, double);
  vtkGetVector3Macro(Velocity, double);
  ///@}

  ///@{
  /**
   * Kind of rock and what it stands for, as those of vtkRockBlockSource.
   */
  vtkSetMacro(Material, int);
  vtkGetMacro(Material, int);
  vtkSetStdStringFromCharMacro(MaterialName);
  vtkGetCharFromStdStringMacro(MaterialName);
  vtkSetMacro(Density, double);
  vtkGetMacro(Density, double);
  vtkSetMacro(YoungModulus, double);
  vtkGetMacro(YoungModulus, double);
  vtkSetMacro(PoissonRatio, double);
  vtkGetMacro(PoissonRatio, double);
  ///@}

  ///@{
  /**
   * Name of the source. Empty (the default): "source" and its number.
   */
  vtkSetStdStringFromCharMacro(SourceName);
  vtkGetCharFromStdStringMacro(SourceName);
  ///@}

  ///@{
  /**
   * SourceId of all blocks. Default 1.
   */
  vtkSetMacro(SourceId, vtkIdType);
  vtkGetMacro(SourceId, vtkIdType);
  ///@}

  ///@{
  /**
   * BlockId of the first block; the others follow. Default 1.
   */
  vtkSetMacro(FirstBlockId, vtkIdType);
  vtkGetMacro(FirstBlockId, vtkIdType);
  ///@}

  vtkJointedRockMass(const vtkJointedRockMass&) = delete;
  void operator=(const vtkJointedRockMass&) = delete;

protected:
  vtkJointedRockMass();
  ~vtkJointedRockMass() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  /// Makes the blocks, or throws.
  void MakeBlocks(vtkPolyData* terrainInput, vtkPolyData* surface, vtkPolyData* blocks);

  int MassShape = BOX;
  double Center[3] = { 5.0, 50.0, 58.0 };
  double Lengths[3] = { 3.0, 3.0, 3.0 };
  double Orientation[3] = { 0.0, 0.0, 0.0 };
  std::string MassFileName;
  std::vector<std::array<double, 6>> JointSets;
  int Slivers = REFUSE;
  double MinimumThickness = 0.01;
  double MinimumVolume = 0.001;
  int MaximumRocks = 100000;
  int Seed = 1;
  bool PlaceOnGround = false;
  double ReleaseHeight = 0.0;
  double Velocity[3] = { 0.0, 0.0, 0.0 };
  int Material = 0;
  std::string MaterialName;
  double Density = 2500.0;
  double YoungModulus = 1e10;
  double PoissonRatio = 0.1;
  std::string SourceName;
  vtkIdType SourceId = 1;
  vtkIdType FirstBlockId = 1;
};

#endif
