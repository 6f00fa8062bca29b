// Runs in the window: their state in the status bar, new data in the views, and animations that end
// with the last rock.

#include "pqRockfallWindow.h"

#include "looks.h"
#include "pqRunBar.h"
#include "proxyNumbers.h"
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
#include <QPointer>
#include <QSet>

#include <algorithm>
#include <utility>
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

enum class Kind
{
  Charts,
  Slopes
};

/// All views of a kind, with what is new in their pipelines and with palettes, legends and charts that
/// go with it, before this returns. Each is drawn once: a slope of a million cells takes half a second.
void renderNow(Kind kind)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqView* view : model->findItems<pqView*>())
  {
    if ((kind == Kind::Slopes) != (qobject_cast<pqRenderView*>(view) != nullptr))
    {
      continue;
    }
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

/// While it lives a time that is set draws no slope.
class Undrawn
{
public:
  Undrawn()
  {
    auto* model = pqApplicationCore::instance()->getServerManagerModel();
    for (pqView* view : model->findItems<pqView*>())
    {
      vtkSMProxy* proxy = view->getProxy();
      if (proxy->GetProperty("SuppressRendering") &&
        vtkSMPropertyHelper(proxy, "SuppressRendering").GetAsInt() == 0)
      {
        rockfall::window::set(proxy, "SuppressRendering", 1);
        proxy->UpdateVTKObjects();
        this->Views.append(view);
      }
    }
  }
  ~Undrawn()
  {
    for (const QPointer<pqView>& view : this->Views)
    {
      if (view)
      {
        rockfall::window::set(view->getProxy(), "SuppressRendering", 0);
        view->getProxy()->UpdateVTKObjects();
      }
    }
  }
  Undrawn(const Undrawn&) = delete;
  Undrawn& operator=(const Undrawn&) = delete;

private:
  QList<QPointer<pqView>> Views;
};

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

double timeOf(pqServer* server)
{
  vtkSMProxy* scene = sceneOf(server);
  return scene ? vtkSMPropertyHelper(scene, "AnimationTime").GetAsDouble() : 0.0;
}

constexpr int kLookAtRuns = 500, kLookAtRunning = 100; // ms

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
    {
      const Undrawn times;
      scene->InvokeCommand("GoToLast");
    }
    renderNow(Kind::Charts);
    renderNow(Kind::Slopes);
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
  QSet<QString> stillRunning; // without those that were deleted
  QString told;
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
    if (running || this->Running.contains(name))
    {
      told += (told.isEmpty() ? "" : "; ") + name + ": " + status;
    }
    if (running)
    {
      stillRunning.insert(name);
    }
    else
    {
      // A run may end between two looks, or while views take it one by one: some have a part of it.
      vtkSMSourceProxy* run = source->getSourceProxy();
      const QString state = stateOf(run);
      const bool other = !state.isEmpty() && this->Settled.value(name) != state;
      if (this->Running.contains(name) || showsPart(run) || other)
      {
        // The last look, also where ParaView does not ask, as while tests are played.
        proxy->InvokeCommand("Watch");
        proxy->MarkDirty(nullptr);
        settled.append(source);
      }
    }
  }
  this->Running = stillRunning;
  this->Bar->tell(told, !this->Running.isEmpty());
  // Who has pressed Stop is not kept waiting.
  this->Looks.setInterval(this->Running.isEmpty() ? kLookAtRuns : kLookAtRunning);
  if (!settled.isEmpty())
  {
    // Charts are the first ones: the paths of a large run take seconds. Paths want the time at which
    // they are whole before they are made.
    renderNow(Kind::Charts);
    {
      const Undrawn times;
      for (pqPipelineSource* source : settled)
      {
        source->getSourceProxy()->UpdatePipeline(timeOf(source->getServer()));
        this->endWithLastRock(source->getServer());
        this->Settled[source->getSMName()] = stateOf(source->getSourceProxy());
      }
      this->EndsAnew = false;
    }
    renderNow(Kind::Slopes);
  }
  else if (std::exchange(this->EndsAnew, false) && this->Running.isEmpty())
  {
    this->endWithLastRock(pqActiveObjects::instance().activeServer());
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::stopRuns()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    if (isOf(source->getProxy(), { "vtkRockfallSimulation" }))
    {
      source->getProxy()->InvokeCommand("Stop");
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
