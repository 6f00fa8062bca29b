/**
 * @class   vtkDrawnStructure
 * @brief   puts a net, an embankment or a forest on a slope where it is drawn
 *
 * Input and output port 0 are a slope as of vtkDEMToCFESource; the output has one more structure,
 * and can be the input of another filter of this kind. Output port 1 shows all its structures.
 *
 * All values are taken as they come and checked when the filter runs.
 */
#ifndef vtkDrawnStructure_h
#define vtkDrawnStructure_h

#include "RockfallFiltersModule.h"
#include "listProperty.h"
#include "vtkPolyDataAlgorithm.h"

#include <string> // for notes
#include <vector> // for points

class ROCKFALLFILTERS_EXPORT vtkDrawnStructure : public vtkPolyDataAlgorithm
{
public:
  static vtkDrawnStructure* New();
  vtkTypeMacro(vtkDrawnStructure, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum KindOfStructure
  {
    NET = 0,
    EMBANKMENT = 1,
    FOREST = 2
  };
  ///@{
  /**
   * The kind of structure, one of KindOfStructure. Default NET.
   */
  vtkSetMacro(Kind, int);
  vtkGetMacro(Kind, int);
  ///@}

  ///@{
  /**
   * Points of the line of a net or an embankment, or corners of a forest, in world coordinates;
   * their z does not count. None (the default): a level line through the middle of the slope.
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
   * Height over ground of a net, or of the crest of an embankment, m, positive. Default 4.
   */
  vtkSetMacro(Height, double);
  vtkGetMacro(Height, double);
  ///@}

  ///@{
  /**
   * Height of the trees of a forest, m, positive. Default 20.
   */
  vtkSetMacro(TreeHeight, double);
  vtkGetMacro(TreeHeight, double);
  ///@}

  ///@{
  /**
   * Energy that a net takes, kJ, not negative. Default 1000.
   */
  vtkSetMacro(Capacity, double);
  vtkGetMacro(Capacity, double);
  ///@}

  ///@{
  /**
   * Of a net: way on which it stops its capacity, m, not negative, 0: not known. Default 0.
   */
  vtkSetMacro(Braking, double);
  vtkGetMacro(Braking, double);
  ///@}

  ///@{
  /**
   * Of a net: whether what it holds uses up its capacity for the next rock, and height left with
   * all of it used up, %, 0 to 100. Default off and 50.
   */
  vtkSetMacro(Wears, bool);
  vtkGetMacro(Wears, bool);
  vtkBooleanMacro(Wears, bool);
  vtkSetMacro(Residual, double);
  vtkGetMacro(Residual, double);
  ///@}

  ///@{
  /**
   * Of a net: volume of rock that fills it to the rope, m³ per m of its length, not negative, 0:
   * nothing does. Default 0.
   */
  vtkSetMacro(Fill, double);
  vtkGetMacro(Fill, double);
  ///@}

  ///@{
  /**
   * Of an embankment: width of its crest, m, positive, and horizontal way per vertical of its
   * sides, not negative. Default 2 and 1.5.
   */
  vtkSetMacro(CrestWidth, double);
  vtkGetMacro(CrestWidth, double);
  vtkSetMacro(SideSlope, double);
  vtkGetMacro(SideSlope, double);
  ///@}

  ///@{
  /**
   * Of a forest: stems per hectare, positive, their diameter, cm, positive, and whether they break
   * at the energy of their diameter. Default 300, 30 and on.
   */
  vtkSetMacro(StemsPerHectare, double);
  vtkGetMacro(StemsPerHectare, double);
  vtkSetMacro(Diameter, double);
  vtkGetMacro(Diameter, double);
  vtkSetMacro(TreesBreak, bool);
  vtkGetMacro(TreesBreak, bool);
  vtkBooleanMacro(TreesBreak, bool);
  ///@}

  vtkDrawnStructure(const vtkDrawnStructure&) = delete;
  void operator=(const vtkDrawnStructure&) = delete;

protected:
  vtkDrawnStructure();
  ~vtkDrawnStructure() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  void CheckProperties() const;               ///< Throws ParameterError.
  std::vector<std::string> IdleNotes() const; ///< On properties that have no effect.

  int Kind = NET;
  std::vector<double> Points; ///< x, y, z of each in turn.
  double PlacedLine[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double Height = 4.0;
  double Capacity = 1000.0;
  double Braking = 0.0;
  bool Wears = false;
  double Residual = 50.0;
  double Fill = 0.0;
  double CrestWidth = 2.0;
  double SideSlope = 1.5;
  double StemsPerHectare = 300.0;
  double Diameter = 30.0;
  double TreeHeight = 20.0;
  bool TreesBreak = true;
};

#endif
