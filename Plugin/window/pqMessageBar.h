#ifndef pqMessageBar_h
#define pqMessageBar_h

#include <QToolBar>

class QLabel;
class QMainWindow;

/**
 * A strip under the views with what the sources and filters of the pipeline have to say: why one
 * has failed, and what was done to an input. It stays as long as there is something to say, and
 * comes back after it was closed with what is new.
 */
class pqMessageBar : public QToolBar
{
  Q_OBJECT
  typedef QToolBar Superclass;

public:
  explicit pqMessageBar(QMainWindow* window);

  /// Looks at the pipeline.
  void look();

protected:
  void resizeEvent(QResizeEvent* event) override;

private:
  void fit();

  QLabel* Text;
  QString Shown;            // of the pipeline; also while it is closed
  QStringList Told, Closed; // lines at the last look, those that were closed and not gone since
};

#endif
