/**
 * @class   vtkTrajectoryLayerWriter
 * @brief   writes trajectories, impacts and crossings as GeoPackage or CSV
 *
 * By the extension of the file: .gpkg or .csv. Of lines a GeoPackage gets the layers "trajectories"
 * (3D lines with the time as measure m; the cell arrays as attributes), "ends" (their last points)
 * and, if WriteSamples is on, "samples" (all points with the point arrays); a CSV file gets the
 * first of them, with the geometry as WKT. Of vertices there is the layer "points". Arrays of three
 * components become three attributes that end in X, Y and Z. The CRS is that of the data. The file
 * is written beside and renamed when it is whole.
 */
#ifndef vtkTrajectoryLayerWriter_h
#define vtkTrajectoryLayerWriter_h

#include "RockfallFiltersModule.h"
#include "vtkWriter.h"

#include <string> // for FileName

class ROCKFALLFILTERS_EXPORT vtkTrajectoryLayerWriter : public vtkWriter
{
public:
  static vtkTrajectoryLayerWriter* New();
  vtkTypeMacro(vtkTrajectoryLayerWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Name of the file.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether a GeoPackage gets the points between the ends of the lines as well. Off by default.
   */
  vtkSetMacro(WriteSamples, bool);
  vtkGetMacro(WriteSamples, bool);
  vtkBooleanMacro(WriteSamples, bool);
  ///@}

  vtkTrajectoryLayerWriter(const vtkTrajectoryLayerWriter&) = delete;
  void operator=(const vtkTrajectoryLayerWriter&) = delete;

protected:
  vtkTrajectoryLayerWriter();
  ~vtkTrajectoryLayerWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  std::string FileName;
  bool WriteSamples = false;
};

#endif
