#ifndef pqRockfallWindow_h
#define pqRockfallWindow_h

#include <QMap>
#include <QObject>
#include <QSet>
#include <QString>
#include <QTimer>

class QMainWindow;
class pqOutputPort;
class pqPathPicker;
class pqPipelineSource;
class pqProxy;
class pqRepresentation;
class pqRunBar;
class pqServer;
class pqView;
class vtkObject;
class vtkSMSourceProxy;

/**
 * The plugin in a window: the Rockfall menu; the looks of what is shown first; drawn
 * lines that begin where the slope or the paths are; ground that yields, and the numbers of presets
 * in the panel; a chart of the trajectory that is clicked; the state of runs in the status bar;
 * animations in real time that end with the last rock.
 */
class pqRockfallWindow : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  explicit pqRockfallWindow(QObject* parent = nullptr);

  /// Waits for the window, which comes after its plugins.
  void begin();

protected:
  /// Says why ParaView's key P does nothing beside the slope.
  bool eventFilter(QObject* watched, QEvent* event) override;

private Q_SLOTS:
  void onSource(pqPipelineSource* source);
  void onMade(pqProxy* made);
  void onRepresentation(pqRepresentation* representation);
  void onColours(vtkObject* property);
  void onData(pqPipelineSource* source);
  void onPreset(vtkObject* property, unsigned long event);
  void onPicked(pqOutputPort* port, int cell);
  void onRemoved(pqPipelineSource* source);
  void tellRuns();
  void stopRuns();

private:
  void makeMenu(QMainWindow* window);
  void endWithLastRock(pqServer* server);
  /// ParaView draws the active view alone while a run goes on, and charts would stay behind.
  void drawCharts(vtkSMSourceProxy* run);
  void lookAtTime();
  void keepOwnEnd();
  void runPython(const QString& statement);
  /// What a script has made, it has drawn: whole runs are not drawn once more.
  void settleRuns();
  void makeReport(const QString& manifest);
  void pickTrajectory();
  /// Puts the rocks of its slope on the structure that is chosen in the pipeline.
  void meetStructure();
  void tell(const QString& message);

  pqPathPicker* Picker;
  pqRunBar* Bar = nullptr;
  QTimer Clock, Looks;    // at the panel and what is drawn, at runs
  int Pictures = 0;       // that were taken
  int Checks = 0;         // of tests, that were made
  double LastEnd = -1.0;  // that animations were given, s
  bool OwnsEnd = false;   // whether animations end where they were told to, at the last look
  bool AtEnd = false;     // whether somebody looks at that time, and so at whole paths
  bool Waiting = true;    // for rocks that came to their end
  bool EndsAnew = false;  // a run has handed on what may end at another time
  bool Scripting = false; // a statement of Python is going on
  QSet<QString> Running;  // names of the runs that were told of last
  QMap<QString, QString> Settled; // state hash by name: of the run that all views have
};

#endif
