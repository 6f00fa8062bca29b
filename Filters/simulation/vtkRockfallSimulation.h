/**
 * @class   vtkRockfallSimulation
 * @brief   lets rock blocks fall on a slope, by 3D discontinuous deformation analysis
 *
 * Input port 0 is the terrain, from vtkDEMToCFESource; input port 1 the rocks, closed convex
 * polygonal blocks told apart by the cell array BlockId, as from vtkRockBlockSource.
 *
 * Output ports:
 *  - 0: the blocks of iteration ShownIteration at the requested time. Cell arrays BlockId, RockId,
 *    Iteration, Velocity, Speed, RotationRate, KineticEnergy, HeightOverGround, State (0 flying,
 *    1 in contact, 2 stopped, 3 has left the domain: shown where and as it left), Shape, Volume.
 *  - 1: one polyline of centroids per rock and iteration. Point arrays Time, Velocity, Speed,
 *    RotationRate (about x, y, z), KineticEnergy, HeightOverGround; cell arrays BlockId, RockId,
 *    Iteration, Shape, Volume, Fate (0 rested, 1 left the domain, 2 still moving at the end,
 *    3 caught by a barrier).
 *  - 2: one vertex per impact. Point arrays BlockId, RockId, Iteration, Time, Normal, CFEId,
 * Impulse, ApproachSpeed, VelocityBefore, VelocityAfter, EnergyLoss, Restitution.
 *  - 3: a table, one row per rock and iteration, with the field array StateHash.
 *  - 4: one vertex per meeting with a barrier or a tree that broke. Point arrays BlockId, RockId,
 *    Iteration, StructureId, Outcome (0 stopped, 1 barrier broken, 2 recorded, 3 tree broken, 4 tree
 *    that stands and turned the rock), Time, Velocity, Speed, KineticEnergy, HeightOverGround (of the centre), EnergyTaken.
 *
 * The run is simulated once; any time is then served from it until a property or an input changes.
 * The time steps are those from 0 to EndTime at OutputInterval, whenever the last rock stops: this
 * is known only after the run, and a time range that changes then would move an animation's end.
 *
 * On several ranks (mpiexec with pvbatch or pvserver) the work is shared out: whichever rank has
 * the inputs passes them on, and the outputs come together on the first one, the others' are empty.
 * Results are the same, bit for bit, for any number of ranks and threads. Every rank has to update
 * the filter.
 *
 * All values are taken as they come and checked when the filter runs, so that a bad one gives one
 * error that names it instead of being changed silently.
 */
#ifndef vtkRockfallSimulation_h
#define vtkRockfallSimulation_h

#include "RockfallFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

#include <memory> // for the run
#include <string> // for messages
#include <vector> // for notes

namespace rockfall
{
namespace filters // VTK's wrappers read no nested name
{
class CurrentRun;
struct KeptRun;
struct RunInputs;
}
}

class ROCKFALLFILTERS_EXPORT vtkRockfallSimulation : public vtkPolyDataAlgorithm
{
public:
  static vtkRockfallSimulation* New();
  vtkTypeMacro(vtkRockfallSimulation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Time step of lasting contact in seconds, positive. Impacts are resolved finer by themselves.
   * Default 0.005.
   */
  vtkSetMacro(TimeStep, double);
  vtkGetMacro(TimeStep, double);
  ///@}

  ///@{
  /**
   * End of the simulation in seconds, positive. Default 60.
   */
  vtkSetMacro(EndTime, double);
  vtkGetMacro(EndTime, double);
  ///@}

  ///@{
  /**
   * Time between samples, and so between time steps of the output, in seconds, positive. Does not
   * change the motion. Default 0.05.
   */
  vtkSetMacro(OutputInterval, double);
  vtkGetMacro(OutputInterval, double);
  ///@}

  ///@{
  /**
   * Gravity in m/s², not negative. Default 9.81.
   */
  vtkSetMacro(Gravity, double);
  vtkGetMacro(Gravity, double);
  ///@}

  ///@{
  /**
   * Stiffness of the normal contact springs in N/m, not negative. 0, the default: by mass and ground.
   */
  vtkSetMacro(NormalPenalty, double);
  vtkGetMacro(NormalPenalty, double);
  ///@}

  ///@{
  /**
   * Stiffness of the shear springs over that of the normal ones, positive, dimensionless.
   * Default 1.
   */
  vtkSetMacro(ShearPenaltyRatio, double);
  vtkGetMacro(ShearPenaltyRatio, double);
  ///@}

  ///@{
  /**
   * Number of independent realisations of roughness, restitution and friction, at least 1.
   * Default 1.
   */
  vtkSetMacro(Iterations, int);
  vtkGetMacro(Iterations, int);
  ///@}

  ///@{
  /**
   * Number of the first iteration, at least 0. Default 0. Iterations 10 to 19 are the same whether
   * they are run alone or among 0 to 99.
   */
  vtkSetMacro(FirstIteration, int);
  vtkGetMacro(FirstIteration, int);
  ///@}

  ///@{
  /**
   * With iteration and rock it determines every random number. Default 1.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Whether the rocks of an iteration fall together, hit each other, pile up and push each other.
   * Default off.
   */
  vtkSetMacro(RockRockContact, bool);
  vtkGetMacro(RockRockContact, bool);
  vtkBooleanMacro(RockRockContact, bool);
  ///@}

  ///@{
  /**
   * Coefficient of restitution (0 to 1), friction angle (degrees, 0 to 89) and cohesion (N per
   * contact point) between rocks. Used with RockRockContact only.
   */
  vtkSetMacro(RockRestitution, double);
  vtkGetMacro(RockRestitution, double);
  vtkSetMacro(RockFrictionAngle, double);
  vtkGetMacro(RockFrictionAngle, double);
  vtkSetMacro(RockCohesion, double);
  vtkGetMacro(RockCohesion, double);
  ///@}

  ///@{
  /**
   * A table of pairs of materials that have another restitution, friction angle and cohesion than
   * the three above: anything OGR opens, see docs/mass_falls.md. Empty (the default): none. Read
   * when a run is made, with RockRockContact only. The sheet is that of a file with several tables
   * that would do.
   */
  vtkSetStdStringFromCharMacro(RockContactFile);
  vtkGetCharFromStdStringMacro(RockContactFile);
  vtkSetStdStringFromCharMacro(RockContactSheet);
  vtkGetCharFromStdStringMacro(RockContactSheet);
  ///@}

  ///@{
  /**
   * Whether RockContactFile may name network addresses and other files of the machine. Off by
   * default, because a file that came from somebody else could have any file read, or an address
   * called. Files beside it need no leave.
   */
  vtkSetMacro(AllowReferences, int);
  vtkGetMacro(AllowReferences, int);
  vtkBooleanMacro(AllowReferences, int);
  ///@}

  ///@{
  /**
   * Whether rocks that overlap at the start are pushed apart instead of being an error. Used with
   * RockRockContact only. Default off.
   */
  vtkSetMacro(PushRocksApart, bool);
  vtkGetMacro(PushRocksApart, bool);
  vtkBooleanMacro(PushRocksApart, bool);
  ///@}

  ///@{
  /**
   * Whether rocks break into pieces in impacts on the slope, see docs/fragmentation.md. Default off;
   * without RockRockContact only. The energy that an impact's normal velocity has before it, by
   * volume, from which rocks break (J/m³); the fractal dimension of the pieces' volumes (0 < D < 3);
   * the volume of the smallest piece that is followed (m³): the three have no default. Share of such
   * impacts that leave a rock whole, 0 to 1 (0). Share of the kinetic energy that breaking takes, 0
   * to 1 (0). Half angle of the cone of the pieces' directions, degrees, 0 to 90 (0).
   */
  vtkSetMacro(Fragmentation, bool);
  vtkGetMacro(Fragmentation, bool);
  vtkBooleanMacro(Fragmentation, bool);
  vtkSetMacro(FragmentationEnergy, double);
  vtkGetMacro(FragmentationEnergy, double);
  vtkSetMacro(FractalDimension, double);
  vtkGetMacro(FractalDimension, double);
  vtkSetMacro(LeastFragment, double);
  vtkGetMacro(LeastFragment, double);
  vtkSetMacro(SurvivalRate, double);
  vtkGetMacro(SurvivalRate, double);
  vtkSetMacro(FragmentationLoss, double);
  vtkGetMacro(FragmentationLoss, double);
  vtkSetMacro(FragmentSpread, double);
  vtkGetMacro(FragmentSpread, double);
  ///@}

  ///@{
  /**
   * Whether blocks are rigid (6 unknowns) instead of deformable (12). Default off.
   */
  vtkSetMacro(Rigid, bool);
  vtkGetMacro(Rigid, bool);
  vtkBooleanMacro(Rigid, bool);
  ///@}

  enum ImpactResolutions
  {
    IMPULSE = 0,
    SPRINGS = 1
  };
  ///@{
  /**
   * What resolves impacts of a stiff rock by itself on hard ground: IMPULSE, one event
   * in impulse space; SPRINGS (the default), steps of springs and dashpots, as all other impacts.
   */
  vtkSetMacro(ImpactResolution, int);
  vtkGetMacro(ImpactResolution, int);
  ///@}

  ///@{
  /**
   * Number of threads of each rank; 0 (the default) takes all, shared out over the ranks of a
   * machine. Results do not depend on it.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The iteration that port 0 shows, counted from 0 (the default) whatever FirstIteration is.
   * The other ports hold all of them. Changing it does not simulate all again: that iteration at
   * most.
   */
  vtkSetMacro(ShownIteration, int);
  vtkGetMacro(ShownIteration, int);
  ///@}

  enum TrajectoryOutputs
  {
    NOTHING = 0,
    STOPPING_POINTS = 1,
    EVENTS = 2,
    THINNED = 3,
    FULL = 4
  };
  ///@{
  /**
   * The part of each trajectory on port 1: NOTHING; STOPPING_POINTS, a vertex where it ended;
   * EVENTS, a polyline of release, touches, take-offs and end; THINNED, of all points between which
   * the motion is one cubic; FULL (the default), of all samples, with the energy audit.
   */
  vtkSetMacro(TrajectoryOutput, int);
  vtkGetMacro(TrajectoryOutput, int);
  ///@}

  ///@{
  /**
   * Whether port 2 has the impacts. Default on.
   */
  vtkSetMacro(KeepImpacts, bool);
  vtkGetMacro(KeepImpacts, bool);
  vtkBooleanMacro(KeepImpacts, bool);
  ///@}

  ///@{
  /**
   * Whether a run tells on the terminal (standard error) how far it is and how long it will take.
   * Default off.
   */
  vtkSetMacro(PrintProgress, bool);
  vtkGetMacro(PrintProgress, bool);
  vtkBooleanMacro(PrintProgress, bool);
  ///@}

  ///@{
  /**
   * Whether a run tells of what it lost, and of rocks and iterations that are odd. The output's
   * field array Notes has what was lost in any case. Default on.
   */
  vtkSetMacro(PrintNotes, bool);
  vtkGetMacro(PrintNotes, bool);
  vtkBooleanMacro(PrintNotes, bool);
  ///@}

  /**
   * 16 hexadecimal digits over the bits of all motion of the last run, empty if there is none. Two
   * runs that differ in threads, ranks, OutputInterval or what is kept have the same.
   */
  const char* GetStateHash() const;

  ///@{
  /**
   * The inputs for ParaView, whose Python connects whatever is active to the first input of a
   * proxy: to it that is the rocks. The number is its, and does not count.
   */
  void SetRocksConnection(vtkAlgorithmOutput* rocks);
  void SetTerrainConnection(int, vtkAlgorithmOutput* terrain);
  void RemoveRocks() { this->SetRocksConnection(nullptr); }
  void RemoveTerrain() { this->SetTerrainConnection(0, nullptr); }
  ///@}

  ///@{
  /**
   * A window that goes on asking whether there is news (ParaView's live sources) is not kept
   * waiting: the run has threads of its own, outputs have the trajectories made so far, and there
   * is news about once a second until it is over. What then comes out is the same, bit for bit.
   * Whoever never asks, as scripts, waits for the end of the run. So do several ranks.
   */
  bool GetNeedsUpdate();
  /// Ends a run that goes on; the trajectories made so far stay.
  void Stop();
  /// Makes all trajectories anew, as after a Stop.
  void RunAgain();
  /// State of the run: "running: 12,300 of 100,000 trajectories (12 %), about 3 min 20 s left".
  const char* GetRunStatus();
  ///@}

  /**
   * The version of the program, "1.2.3". ParaView 6.1 does not say that of its plugins.
   */
  const char* GetProgramVersion();

  /**
   * How often this filter has simulated since it was made.
   */
  int GetNumberOfRuns() const;

  vtkRockfallSimulation(const vtkRockfallSimulation&) = delete;
  void operator=(const vtkRockfallSimulation&) = delete;

protected:
  vtkRockfallSimulation();
  ~vtkRockfallSimulation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  struct Failure;

  /// Reports an error of this execution, once for all ranks, and remembers of what it is the error.
  int Fail(vtkPolyData* terrain, vtkPolyData* rocks, const std::string& message);
  /// A run of these inputs with the properties, not made yet.
  std::unique_ptr<rockfall::filters::KeptRun> WantedRun(vtkPolyData* terrain, vtkPolyData* rocks);
  std::vector<std::string> IdleNotes() const; ///< On properties that have no effect.
  void CheckProperties(const rockfall::filters::KeptRun& run) const; ///< Throws ParameterError.

  double TimeStep = 0.005;
  double EndTime = 60.0;
  double OutputInterval = 0.05;
  double Gravity = 9.81;
  double NormalPenalty = 0.0;
  double ShearPenaltyRatio = 1.0;
  int Iterations = 1;
  int Seed = 1;
  bool RockRockContact = false;
  double RockRestitution = 0.5;
  double RockFrictionAngle = 30.0;
  double RockCohesion = 0.0;
  std::string RockContactFile;
  std::string RockContactSheet;
  int AllowReferences = 0;
  bool PushRocksApart = false;
  bool Fragmentation = false;
  double FragmentationEnergy = 0.0;
  double FractalDimension = 0.0;
  double LeastFragment = 0.0;
  double SurvivalRate = 0.0;
  double FragmentationLoss = 0.0;
  double FragmentSpread = 0.0;
  bool Rigid = false;
  int ImpactResolution = SPRINGS;
  int NumberOfThreads = 0;
  int ShownIteration = 0;
  int FirstIteration = 0;
  int TrajectoryOutput = FULL;
  bool KeepImpacts = true;
  bool PrintProgress = false;
  bool PrintNotes = true;
  std::unique_ptr<rockfall::filters::CurrentRun> Current;
  std::unique_ptr<rockfall::filters::RunInputs> Taken;
  std::unique_ptr<Failure> Failed;
};

#endif
