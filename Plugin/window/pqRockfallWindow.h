#ifndef pqRockfallWindow_h
#define pqRockfallWindow_h

#include <QObject>
#include <QSet>
#include <QString>
#include <QTimer>

class QMainWindow;
class pqPipelineSource;
class pqRepresentation;
class pqView;

/**
 * What the plugin does in a window: the Rockfall menu; the looks of what is shown first; drawn
 * lines that begin where the slope or the paths are; the state of runs in the status bar;
 * animations that end with the last rock.
 */
class pqRockfallWindow : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  explicit pqRockfallWindow(QObject* parent = nullptr);

  /// Waits for the window, which comes after its plugins.
  void begin();

private Q_SLOTS:
  void onSource(pqPipelineSource* source);
  void onRepresentation(pqRepresentation* representation);
  void onData(pqPipelineSource* source);
  void tellRuns();

private:
  void makeMenu(QMainWindow* window);
  void runPython(const QString& statement);

  QTimer Clock;
  int Pictures = 0;      // that were taken
  QSet<QString> Running; // names of the runs that were told of last
};

#endif
