#ifndef pqRunBar_h
#define pqRunBar_h

#include <QTimer>
#include <QWidget>

class QLabel;
class QMainWindow;
class QPushButton;

/**
 * What runs do, in the window's status bar, and a button that stops them: the one of the panel is
 * far down, and only where the simulation is chosen.
 */
class pqRunBar : public QWidget
{
  Q_OBJECT
  typedef QWidget Superclass;

public:
  explicit pqRunBar(QMainWindow* window);

  /// The state of runs; empty: nothing new. Of those that have ended it stays for a while.
  void tell(const QString& state, bool running);

Q_SIGNALS:
  void stopped();

private:
  QLabel* State;
  QPushButton* Stop;
  QTimer Gone;
};

#endif
