/**
 * @class   vtkHazardMapWriter
 * @brief   writes a map of vtkRockfallHazardMap as GeoTIFF
 *
 * One band per cell array, named as it is, 32-bit floats with nodata NaN, in the CRS of the map. A
 * cloud optimized GeoTIFF (COG) where GDAL can. The file is written beside and renamed when it is
 * whole.
 */
#ifndef vtkHazardMapWriter_h
#define vtkHazardMapWriter_h

#include "RockfallFiltersModule.h"
#include "vtkWriter.h"

#include <string> // for FileName

class ROCKFALLFILTERS_EXPORT vtkHazardMapWriter : public vtkWriter
{
public:
  static vtkHazardMapWriter* New();
  vtkTypeMacro(vtkHazardMapWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Name of the file.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  vtkHazardMapWriter(const vtkHazardMapWriter&) = delete;
  void operator=(const vtkHazardMapWriter&) = delete;

protected:
  vtkHazardMapWriter();
  ~vtkHazardMapWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  std::string FileName;
};

#endif
