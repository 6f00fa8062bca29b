#include "pqPathPicker.h"

#include "looks.h"
#include "proxyNumbers.h"

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

#include <algorithm>
#include <cmath>

namespace
{

using rockfall::window::Shown;

constexpr int kReach = 4;                           ///< px about the click: paths are 3 px wide.
constexpr double kFaded = 0.25;                     ///< Opacity of paths one of which is picked.
constexpr const char* kOpacity = "RockfallOpacity"; ///< Annotation: that before.

/// The whole paths that a representation shows; without source where it shows none.
Shown pathsOf(vtkSMProxy* representation)
{
  const Shown shown = rockfall::window::wholePaths(rockfall::window::shownBy(representation));
  const bool paths =
    rockfall::window::isOf(shown.source, { "vtkRockfallSimulation" }) && shown.port == 1;
  return paths ? shown : Shown();
}

} // namespace

//-----------------------------------------------------------------------------
void pqPathPicker::fade(vtkSMProxy* profile, bool faded)
{
  const Shown of = rockfall::window::shownBy(profile); // its input
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqDataRepresentation* item : model->findItems<pqDataRepresentation*>())
  {
    vtkSMProxy* shown = item->getProxy();
    const Shown paths = pathsOf(shown);
    if (!paths.source || paths.source != of.source || paths.port != of.port ||
      !shown->GetProperty("Opacity") || shown->HasAnnotation(kOpacity) == faded)
    {
      continue;
    }
    const double now = vtkSMPropertyHelper(shown, "Opacity").GetAsDouble();
    if (faded)
    {
      shown->SetAnnotation(kOpacity, QByteArray::number(now).constData());
      rockfall::window::set(shown, "Opacity", kFaded);
    }
    else
    {
      if (now == kFaded) // not what somebody has set since
      {
        rockfall::window::set(
          shown, "Opacity", QByteArray(shown->GetAnnotation(kOpacity)).toDouble());
      }
      shown->RemoveAnnotation(kOpacity);
    }
    shown->UpdateVTKObjects();
    item->renderViewEventually();
  }
}

//-----------------------------------------------------------------------------
bool pqPathPicker::hasPaths(const pqRenderView* view)
{
  const QList<pqRepresentation*> shown = view->getRepresentations();
  return std::any_of(shown.begin(), shown.end(),
    [](const pqRepresentation* one)
    { return one->isVisible() && pathsOf(one->getProxy()).source; });
}

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
    if (!selection || !shown || !pathsOf(representation).source)
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
