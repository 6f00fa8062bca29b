/**
 * @class   vtkHazardPassageReader
 * @brief   makes one hazard map of the passages of many runs
 *
 * Reads files of vtkHazardPassageWriter and makes the map that vtkRockfallHazardMap would make of
 * all their trajectories at once, bit for bit, whatever these are shared out over files. No file is
 * in memory as a whole. The point array Elevation is missing: the files know nothing of the slope.
 */
#ifndef vtkHazardPassageReader_h
#define vtkHazardPassageReader_h

#include "RockfallFiltersModule.h"
#include "vtkHazardMapAlgorithm.h"

#include <string> // for FileNames
#include <vector> // for FileNames

class ROCKFALLFILTERS_EXPORT vtkHazardPassageReader : public vtkHazardMapAlgorithm
{
public:
  static vtkHazardPassageReader* New();
  vtkTypeMacro(vtkHazardPassageReader, vtkHazardMapAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The files, of one grid and coordinate system.
   */
  void AddFileName(const char* fileName);
  void RemoveAllFileNames();
  ///@}

  /// 1 if the file is whole and one of passages, else 0.
  static int CanReadFile(const char* fileName);

  vtkHazardPassageReader(const vtkHazardPassageReader&) = delete;
  void operator=(const vtkHazardPassageReader&) = delete;

protected:
  vtkHazardPassageReader();
  ~vtkHazardPassageReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  std::vector<std::string> FileNames;
};

#endif
