/**
 * @class   vtkDEMToCFESource
 * @brief   reads a DEM and makes the slope's contact face elements (CFEs)
 *
 * The output has one triangle per CFE in the order of the numbering (row by row from the north, in
 * each cell the lower triangle and then the upper one; triangles that touch nodata are left out),
 * in the real coordinates of the DEM's coordinate system, in double precision.
 *
 * Cell arrays: CFEId (from 1), RestitutionCoefficient, FrictionAngle (degrees). Point array:
 * Elevation (m). The field data carries the slope itself - node heights, grid, coordinate system,
 * material - and that is what the simulation uses: the triangles are there to be seen, to be
 * coloured and to be picked (see terrainFieldData.h). Notes on what was done to the data
 * (reprojection, resampling, ...) are shown as plain messages and kept in the field array Notes.
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

#include <string> // for FileName

class ROCKFALLFILTERS_EXPORT vtkDEMToCFESource : public vtkPolyDataAlgorithm
{
public:
  static vtkDEMToCFESource* New();
  vtkTypeMacro(vtkDEMToCFESource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Any raster that GDAL opens. Empty (the default): the bi-planar test slope.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Distance between nodes in metres, not negative. 0 (the default) keeps the file's; for the test
   * slope it means 5 m.
   */
  vtkSetMacro(CellSize, double);
  vtkGetMacro(CellSize, double);
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
   * Coefficient of restitution Rv of the slope, 0 to 1, dimensionless. Default 0.8.
   */
  vtkSetMacro(RestitutionCoefficient, double);
  vtkGetMacro(RestitutionCoefficient, double);
  ///@}

  ///@{
  /**
   * Standard deviation of Rv between iterations, 0 to 1. Default 0.
   */
  vtkSetMacro(RestitutionDeviation, double);
  vtkGetMacro(RestitutionDeviation, double);
  ///@}

  ///@{
  /**
   * Friction angle between rock and slope in degrees, 0 to below 90. Default 15.
   */
  vtkSetMacro(FrictionAngle, double);
  vtkGetMacro(FrictionAngle, double);
  ///@}

  ///@{
  /**
   * Standard deviation of the friction angle in degrees, 0 to below 90. Default 0.
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
   * Mean of the random elevation added to every node in each iteration, in metres. Default 0.
   */
  vtkSetMacro(RoughnessMean, double);
  vtkGetMacro(RoughnessMean, double);
  ///@}

  ///@{
  /**
   * Standard deviation of the random elevation added to every node, in metres, not negative.
   * Default 0.
   */
  vtkSetMacro(RoughnessDeviation, double);
  vtkGetMacro(RoughnessDeviation, double);
  ///@}

  ///@{
  /**
   * Largest number of triangles that the output may have, at least 2. A bigger slope is shown with
   * every second, third, ... node only (a note says so); the simulation always uses every node. The
   * CFEId of a triangle of such a coarse mesh is that of the CFE in the full network that shares
   * its north-west node and lies on the same side of the diagonal. Default 4 million.
   */
  vtkSetMacro(MaximumDisplayCells, vtkIdType);
  vtkGetMacro(MaximumDisplayCells, vtkIdType);
  ///@}

  vtkDEMToCFESource(const vtkDEMToCFESource&) = delete;
  void operator=(const vtkDEMToCFESource&) = delete;

protected:
  vtkDEMToCFESource();
  ~vtkDEMToCFESource() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  std::string FileName;
  double CellSize = 0.0;
  int Band = 1;
  double RestitutionCoefficient = 0.8;
  double RestitutionDeviation = 0.0;
  double FrictionAngle = 15.0;
  double FrictionAngleDeviation = 0.0;
  double Cohesion = 0.0;
  double RoughnessMean = 0.0;
  double RoughnessDeviation = 0.0;
  vtkIdType MaximumDisplayCells = 4000000;
};

#endif
