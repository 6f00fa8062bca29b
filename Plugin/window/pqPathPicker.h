#ifndef pqPathPicker_h
#define pqPathPicker_h

#include <QObject>
#include <QPointer>

class QPoint;
class QWidget;
class pqOutputPort;
class pqRenderView;
class vtkSMProxy;

/**
 * Finds the trajectory that the next click into a view hits, some pixels about.
 */
class pqPathPicker : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  using Superclass::Superclass;

  /// Whether the view shows paths.
  static bool hasPaths(const pqRenderView* view);
  /// Takes the view's next click with the left button; any other one ends the waiting.
  void begin(pqRenderView* view);
  void end();

  /// Paths are pale while this profile shows one of them: as many as they are they would hide it.
  static void fade(vtkSMProxy* profile, bool faded);

Q_SIGNALS:
  /// `cell`: number of the line in what the port gives.
  void picked(pqOutputPort* port, int cell);
  void missed();

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void pick(const QPoint& place);

  QPointer<pqRenderView> View;
  QPointer<QWidget> Widget;
};

#endif
