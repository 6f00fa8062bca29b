/**
 * @class   vtkDEMToCFESource
 * @brief   reads a DEM and makes the slope's contact face elements (CFEs)
 *
 * The output has one triangle per CFE in the order of the numbering (row by row from the north, in
 * each cell the lower triangle and then the upper one; triangles that touch nodata are left out),
 * in the real coordinates of the DEM's coordinate system, in double precision.
 *
 * Cell arrays: CFEId (from 1), RestitutionCoefficient, RestitutionClass, FrictionAngle (degrees),
 * JointClass. Point array:
 * Elevation (m). The field data carries the slope itself - node heights, grid, coordinate system,
 * material - and that is what the simulation uses: the triangles are there to be seen, to be
 * coloured and to be picked (see terrainFieldData.h). Notes on what was done to the data
 * (reprojection, resampling, ...) are shown as plain messages and kept in the field array Notes.
 * The field array Ground says which ground it is.
 *
 * Without a FileName the source makes the bi-planar test slope: an incline 57.7 m high and 100 m
 * long that falls along +x, then 150 m of flat, 100 m wide.
 *
 * All values are taken as they come and checked when the source runs, so that a bad one gives one
 * error that names it instead of being changed silently.
 */
#ifndef vtkDEMToCFESource_h
#define vtkDEMToCFESource_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

#include <memory> // for the slope
#include <string> // for FileName
#include <vector> // for notes

namespace rockfall
{
class Terrain;
struct SurfaceMaterial;
namespace filters // VTK's wrappers read no nested name
{
class IdleProperties;
}
}

class ROCKFALLFILTERS_EXPORT vtkDEMToCFESource : public vtkPolyDataAlgorithm
{
public:
  static vtkDEMToCFESource* New();
  vtkTypeMacro(vtkDEMToCFESource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Any raster that GDAL opens, or any layer of contour lines that OGR opens. Empty (the default):
   * the bi-planar test slope.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Name of the layer or raster of a file with several. Empty (the default): the one that will
   * do; if several would, that is an error which lists them. Of a drawing (DXF) names of its layers
   * with commas between them, or * for all. The others are those of the further files; sheets are
   * those of tables.
   */
  vtkSetStdStringFromCharMacro(LayerName);
  vtkGetCharFromStdStringMacro(LayerName);
  vtkSetStdStringFromCharMacro(RestitutionLayerName);
  vtkGetCharFromStdStringMacro(RestitutionLayerName);
  vtkSetStdStringFromCharMacro(RestitutionTableSheet);
  vtkGetCharFromStdStringMacro(RestitutionTableSheet);
  vtkSetStdStringFromCharMacro(JointLayerName);
  vtkGetCharFromStdStringMacro(JointLayerName);
  vtkSetStdStringFromCharMacro(JointTableSheet);
  vtkGetCharFromStdStringMacro(JointTableSheet);
  vtkSetStdStringFromCharMacro(EmbankmentLayerName);
  vtkGetCharFromStdStringMacro(EmbankmentLayerName);
  vtkSetStdStringFromCharMacro(TreeLayerName);
  vtkGetCharFromStdStringMacro(TreeLayerName);
  vtkSetStdStringFromCharMacro(BarrierLayerName);
  vtkGetCharFromStdStringMacro(BarrierLayerName);
  ///@}

  ///@{
  /**
   * Distance between nodes in metres, not negative. 0 (the default) keeps the file's; for the test
   * slope it means 5 m, for contours half their mean distance.
   */
  vtkSetMacro(CellSize, double);
  vtkGetMacro(CellSize, double);
  ///@}

  ///@{
  /**
   * The cut of each cell into two triangles: along its shorter fold, the diagonal whose ends differ
   * less in height (0, the default), or from its upper left to its lower right node (1), as
   * published.
   */
  vtkSetMacro(CellDiagonal, int);
  vtkGetMacro(CellDiagonal, int);
  ///@}

  ///@{
  /**
   * The raster's band that holds the elevations, from 1 (the default).
   */
  vtkSetMacro(Band, int);
  vtkGetMacro(Band, int);
  ///@}

  ///@{
  /**
   * Contours: the field with their heights. Empty (the default) looks for the usual names and then
   * takes the lines' own z.
   */
  vtkSetStdStringFromCharMacro(ElevationField);
  vtkGetCharFromStdStringMacro(ElevationField);
  ///@}

  ///@{
  /**
   * Whether files may name network addresses and other files of the machine: virtual rasters and
   * layers that are made of files elsewhere, services, lists of tiles. Off by default, because a
   * file that came from somebody else could have any file read, or an address called. Virtual
   * rasters of files beside them need no leave.
   */
  vtkSetMacro(AllowReferences, int);
  vtkGetMacro(AllowReferences, int);
  vtkBooleanMacro(AllowReferences, int);
  ///@}

  ///@{
  /**
   * Contours: whether hilltops, ridges and valleys, where the TIN is flat, are rounded (a thin
   * plate). Default on.
   */
  vtkSetMacro(RelaxFlats, int);
  vtkGetMacro(RelaxFlats, int);
  vtkBooleanMacro(RelaxFlats, int);
  ///@}

  ///@{
  /**
   * A kind of ground whose coefficients, quoted from publications, replace the material's
   * properties below, from 1 in the order of Core/terrain/presets.h. 0 (the default): none.
   */
  vtkSetMacro(Preset, int);
  vtkGetMacro(Preset, int);
  ///@}

  ///@{
  /**
   * Classes of restitution and of friction: a class raster or polygons, and a table with their
   * numbers (see Core/gis/raster/ground.h). Empty (the default): the slope is all of one material.
   * The field is that of the polygons with the class; empty looks for class, name, code, ...
   */
  vtkSetStdStringFromCharMacro(RestitutionLayer);
  vtkGetCharFromStdStringMacro(RestitutionLayer);
  vtkSetStdStringFromCharMacro(RestitutionTable);
  vtkGetCharFromStdStringMacro(RestitutionTable);
  vtkSetStdStringFromCharMacro(RestitutionField);
  vtkGetCharFromStdStringMacro(RestitutionField);
  vtkSetStdStringFromCharMacro(JointLayer);
  vtkGetCharFromStdStringMacro(JointLayer);
  vtkSetStdStringFromCharMacro(JointTable);
  vtkGetCharFromStdStringMacro(JointTable);
  vtkSetStdStringFromCharMacro(JointField);
  vtkGetCharFromStdStringMacro(JointField);
  ///@}

  ///@{
  /**
   * Embankments and dams (lines), trees (points; lines lie) and barriers or nets (lines), see
   * Core/gis/layers/structureLayers.h for their fields. Empty (the default): there are none.
   * TreesBreak: trees without a capacity of their own break at that of their diameter (Dorren &
   * Berger 2006); default on; off they never break. Output port 1 shows them.
   */
  vtkSetStdStringFromCharMacro(EmbankmentFile);
  vtkGetCharFromStdStringMacro(EmbankmentFile);
  vtkSetStdStringFromCharMacro(TreeFile);
  vtkGetCharFromStdStringMacro(TreeFile);
  vtkSetMacro(TreesBreak, int);
  vtkGetMacro(TreesBreak, int);
  vtkBooleanMacro(TreesBreak, int);
  vtkSetStdStringFromCharMacro(BarrierFile);
  vtkGetCharFromStdStringMacro(BarrierFile);
  ///@}

  enum RestitutionModelType
  {
    WHOLE_VELOCITY = 0,
    NORMAL_TANGENTIAL = 1,
    SPEED_DEPENDENT = 2
  };

  ///@{
  /**
   * Restitution of an impact: of the whole velocity (WHOLE_VELOCITY, the default), parts of its
   * normal and its tangential component (NORMAL_TANGENTIAL), or the same with a normal coefficient
   * that falls with the speed of the impact (SPEED_DEPENDENT; Pfeiffer & Bowen 1989, CRSP).
   */
  vtkSetMacro(RestitutionModel, int);
  vtkGetMacro(RestitutionModel, int);
  ///@}

  ///@{
  /**
   * Coefficient of restitution of the slope, 0 to 1, dimensionless: Rv of the whole velocity, or Rn
   * of its normal component, as RestitutionModel has it. Default 0.8.
   */
  vtkSetMacro(RestitutionCoefficient, double);
  vtkGetMacro(RestitutionCoefficient, double);
  ///@}

  ///@{
  /**
   * Standard deviation of RestitutionCoefficient, 0 to 1. Default 0.05.
   */
  vtkSetMacro(RestitutionDeviation, double);
  vtkGetMacro(RestitutionDeviation, double);
  ///@}

  ///@{
  /**
   * Tangential coefficient of restitution Rt, 0 to 1, dimensionless: the part that an impact leaves
   * of what friction left of the tangential velocity. Not used by WHOLE_VELOCITY. Default 1.
   */
  vtkSetMacro(TangentialRestitution, double);
  vtkGetMacro(TangentialRestitution, double);
  ///@}

  ///@{
  /**
   * K of SPEED_DEPENDENT, Rn(v) = Rn / (1 + (v/K)²): the normal speed of impact that halves the
   * normal coefficient, in m/s, positive. Default 9.144, which is 30 ft/s.
   */
  vtkSetMacro(RestitutionSpeed, double);
  vtkGetMacro(RestitutionSpeed, double);
  ///@}

  ///@{
  /**
   * M_E, the strength of ground that gives way, in MN/m²; 0 (the default): hard ground, no scars.
   * Lu et al. (2019) found 10 to 25 for an alpine meadow.
   */
  vtkSetMacro(GroundModulus, double);
  vtkGetMacro(GroundModulus, double);
  ///@}

  ///@{
  /**
   * Factor of the depth of a scar, 0.1 M^(1/3) M_E^-0.4 w^0.8 (m, kg, kN/m², m/s). Default 0.1.
   */
  vtkSetMacro(ScarDepthFactor, double);
  vtkGetMacro(ScarDepthFactor, double);
  ///@}

  ///@{
  /**
   * Density of the ground that a scar displaces, in kg/m³. Default 1700.
   */
  vtkSetMacro(GroundDensity, double);
  vtkGetMacro(GroundDensity, double);
  ///@}

  ///@{
  /**
   * C_s: the drag in a scar is 1 + C_s, without unit. Default 0.
   */
  vtkSetMacro(ScarCompaction, double);
  vtkGetMacro(ScarCompaction, double);
  ///@}

  ///@{
  /**
   * Drag of the ground in a scar on the rotation, without unit. Default 0.
   */
  vtkSetMacro(ScarSpinDrag, double);
  vtkGetMacro(ScarSpinDrag, double);
  ///@}

  ///@{
  /**
   * μ_min of the slip-dependent friction, without unit. Default 0.
   */
  vtkSetMacro(SlipFrictionMin, double);
  vtkGetMacro(SlipFrictionMin, double);
  ///@}

  ///@{
  /**
   * μ_max of the slip-dependent friction, without unit; 0 (the default): FrictionAngle instead.
   */
  vtkSetMacro(SlipFrictionMax, double);
  vtkGetMacro(SlipFrictionMax, double);
  ///@}

  ///@{
  /**
   * κ: how fast the friction grows with the way, in 1/m. Default 0.
   */
  vtkSetMacro(SlipFrictionGrowth, double);
  vtkGetMacro(SlipFrictionGrowth, double);
  ///@}

  ///@{
  /**
   * β: how fast it is forgotten without touch, in 1/s. Default 0.
   */
  vtkSetMacro(SlipFrictionDecay, double);
  vtkGetMacro(SlipFrictionDecay, double);
  ///@}

  ///@{
  /**
   * μ_r: the moment against rolling by force and radius, without unit. Default 0.
   */
  vtkSetMacro(RollingResistance, double);
  vtkGetMacro(RollingResistance, double);
  ///@}

  ///@{
  /**
   * r₀: radius in m, not negative, of rocks that dig as deep as ScarDepthFactor says; the depth of
   * others is multiplied by (r₀/r)^(1/3), r the radius of the sphere of equal volume. Default 0:
   * scars of all sizes are alike.
   */
  vtkSetMacro(ScarRadius, double);
  vtkGetMacro(ScarRadius, double);
  ///@}

  ///@{
  /**
   * σ: deviation of the logarithm of how soft the ground is, from place to place, without unit, not
   * negative. Soft ground has a lower modulus and more slip friction. Default 0.
   */
  vtkSetMacro(GroundDeviation, double);
  vtkGetMacro(GroundDeviation, double);
  ///@}

  ///@{
  /**
   * ℓ: length in m, above 0, over which the ground is alike: at ℓ the correlation has come down to
   * 1/e. Default 30.
   */
  vtkSetMacro(GroundDeviationLength, double);
  vtkGetMacro(GroundDeviationLength, double);
  ///@}

  ///@{
  /**
   * Friction angle between rock and slope in degrees, 0 to 89. Default 15.
   */
  vtkSetMacro(FrictionAngle, double);
  vtkGetMacro(FrictionAngle, double);
  ///@}

  ///@{
  /**
   * Standard deviation of the friction angle in degrees, 0 to 89. Default 0.
   */
  vtkSetMacro(FrictionAngleDeviation, double);
  vtkGetMacro(FrictionAngleDeviation, double);
  ///@}

  ///@{
  /**
   * Cohesion in newtons per contact point, not negative. Default 0.
   */
  vtkSetMacro(Cohesion, double);
  vtkGetMacro(Cohesion, double);
  ///@}

  ///@{
  /**
   * Mean of the random elevation added to the slope in each iteration, in metres. Default 0.1.
   */
  vtkSetMacro(RoughnessMean, double);
  vtkGetMacro(RoughnessMean, double);
  ///@}

  ///@{
  /**
   * Standard deviation of the random elevation added to the slope, in metres, not negative.
   * Default 0.1.
   */
  vtkSetMacro(RoughnessDeviation, double);
  vtkGetMacro(RoughnessDeviation, double);
  ///@}

  ///@{
  /**
   * Correlation length of the roughness in metres: where the correlation of two places has come
   * down to 1/e, and the distance of obstacles. Wider cells are cut as rocks meet them, so that
   * run-out does not depend on the cell size. Default 2. 0: every node is drawn independently.
   */
  vtkSetMacro(RoughnessLength, double);
  vtkGetMacro(RoughnessLength, double);
  ///@}

  ///@{
  /**
   * Heights in metres of 70, 20 and 10 % of the obstacles on the ground (rg70, rg20, rg10), not
   * negative. They need a RoughnessLength. Default 0: there are none.
   */
  vtkSetMacro(ObstacleHeight70, double);
  vtkGetMacro(ObstacleHeight70, double);
  vtkSetMacro(ObstacleHeight20, double);
  vtkGetMacro(ObstacleHeight20, double);
  vtkSetMacro(ObstacleHeight10, double);
  vtkGetMacro(ObstacleHeight10, double);
  ///@}

  enum DeviationPerType
  {
    PER_ITERATION = 0,
    PER_IMPACT = 1,
    PER_PLACE = 2
  };

  ///@{
  /**
   * For what the deviations of restitution and friction are drawn: once per iteration and class
   * (PER_ITERATION, the default), for each impact of each rock, or for each square metre of the
   * map.
   */
  vtkSetMacro(DeviationPer, int);
  vtkGetMacro(DeviationPer, int);
  ///@}

  ///@{
  /**
   * Largest number of triangles that the output may have, at least 2. A bigger slope is shown with
   * every second, third, ... node only (a note says so); the simulation always uses every node. The
   * CFEId of a triangle of such a coarse mesh is that of the CFE in the full network that shares
   * its north-west node and lies on the same side of the diagonal. Default 4 million.
   */
  void SetMaximumDisplayCells(vtkIdType cells);
  vtkGetMacro(MaximumDisplayCells, vtkIdType);
  ///@}

  vtkDEMToCFESource(const vtkDEMToCFESource&) = delete;
  void operator=(const vtkDEMToCFESource&) = delete;

protected:
  vtkDEMToCFESource();
  ~vtkDEMToCFESource() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  rockfall::SurfaceMaterial MakeMaterial() const;
  rockfall::Terrain ReadSlope(std::vector<std::string>& notes, bool& contours) const;
  /// Notes on properties that were set and have no effect. `contours`: FileName has lines.
  std::vector<std::string> IdleNotes(bool contours) const;
  void FindIdleGround(rockfall::filters::IdleProperties& idle) const;
  std::shared_ptr<const rockfall::Terrain> MakeSlope(std::vector<std::string>& notes);

  std::string FileName;
  std::string LayerName;
  std::string RestitutionLayerName;
  std::string RestitutionTableSheet;
  std::string JointLayerName;
  std::string JointTableSheet;
  std::string EmbankmentLayerName;
  std::string TreeLayerName;
  std::string BarrierLayerName;
  double CellSize = 0.0;
  int Band = 1;
  std::string ElevationField;
  int RelaxFlats = 1;
  int CellDiagonal = 0;
  int AllowReferences = 0;
  int Preset = 0;
  std::string RestitutionLayer;
  std::string RestitutionTable;
  std::string RestitutionField;
  std::string JointLayer;
  std::string JointTable;
  std::string JointField;
  std::string EmbankmentFile;
  std::string TreeFile;
  int TreesBreak = 1;
  std::string BarrierFile;
  int RestitutionModel = WHOLE_VELOCITY;
  double RestitutionCoefficient = 0.8;
  double RestitutionDeviation = 0.05;
  double TangentialRestitution = 1.0;
  double RestitutionSpeed = 9.144;
  double FrictionAngle = 15.0;
  double FrictionAngleDeviation = 0.0;
  double Cohesion = 0.0;
  double GroundModulus = 0.0;
  double ScarDepthFactor = 0.1;
  double GroundDensity = 1700.0;
  double ScarCompaction = 0.0;
  double ScarSpinDrag = 0.0;
  double SlipFrictionMin = 0.0;
  double SlipFrictionMax = 0.0;
  double SlipFrictionGrowth = 0.0;
  double SlipFrictionDecay = 0.0;
  double RollingResistance = 0.0;
  double ScarRadius = 0.0;
  double GroundDeviation = 0.0;
  double GroundDeviationLength = 30.0;
  double RoughnessMean = 0.1;
  double RoughnessDeviation = 0.1;
  double RoughnessLength = 2.0;
  double ObstacleHeight70 = 0.0;
  double ObstacleHeight20 = 0.0;
  double ObstacleHeight10 = 0.0;
  int DeviationPer = PER_ITERATION;
  vtkIdType MaximumDisplayCells = 4000000;

  /// Slope that was read when this was last changed otherwise than in what is shown.
  std::shared_ptr<const rockfall::Terrain> Slope;
  std::vector<std::string> SlopeNotes;
  vtkMTimeType SlopeTime = 0;
};

#endif
