/**
 * @class   vtkRockBlockSource
 * @brief   makes rock blocks, by properties or from a layer of rockfall sources
 *
 * With a terrain rocks can be placed over the ground and where it is steep, and layers are brought
 * to its coordinate system; the shape input is that FROM_FILE.
 *
 * The output has the real polygonal faces of every block in world coordinates, in double precision.
 * Cell arrays: BlockId, and beside it the properties of the block, Density, Volume, YoungModulus,
 * PoissonRatio, Material, Velocity, AngularVelocity, Shape, SourceId and what is drawn in each
 * iteration of a simulation (see rockFieldData.h).
 */
#ifndef vtkRockBlockSource_h
#define vtkRockBlockSource_h

#include "RockfallFiltersModule.h"
#include "listProperty.h"
#include "vtkRockAlgorithm.h"

#include <cstddef> // for numbers of sources
#include <string>  // for FileName
#include <vector>  // for points

class ROCKFALLFILTERS_EXPORT vtkRockBlockSource : public vtkRockAlgorithm
{
public:
  static vtkRockBlockSource* New();
  vtkTypeMacro(vtkRockBlockSource, vtkRockAlgorithm);
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
    FROM_FILE = 8,
    SPHERE = 9,
    ELLIPSOID = 10
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
   * Several shapes in proportion instead of one, as "cube:2;icosahedron:1". Empty (the default):
   * all are of Shape.
   */
  vtkSetStdStringFromCharMacro(ShapeMix);
  vtkGetCharFromStdStringMacro(ShapeMix);
  ///@}

  enum VolumeLawType
  {
    FIXED = 0,
    UNIFORM = 1,
    NORMAL = 2,
    LOG_NORMAL = 3,
    POWER_LAW = 4
  };

  ///@{
  /**
   * Distribution of the volumes, one of VolumeLawType. Default FIXED.
   */
  vtkSetMacro(VolumeLaw, int);
  vtkGetMacro(VolumeLaw, int);
  ///@}

  ///@{
  /**
   * Standard deviation of the volume in m³, not negative: of the normal and the log-normal law.
   * Default 0.5.
   */
  vtkSetMacro(VolumeDeviation, double);
  vtkGetMacro(VolumeDeviation, double);
  ///@}

  ///@{
  /**
   * Bounds of the volume in m³, not negative, of every law but the fixed one. A maximum of 0 is
   * none for the normal and the log-normal law. Default 0.1 and 10.
   */
  vtkSetMacro(VolumeMinimum, double);
  vtkGetMacro(VolumeMinimum, double);
  vtkSetMacro(VolumeMaximum, double);
  vtkGetMacro(VolumeMaximum, double);
  ///@}

  ///@{
  /**
   * Exponent b of the power law N(> V) ∝ V⁻ᵇ, positive. Default 0.5.
   */
  vtkSetMacro(VolumeExponent, double);
  vtkGetMacro(VolumeExponent, double);
  ///@}

  ///@{
  /**
   * Volume in m³, positive; the mean of the normal and the log-normal law. A box and an ellipsoid
   * have that of their Lengths instead. Default 1.
   */
  vtkSetMacro(Volume, double);
  vtkGetMacro(Volume, double);
  ///@}

  ///@{
  /**
   * File of the shape FROM_FILE, unless it comes by port 2: points (.csv, .xyz, .txt) or a mesh
   * (.stl, .ply, .obj). A mesh must be closed with its faces outward.
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
   * The part of a mesh that is taken: its convex hull (the default), or its faces as they are,
   * which must then be those of a convex polyhedron.
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
   * Angular velocity at release about the world's x, y and z, rad/s. Default 0, 0, 0.
   */
  vtkSetVector3Macro(AngularVelocity, double);
  vtkGetVector3Macro(AngularVelocity, double);
  ///@}

  ///@{
  /**
   * Name of the layer or sheet of a file with several. Empty (the default): the one that will
   * do; if several would, that is an error which lists them.
   */
  vtkSetStdStringFromCharMacro(LayerName);
  vtkGetCharFromStdStringMacro(LayerName);
  ///@}

  ///@{
  /**
   * Rockfall sources: a layer of points, lines or polygons of any kind that OGR opens, or a CSV
   * table with columns x, y, z. What a row does not say is as the properties say; the columns are
   * in docs/sources.md. Empty (the default): the source is the point Center, or the steep part
   * of the terrain if SlopeThreshold is above 0.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  enum DrawnSource
  {
    NOTHING = 0,
    POINTS = 1,
    LINE = 2,
    AREA = 3
  };
  ///@{
  /**
   * The source that is drawn through Points, one of DrawnSource. NOTHING (the default): the
   * source is Center, a file or the steep part of the terrain.
   */
  vtkSetMacro(Draw, int);
  vtkGetMacro(Draw, int);
  ///@}

  ///@{
  /**
   * Points of the source that is drawn, in world coordinates; with a terrain they stand on it. None
   * (the default): with a terrain, the ends of a level line across the highest of its steep places.
   */
  void AddPoint(double x, double y, double z)
  {
    this->Points.insert(this->Points.end(), { x, y, z });
    this->Modified();
  }
  /// Numbers one by one, three of them a point: a list whose length is no multiple of three is an
  /// error of the run.
  rockfallListPropertyMacro(Points, double, AddCoordinate, ClearPoints);
  ///@}

  /**
   * Ends of the line that the last run took because no point was given, on the ground.
   */
  vtkGetVector6Macro(PlacedLine, double);

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
   * Coordinate system of the slope where there is no terrain that knows it, as WKT or "EPSG:n": the
   * points of a layer in another one are brought to it. Empty (the default): they are taken as they
   * are. The output says in its field array TerrainCRS in which one it is, if that is known.
   */
  vtkSetStdStringFromCharMacro(TargetCRS);
  vtkGetCharFromStdStringMacro(TargetCRS);
  ///@}

  ///@{
  /**
   * Number of rocks of a source, at least 1. Default 1.
   */
  vtkSetMacro(Amount, int);
  vtkGetMacro(Amount, int);
  ///@}

  ///@{
  /**
   * Rocks per m of a line and per m² of a polygon or of steep terrain, in plan, not negative. 0
   * (the default): Amount counts.
   */
  vtkSetMacro(Intensity, double);
  vtkGetMacro(Intensity, double);
  ///@}

  ///@{
  /**
   * Volume of all rocks of a source in m³, as nearly as whole rocks can have it, not negative. 0
   * (the default): Amount or Intensity counts.
   */
  vtkSetMacro(TotalVolume, double);
  vtkGetMacro(TotalVolume, double);
  ///@}

  ///@{
  /**
   * How often a rock of a source falls, 1/a; its rocks share it. Sources of a layer may have their
   * own. 0 (the default): not known, unless one of the two below is given.
   */
  vtkSetMacro(AnnualFrequency, double);
  vtkGetMacro(AnnualFrequency, double);
  ///@}

  ///@{
  /**
   * The same of areas, as far as they lie on the terrain, and of steep terrain, 1/a per hectare in
   * plan.
   */
  vtkSetMacro(FrequencyPerHectare, double);
  vtkGetMacro(FrequencyPerHectare, double);
  ///@}

  ///@{
  /**
   * The same as A of F(V) = A V^−B, 1/a with V in m³: how often a source drops volumes of V and
   * more. That of a source is A (VolumeMinimum^−B − VolumeMaximum^−B) with VolumeExponent as B.
   */
  vtkSetMacro(PowerLawFrequency, double);
  vtkGetMacro(PowerLawFrequency, double);
  ///@}

  ///@{
  /**
   * Radius in m, not negative, of the cluster that the rocks of a point make: a disc for rocks over
   * the ground, else a ball. Default 0.
   */
  vtkSetMacro(ClusterRadius, double);
  vtkGetMacro(ClusterRadius, double);
  ///@}

  ///@{
  /**
   * Whether places are drawn until no rock is in another one. Default off.
   */
  vtkSetMacro(KeepApart, bool);
  vtkGetMacro(KeepApart, bool);
  vtkBooleanMacro(KeepApart, bool);
  ///@}

  ///@{
  /**
   * Whether each rock has an attitude of its own, drawn once, any with equal chance, instead of
   * Orientation. Default off.
   */
  vtkSetMacro(RandomOrientation, bool);
  vtkGetMacro(RandomOrientation, bool);
  vtkBooleanMacro(RandomOrientation, bool);
  ///@}

  ///@{
  /**
   * Release from the terrain where it is at least so steep, in degrees, 0 to 89. 0 (the default):
   * not so.
   */
  vtkSetMacro(SlopeThreshold, double);
  vtkGetMacro(SlopeThreshold, double);
  ///@}

  ///@{
  /**
   * Standard deviations of the place in m, not negative: of x and y each, and of the height. Drawn
   * in each iteration of a simulation. Default 0.
   */
  vtkSetMacro(HorizontalDeviation, double);
  vtkGetMacro(HorizontalDeviation, double);
  vtkSetMacro(VerticalDeviation, double);
  vtkGetMacro(VerticalDeviation, double);
  ///@}

  enum AttitudeLawType
  {
    AS_GIVEN = 0,
    RANDOM = 1,
    DEVIATING = 2,
    RANDOM_UNLESS_GIVEN = 3
  };

  ///@{
  /**
   * Attitude in each iteration of a simulation, one of AttitudeLawType. RANDOM_UNLESS_GIVEN, the
   * default, is AS_GIVEN where there is an Orientation other than 0, RandomOrientation or one of
   * the row, and RANDOM elsewhere.
   */
  vtkSetMacro(AttitudeLaw, int);
  vtkGetMacro(AttitudeLaw, int);
  ///@}

  ///@{
  /**
   * Standard deviation of the angle about each axis in degrees, not negative: of DEVIATING. Default
   * 10.
   */
  vtkSetMacro(AttitudeDeviation, double);
  vtkGetMacro(AttitudeDeviation, double);
  ///@}

  ///@{
  /**
   * Whether the volume is drawn in each iteration of a simulation instead of once. Default off.
   */
  vtkSetMacro(RedrawVolume, bool);
  vtkGetMacro(RedrawVolume, bool);
  vtkBooleanMacro(RedrawVolume, bool);
  ///@}

  ///@{
  /**
   * SourceId of the first source; the others follow. Default 1, so that a source has the number of
   * its row.
   */
  vtkSetMacro(FirstSourceId, vtkIdType);
  vtkGetMacro(FirstSourceId, vtkIdType);
  ///@}

  vtkRockBlockSource(const vtkRockBlockSource&) = delete;
  void operator=(const vtkRockBlockSource&) = delete;

protected:
  vtkRockBlockSource();
  ~vtkRockBlockSource() override;

  void MakeBlocks(vtkPolyData* terrain, vtkPolyData* shape, vtkPolyData* blocks) override;

private:
  struct Sources;

  /// Terrain, rows and CRS.
  void FindSources(vtkPolyData* terrain, Sources& sources);
  void FindPlaces(Sources& sources);
  void MakeRocks(Sources& sources);
  /// The sources that are drawn, or Center.
  void FindDrawn(Sources& sources);
  /// Notes on properties and on a shape that have no effect, and on rows that are odd.
  void FindNotes(Sources& sources, bool hasShape) const;
  void FindIdleOfPlace(const Sources& sources, rockfall::filters::IdleProperties& idle) const;
  void FindIdleOfRows(const Sources& sources, rockfall::filters::IdleProperties& idle) const;
  void CheckFrequencies() const; ///< Of the properties.
  /// Of all rocks of a source, 1/a; NaN if it is not known.
  double FrequencyOf(const Sources& sources, std::size_t number) const;
  /// Shares the frequency of each source out over its rocks.
  void SetFrequencies(Sources& sources) const;
  /// Draws places anew until no rock is in another one, or throws.
  void PlaceApart(Sources& sources);

  int Shape = CUBE;
  double Volume = 1.0;
  std::string ShapeFileName;
  int ShapeFileMode = CONVEX_HULL;
  bool ScaleToVolume = true;
  double AngularVelocity[3] = { 0.0, 0.0, 0.0 };
  std::string FileName;
  std::string LayerName;
  int Draw = NOTHING;
  std::vector<double> Points; ///< x, y, z of each in turn.
  double PlacedLine[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  std::string TargetCRS;
  int AllowReferences = 0;
  std::string ShapeMix;
  int VolumeLaw = FIXED;
  double VolumeDeviation = 0.5;
  double VolumeMinimum = 0.1;
  double VolumeMaximum = 10.0;
  double VolumeExponent = 0.5;
  int Amount = 1;
  double Intensity = 0.0;
  double TotalVolume = 0.0;
  double AnnualFrequency = 0.0;
  double FrequencyPerHectare = 0.0;
  double PowerLawFrequency = 0.0;
  double ClusterRadius = 0.0;
  bool KeepApart = false;
  bool RandomOrientation = false;
  double SlopeThreshold = 0.0;
  double HorizontalDeviation = 0.0;
  double VerticalDeviation = 0.0;
  int AttitudeLaw = RANDOM_UNLESS_GIVEN;
  double AttitudeDeviation = 10.0;
  bool RedrawVolume = false;
  vtkIdType FirstSourceId = 1;
};

#endif
