// Runs in the window: their state in the status bar, new data in the views, and animations that end
// with the last rock.

#include "pqRockfallWindow.h"

#include "looks.h"
#include "panel.h"
#include "undo.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqRepresentation.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <QList>
#include <QMainWindow>
#include <QStatusBar>

#include <algorithm>
#include <vector>

namespace
{

using rockfall::window::isOf;

/// Whether ParaView is in the middle of an update: timers go on in it, and what they ask for is
/// lost.
bool isUpdating()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqServer* server : model->findItems<pqServer*>())
  {
    if (server->session() && server->session()->GetPendingProgress())
    {
      return true;
    }
  }
  return false;
}

/// All views, with what is new in their pipelines and with palettes, legends and charts that go with
/// it, before this returns. Each is drawn once: a slope of a million cells takes half a second. Charts
/// are the first ones: the paths of a large run take seconds.
void renderNow()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QList<pqView*> views = model->findItems<pqView*>();
  std::stable_partition(
    views.begin(), views.end(), [](pqView* view) { return !qobject_cast<pqRenderView*>(view); });
  for (pqView* view : views)
  {
    view->getViewProxy()->Update();
    for (pqRepresentation* shown : view->getRepresentations())
    {
      if (shown->isVisible())
      {
        rockfall::window::follow(shown->getProxy(), view->getViewProxy());
      }
    }
    view->forceRender();
  }
}

/// Whether any view is at another time.
bool isElsewhere(double time)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  const QList<pqView*> views = model->findItems<pqView*>();
  return std::any_of(views.begin(), views.end(),
    [time](pqView* view)
    {
      return view->getProxy()->GetProperty("ViewTime") &&
        vtkSMPropertyHelper(view->getProxy(), "ViewTime").GetAsDouble() != time;
    });
}

vtkFieldData* fieldsOf(vtkSMSourceProxy* run, int port)
{
  auto* algorithm = vtkAlgorithm::SafeDownCast(run->GetClientSideObject());
  vtkDataObject* data = algorithm ? algorithm->GetOutputDataObject(port) : nullptr;
  return data ? data->GetFieldData() : nullptr;
}

/// Whether what a run has handed on is a part of it, as its trajectories say.
bool showsPart(vtkSMSourceProxy* run)
{
  vtkFieldData* fields = fieldsOf(run, 1);
  return fields && fields->GetAbstractArray("RunGoesOn");
}

/// The state hash of a whole run that has been handed on; empty: none, or not known here.
QString stateOf(vtkSMSourceProxy* run)
{
  vtkFieldData* fields = fieldsOf(run, 3);
  auto* hash =
    vtkStringArray::SafeDownCast(fields ? fields->GetAbstractArray("StateHash") : nullptr);
  return hash && hash->GetNumberOfValues() > 0 ? QString::fromStdString(hash->GetValue(0))
                                               : QString();
}

/// More frames than these Play does not take for the fall of a study: 12 s at 20 a second.
constexpr std::size_t kMostFrames = 240;

/// End of a run: the time step by which its last rock has come to its end, s, and how many steps Play
/// goes on from frame to frame.
struct RunEnd
{
  double time = 0.0; ///< 0 if it is not known here.
  int stride = 1;
};

/// ParaView goes from step to step: with an end between two it would go past it, and begin anew. So
/// the end is a whole number of strides away where there are so many steps.
RunEnd lastEnd(vtkSMSourceProxy* run)
{
  auto* algorithm = vtkAlgorithm::SafeDownCast(run->GetClientSideObject());
  auto* table = algorithm ? vtkTable::SafeDownCast(algorithm->GetOutputDataObject(3)) : nullptr;
  vtkDataArray* ends = table ? table->GetRowData()->GetArray("EndTime") : nullptr;
  if (!ends || ends->GetNumberOfTuples() == 0)
  {
    return {};
  }
  const double end = ends->GetRange(0)[1];
  const std::vector<double> steps =
    vtkSMPropertyHelper(run, "TimestepValues", true).GetDoubleArray();
  const auto step = std::lower_bound(steps.begin(), steps.end(), end);
  if (step == steps.end())
  {
    return { end, 1 };
  }
  const auto index = std::size_t(step - steps.begin());
  const std::size_t stride = index / kMostFrames + 1;
  const std::size_t last = std::min((index + stride - 1) / stride * stride, steps.size() - 1);
  return { steps[last], int(stride) };
}

/// The same of all runs.
RunEnd lastEnd(pqServer* server)
{
  RunEnd end;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* run : model->findItems<pqPipelineSource*>(server))
  {
    if (isOf(run->getProxy(), { "vtkRockfallSimulation" }))
    {
      const RunEnd of = lastEnd(run->getSourceProxy());
      end = of.time > end.time ? of : end;
    }
  }
  return end;
}

vtkSMProxy* sceneOf(pqServer* server)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  return controller->GetAnimationScene(server->session());
}

} // namespace

//-----------------------------------------------------------------------------
void pqRockfallWindow::endWithLastRock(pqServer* server)
{
  const RunEnd run = lastEnd(server);
  const double end = run.time;
  vtkSMProxy* scene = sceneOf(server);
  if (!scene || !(end > 0.0))
  {
    return;
  }
  // A time that the user has locked stays.
  if (vtkSMPropertyHelper(scene, "LockEndTime").GetAsInt() &&
    vtkSMPropertyHelper(scene, "EndTime").GetAsDouble() != this->LastEnd)
  {
    this->OwnsEnd = false;
    return;
  }
  vtkSMPropertyHelper now(scene, "AnimationTime");
  const bool atEnd = this->LastEnd > 0.0 && (this->AtEnd || now.GetAsDouble() == this->LastEnd);
  if (end != this->LastEnd)
  {
    vtkSMPropertyHelper(scene, "Stride", true).Set(run.stride); // else as the user has it
  }
  this->LastEnd = end;
  this->OwnsEnd = true;
  vtkSMPropertyHelper(scene, "LockEndTime").Set(1);
  vtkSMPropertyHelper(scene, "EndTime").Set(end);
  if (atEnd || now.GetAsDouble() > end)
  {
    now.Set(end); // whoever looks at whole paths goes on doing so
  }
  scene->UpdateVTKObjects();
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::drawCharts(vtkSMSourceProxy* run)
{
  if (!showsPart(run))
  {
    return;
  }
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqView* view : model->findItems<pqView*>())
  {
    if (!qobject_cast<pqRenderView*>(view))
    {
      view->render(); // soon
    }
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::keepOwnEnd()
{
  // Undo brings back all of a scene in which ParaView has changed anything, its end with it.
  pqServer* server = pqActiveObjects::instance().activeServer();
  vtkSMProxy* scene = server ? sceneOf(server) : nullptr;
  if (scene && this->OwnsEnd)
  {
    const rockfall::window::NotUndone own;
    this->LastEnd = vtkSMPropertyHelper(scene, "EndTime").GetAsDouble();
    this->endWithLastRock(server);
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::lookAtTime()
{
  pqServer* server = pqActiveObjects::instance().activeServer();
  vtkSMProxy* scene = server ? sceneOf(server) : nullptr;
  const double end = server ? lastEnd(server).time : 0.0;
  // While there are no rocks ParaView sets times of its own, which tell of nobody's wish.
  if (!scene || !(end > 0.0) || !this->Running.isEmpty())
  {
    this->Waiting = true;
    return;
  }
  if (!this->Waiting)
  {
    this->AtEnd = vtkSMPropertyHelper(scene, "AnimationTime").GetAsDouble() == this->LastEnd;
  }
  else if (this->AtEnd && end == this->LastEnd && isElsewhere(end)) // than the scene's time says
  {
    scene->InvokeCommand("GoToLast");
    renderNow();
  }
  this->Waiting = false;
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::tellRuns()
{
  if (isUpdating() || this->Scripting)
  {
    return;
  }
  const rockfall::window::NotUndone own;
  this->lookAtTime();
  QList<pqPipelineSource*> settled;
  QMainWindow* window = rockfall::window::mainWindow();
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    vtkSMProxy* proxy = source->getProxy();
    if (!isOf(proxy, { "vtkRockfallSimulation" }) ||
      source->modifiedState() == pqProxy::UNINITIALIZED)
    {
      continue;
    }
    proxy->UpdatePropertyInformation(proxy->GetProperty("RunStatus"));
    const QString status = QString::fromUtf8(vtkSMPropertyHelper(proxy, "RunStatus").GetAsString());
    const QString name = source->getSMName();
    const bool running = status.startsWith("running") || status.startsWith("stopping");
    if (window && (running || this->Running.contains(name)))
    {
      window->statusBar()->showMessage(name + ": " + status, running ? 0 : 10000);
    }
    if (running)
    {
      this->Running.insert(name);
    }
    else
    {
      // A run may end between two looks, or while views take it one by one: some have a part of it.
      vtkSMSourceProxy* run = source->getSourceProxy();
      const QString state = stateOf(run);
      const bool other = !state.isEmpty() && this->Settled.value(name) != state;
      if (this->Running.remove(name) || showsPart(run) || other)
      {
        // The last look, also where ParaView does not ask, as while tests are played.
        proxy->InvokeCommand("Watch");
        proxy->MarkDirty(nullptr);
        settled.append(source);
      }
    }
  }
  if (!settled.isEmpty())
  {
    renderNow();
    for (pqPipelineSource* source : settled)
    {
      this->Settled[source->getSMName()] = stateOf(source->getSourceProxy());
    }
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::settleRuns()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    if (isOf(source->getProxy(), { "vtkRockfallSimulation" }) &&
      !showsPart(source->getSourceProxy()))
    {
      this->Settled[source->getSMName()] = stateOf(source->getSourceProxy());
    }
  }
}
