/**
 * @class   vtkJointedRockMass
 * @brief   cuts a rock mass by joint sets into the blocks that fall
 *
 * With a terrain the mass can be set down on the ground; the shape input is the mass FROM_FILE.
 *
 * A box or a closed convex surface is cut by planes right through (persistence 1): Shi's block
 * cutting of a mass without joints that end in it. The output is that of vtkRockBlockSource: the
 * faces of every block in world coordinates, with the block's properties as cell arrays. Field
 * arrays SliverCount and SliverVolume tell what was left out or kept of blocks that are too thin or
 * too small.
 */
#ifndef vtkJointedRockMass_h
#define vtkJointedRockMass_h

#include "RockfallFiltersModule.h"
#include "vtkRockAlgorithm.h"

#include <array>  // for a joint set's numbers
#include <string> // for file names
#include <vector> // for JointSets

class ROCKFALLFILTERS_EXPORT vtkJointedRockMass : public vtkRockAlgorithm
{
public:
  static vtkJointedRockMass* New();
  vtkTypeMacro(vtkJointedRockMass, vtkRockAlgorithm);
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
   * SourceId of all blocks. Default 1.
   */
  vtkSetMacro(SourceId, vtkIdType);
  vtkGetMacro(SourceId, vtkIdType);
  ///@}

  vtkJointedRockMass(const vtkJointedRockMass&) = delete;
  void operator=(const vtkJointedRockMass&) = delete;

protected:
  vtkJointedRockMass();
  ~vtkJointedRockMass() override;

  void MakeBlocks(vtkPolyData* terrain, vtkPolyData* shape, vtkPolyData* blocks) override;

private:
  std::vector<std::string> IdleNotes() const; ///< On properties that have no effect.

  int MassShape = BOX;
  std::string MassFileName;
  std::vector<std::array<double, 6>> JointSets;
  int Slivers = REFUSE;
  double MinimumThickness = 0.01;
  double MinimumVolume = 0.001;
  vtkIdType SourceId = 1;
};

#endif
