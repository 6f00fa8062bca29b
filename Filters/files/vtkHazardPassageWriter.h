/**
 * @class   vtkHazardPassageWriter
 * @brief   writes the passages that a hazard map is made of
 *
 * Input port 0 has one polyline per trajectory, as port 1 of vtkRockfallSimulation, port 1 the
 * terrain of vtkDEMToCFESource. The file has one record for each rock, iteration and cell it was
 * in. vtkHazardPassageReader makes one map of any number of such files. The file is written beside
 * and renamed when it is whole.
 */
#ifndef vtkHazardPassageWriter_h
#define vtkHazardPassageWriter_h

#include "RockfallFiltersModule.h"
#include "vtkWriter.h"

#include <string> // for FileName

class ROCKFALLFILTERS_EXPORT vtkHazardPassageWriter : public vtkWriter
{
public:
  static vtkHazardPassageWriter* New();
  vtkTypeMacro(vtkHazardPassageWriter, vtkWriter);
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
   * Edge of the cells in metres, not negative. 0 (the default): the terrain's cells.
   */
  vtkSetMacro(CellSize, double);
  vtkGetMacro(CellSize, double);
  ///@}

  ///@{
  /**
   * Whether a rock that is wider than a cell touches every cell under it, as
   * vtkRockfallHazardMap has it. On by default.
   */
  vtkSetMacro(RockWidth, bool);
  vtkGetMacro(RockWidth, bool);
  vtkBooleanMacro(RockWidth, bool);
  ///@}

  vtkHazardPassageWriter(const vtkHazardPassageWriter&) = delete;
  void operator=(const vtkHazardPassageWriter&) = delete;

protected:
  vtkHazardPassageWriter();
  ~vtkHazardPassageWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  std::string FileName;
  double CellSize = 0.0;
  bool RockWidth = true;
};

#endif
