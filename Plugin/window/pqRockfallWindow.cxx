#include "pqRockfallWindow.h"

#include "handles.h"
#include "keptFiles.h"
#include "looks.h"
#include "markers.h"
#include "panel.h"
#include "placed.h"
#include "pqMessageBar.h"
#include "pqPathPicker.h"
#include "slopeView.h"
#include "terrain/presets.h"
#include "undo.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqObjectBuilder.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqRunBar.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettings.h"
#include "vtkSMSourceProxy.h"

#include <QCoreApplication>
#include <QKeyEvent>
#include <QMainWindow>
#include <QMenuBar>
#include <QPointer>

#include <algorithm>
#include <string>

namespace
{

using rockfall::window::isOf;
using rockfall::window::mainWindow;
using rockfall::window::NotUndone;

constexpr int kLookAtPanel = 500;  // ms
constexpr int kLookForWindow = 20; // ms

/// Films, unless the user has saved others, are in real time at the default output interval: 20 frames a
/// second, where ParaView has 1, and each of them, where ParaView 6.1 takes the scene's stride.
constexpr const char* kFilms =
  R"({"misc": {"SaveAnimation": {"FrameRate": 20, "FrameStride": 1}}})";
constexpr double kBelowUser = 0.5; // priority of settings

/// A source or filter of the plugin that may name files.
bool isOurs(vtkSMProxy* proxy)
{
  return isOf(proxy,
    { "vtkDEMToCFESource", "vtkRockBlockSource", "vtkJointedRockMass", "vtkRockfallSimulation",
      "vtkTrajectoryCollector" });
}

/// Whether no other slope is seen in its view: of an earlier study it is hidden.
bool isFirstSlope(pqRepresentation* representation)
{
  for (pqRepresentation* other : representation->getView()->getRepresentations())
  {
    const rockfall::window::Shown shown = rockfall::window::shownBy(other->getProxy());
    if (other != representation && other->isVisible() &&
      isOf(shown.source, { "vtkDEMToCFESource" }) && shown.port == 0)
    {
      return false;
    }
  }
  return true;
}

void fitMarkers()
{
  const NotUndone own;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqView* view : model->findItems<pqView*>())
  {
    bool changed = false;
    for (pqRepresentation* shown : view->getRepresentations())
    {
      changed = (shown->isVisible() &&
                  rockfall::window::fitMarker(shown->getProxy(), view->getViewProxy())) ||
        changed;
    }
    if (changed)
    {
      view->render();
    }
  }
}

} // namespace

//-----------------------------------------------------------------------------
pqRockfallWindow::pqRockfallWindow(QObject* parent)
  : Superclass(parent)
  , Picker(new pqPathPicker(this))
{
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::begin()
{
  QMainWindow* window = pqApplicationCore::instance() ? mainWindow() : nullptr;
  if (!window || window->menuBar()->actions().isEmpty())
  {
    QTimer::singleShot(kLookForWindow, this, [this] { this->begin(); });
    return;
  }
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  this->connect(model, &pqServerManagerModel::sourceAdded, this, &pqRockfallWindow::onSource);
  this->connect(pqApplicationCore::instance()->getObjectBuilder(),
    qOverload<pqProxy*>(&pqObjectBuilder::proxyCreated), this, &pqRockfallWindow::onMade);
  this->connect(
    model, &pqServerManagerModel::representationAdded, this, &pqRockfallWindow::onRepresentation);
  this->connect(model, &pqServerManagerModel::preSourceRemoved, this, &pqRockfallWindow::onRemoved);
  this->Bar = new pqRunBar(window);
  this->connect(this->Bar, &pqRunBar::stopped, this, &pqRockfallWindow::stopRuns);
  this->connect(&this->Looks, &QTimer::timeout, this, &pqRockfallWindow::tellRuns);
  this->connect(&this->Clock, &QTimer::timeout,
    [window]
    {
      rockfall::window::showUnits(window);
      rockfall::window::narrowChoices(window);
    });
  // Until it is, for each window that is wider than all before.
  this->connect(
    &this->Clock, &QTimer::timeout, [window] { rockfall::window::widenPanels(window); });
  this->connect(&this->Clock, &QTimer::timeout, &fitMarkers);
  this->connect(&this->Clock, &QTimer::timeout,
    []
    {
      const NotUndone own;
      rockfall::window::layHandles(pqActiveObjects::instance().activeSource());
    });
  auto* messages = new pqMessageBar(window);
  this->connect(&this->Clock, &QTimer::timeout, messages,
    [this, messages]
    {
      if (!this->Scripting) // a strip that comes draws the views anew
      {
        messages->look();
      }
    });
  this->Clock.start(kLookAtPanel);
  this->Looks.start(kLookAtPanel);
  this->connect(this->Picker, &pqPathPicker::picked, this, &pqRockfallWindow::onPicked);
  this->connect(
    model, &pqServerManagerModel::aboutToRemoveServer, this->Picker, &pqPathPicker::end);
  this->connect(this->Picker, &pqPathPicker::missed, this,
    [this] { this->tell(tr("There is no trajectory where you clicked")); });
  if (pqUndoStack* undo = pqApplicationCore::instance()->getUndoStack())
  {
    this->connect(undo, &pqUndoStack::undone, this, &pqRockfallWindow::keepOwnEnd);
    this->connect(undo, &pqUndoStack::redone, this, &pqRockfallWindow::keepOwnEnd);
  }
  QCoreApplication::instance()->installEventFilter(this);
  vtkSMSettings::GetInstance()->AddCollectionFromString(kFilms, kBelowUser);
  this->makeMenu(window);
}

//-----------------------------------------------------------------------------
bool pqRockfallWindow::eventFilter(QObject* watched, QEvent* event)
{
  // As a shortcut a key comes before its press, which a shortcut that is taken leaves out.
  if (event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress)
  {
    auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
    auto* widget = qobject_cast<QWidget*>(watched);
    if (static_cast<QKeyEvent*>(event)->key() == Qt::Key_P && view && widget &&
      (widget == view->widget() || view->widget()->isAncestorOf(widget)) &&
      rockfall::window::missesSlope(pqActiveObjects::instance().activeSource()))
    {
      this->tell(tr("There is no slope under the mouse: the point stays where it is"));
    }
  }
  return this->Superclass::eventFilter(watched, event);
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onSource(pqPipelineSource* source)
{
  vtkSMProxy* proxy = source->getProxy();
  const std::string name = proxy->GetXMLName();
  if (isOurs(proxy))
  {
    rockfall::window::keepFiles(source);
  }
  if (isOf(proxy, { "vtkDEMToCFESource" }))
  {
    rockfall::window::showCentimetres(proxy->GetSessionProxyManager());
  }
  if (name == "RockSourceReader" || name == "RockBlocks" || name == "JointedRockMass")
  {
    rockfall::window::standOnSlope(source);
  }
  if (name != "RockSourceReader" &&
    isOf(proxy, { "vtkRockBlockSource", "vtkTrajectoryCollector", "vtkDrawnStructure" }))
  {
    rockfall::window::drawPlaced(source->getSourceProxy());
  }
  if (isOf(proxy, { "vtkDEMToCFESource" }))
  {
    for (const int event :
      { int(vtkCommand::UncheckedPropertyModifiedEvent), int(vtkCommand::ModifiedEvent) })
    {
      pqCoreUtilities::connect(
        proxy->GetProperty("Preset"), event, this, SLOT(onPreset(vtkObject*, unsigned long)));
    }
    if (this->Scripting) // which has chosen one before this hears of it
    {
      this->onPreset(proxy->GetProperty("Preset"), vtkCommand::ModifiedEvent);
      proxy->UpdateVTKObjects();
    }
  }
  if (isOf(proxy,
        { "vtkRockfallSimulation", "vtkRockfallHazardMap", "vtkDEMToCFESource", "vtkGrowingPaths",
          "vtkTrajectoryCollector", "vtkMergeCollectors", "vtkTrajectoryProfile" }))
  {
    this->connect(
      source, SIGNAL(dataUpdated(pqPipelineSource*)), this, SLOT(onData(pqPipelineSource*)));
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onMade(pqProxy* made)
{
  // By menu or File > Open: scripts and states bring their own ground, settings of the user theirs.
  vtkSMProxy* proxy = made->getProxy();
  const std::string setting =
    "." + std::string(proxy->GetXMLGroup()) + "." + proxy->GetXMLName() + ".Preset";
  if (isOf(proxy, { "vtkDEMToCFESource" }) &&
    !vtkSMSettings::GetInstance()->HasSetting(setting.c_str()))
  {
    vtkSMPropertyHelper(proxy, "Preset").Set(rockfall::usualPreset());
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onPreset(vtkObject* property, unsigned long event)
{
  auto* choice = vtkSMProperty::SafeDownCast(property);
  vtkSMProxy* slope = choice ? choice->GetParent() : nullptr;
  if (!slope)
  {
    return;
  }
  // Numbers of the panel until Apply, those of the slope then or from a script.
  const bool panel = event == vtkCommand::UncheckedPropertyModifiedEvent;
  vtkSMPropertyHelper chosen(choice);
  chosen.SetUseUnchecked(panel);
  const int preset = chosen.GetAsInt();
  if (preset == 0 && !panel)
  {
    return; // of a script or a state, which have numbers of their own
  }
  // Without a preset the numbers are those that a slope begins with: bare rock.
  vtkSMProxy* bare =
    slope->GetSessionProxyManager()->GetPrototypeProxy(slope->GetXMLGroup(), slope->GetXMLName());
  for (const auto& [name, value] : rockfall::presetValues(std::max(1, preset)))
  {
    vtkSMPropertyHelper number(slope, name.c_str());
    const double wanted =
      preset == 0 ? vtkSMPropertyHelper(bare, name.c_str()).GetAsDouble() : value;
    number.SetUseUnchecked(panel);
    if (number.GetAsDouble() != wanted)
    {
      number.Set(wanted);
    }
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onRepresentation(pqRepresentation* added)
{
  vtkSMProxy* representation = added->getProxy();
  const rockfall::window::Shown shown = rockfall::window::shownBy(representation);
  rockfall::window::style(representation);
  const bool slope = shown.source && shown.port == 0 &&
    isOf(shown.source, { "vtkDEMToCFESource" }) &&
    !pqApplicationCore::instance()->isLoadingState(); // which has a camera of its own
  // Legends and cameras are set by ParaView after it has made a representation.
  QPointer<pqRepresentation> later = added;
  QTimer::singleShot(0, this,
    [later, shown, slope]
    {
      pqView* view = later ? later->getView() : nullptr;
      if (!view)
      {
        return;
      }
      const NotUndone own;
      rockfall::window::styleIn(later->getProxy(), view->getViewProxy());
      if (slope && isFirstSlope(later))
      {
        rockfall::window::lookFromValley(shown.source, view->getViewProxy());
      }
      view->render();
    });
  if (vtkSMProperty* colours =
        shown.source ? representation->GetProperty("ColorArrayName") : nullptr)
  {
    pqCoreUtilities::connect(colours, vtkCommand::ModifiedEvent, this, SLOT(onColours(vtkObject*)));
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onColours(vtkObject* property)
{
  // The property is of a proxy within the representation's.
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QPointer<pqRepresentation> of;
  for (pqDataRepresentation* shown : model->findItems<pqDataRepresentation*>())
  {
    if (shown->getProxy()->GetProperty("ColorArrayName") == property)
    {
      of = shown;
    }
  }
  // ParaView sets the palette of the array, and its legend, after the array.
  QTimer::singleShot(0, this,
    [of]
    {
      if (pqView* view = of ? of->getView() : nullptr)
      {
        const NotUndone own;
        rockfall::window::styleIn(of->getProxy(), view->getViewProxy());
        view->render();
      }
    });
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onData(pqPipelineSource* source)
{
  const NotUndone own;
  if (!isOf(source->getProxy(), { "vtkDEMToCFESource" }))
  {
    // Palettes go with what is made: the first paths of a run are not the range of all.
    QPointer<pqPipelineSource> later = source;
    QTimer::singleShot(0, this,
      [later]
      {
        const NotUndone drawn;
        for (int port = 0; later && port < later->getNumberOfOutputPorts(); ++port)
        {
          for (pqDataRepresentation* shown : later->getRepresentations(port, nullptr))
          {
            if (pqView* view = shown->getView())
            {
              rockfall::window::follow(shown->getProxy(), view->getViewProxy());
            }
          }
        }
      });
  }
  vtkSMSourceProxy* proxy = source->getSourceProxy();
  if (isOf(proxy, { "vtkRockfallSimulation" }))
  {
    // A view that is being updated does not hear of another time.
    this->EndsAnew = !this->Scripting;
    if (this->Scripting)
    {
      this->endWithLastRock(source->getServer());
    }
    this->drawCharts(proxy);
  }
}
