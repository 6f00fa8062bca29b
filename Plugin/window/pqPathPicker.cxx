#include "pqPathPicker.h"

#include "looks.h"

#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"

#include <QEvent>
#include <QMouseEvent>
#include <QWidget>

#include <cmath>

namespace
{

constexpr int kReach = 4; ///< px about the click: paths are 3 px wide.

bool showsPaths(vtkSMProxy* representation)
{
  const rockfall::window::Shown shown = rockfall::window::shownBy(representation);
  return rockfall::window::isOf(shown.source, { "vtkGrowingPaths" }) ||
    (rockfall::window::isOf(shown.source, { "vtkRockfallSimulation" }) && shown.port == 1);
}

} // namespace

//-----------------------------------------------------------------------------
void pqPathPicker::begin(pqRenderView* view)
{
  this->end();
  this->View = view;
  this->Widget = view->widget();
  this->Widget->installEventFilter(this);
  this->Widget->setCursor(Qt::CrossCursor);
}

//-----------------------------------------------------------------------------
void pqPathPicker::end()
{
  if (this->Widget)
  {
    this->Widget->removeEventFilter(this);
    this->Widget->unsetCursor();
  }
  this->Widget.clear();
}

//-----------------------------------------------------------------------------
bool pqPathPicker::eventFilter(QObject* watched, QEvent* event)
{
  const bool press = event->type() == QEvent::MouseButtonPress;
  if (watched != this->Widget || (!press && event->type() != QEvent::MouseButtonRelease))
  {
    return this->Superclass::eventFilter(watched, event);
  }
  auto* mouse = static_cast<QMouseEvent*>(event);
  if (mouse->button() != Qt::LeftButton)
  {
    this->end();
    return false;
  }
  if (!press)
  {
    this->end();
    this->pick(mouse->pos());
  }
  return true; // the camera stays
}

//-----------------------------------------------------------------------------
void pqPathPicker::pick(const QPoint& place)
{
  auto* view =
    this->View ? vtkSMRenderViewProxy::SafeDownCast(this->View->getViewProxy()) : nullptr;
  if (!view)
  {
    return;
  }
  const double ratio = this->View->widget()->devicePixelRatioF();
  const int x = int(std::lround(ratio * place.x()));
  const int y = int(std::lround(ratio * (this->View->widget()->height() - 1 - place.y())));
  const int region[4] = { x - kReach, y - kReach, x + kReach, y + kReach };
  vtkNew<vtkCollection> representations, selections;
  view->SelectSurfaceCells(region, representations, selections, true);
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (int k = 0; k < representations->GetNumberOfItems(); ++k)
  {
    auto* representation = vtkSMProxy::SafeDownCast(representations->GetItemAsObject(k));
    auto* selection = vtkSMSourceProxy::SafeDownCast(selections->GetItemAsObject(k));
    auto* shown = model->findItem<pqDataRepresentation*>(representation);
    if (!selection || !shown || !showsPaths(representation))
    {
      continue;
    }
    // Pairs of process and cell.
    vtkSMPropertyHelper ids(selection, "IDs");
    if (ids.GetNumberOfElements() < 2)
    {
      continue;
    }
    pqOutputPort* port = shown->getOutputPortFromInput();
    const int cell = int(ids.GetAsIdType(1));
    Q_EMIT this->picked(port, cell);
    return;
  }
  Q_EMIT this->missed();
}
