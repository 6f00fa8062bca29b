#include "pqRockfallWindow.h"

#include "handles.h"
#include "looks.h"
#include "markers.h"
#include "pqMessageBar.h"
#include "pqPathPicker.h"
#include "presetValues.h"
#include "slopeView.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqFileDialog.h"
#include "pqHelpReaction.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqPropertyWidget.h"
#include "pqPythonManager.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqSettings.h"
#include "pqView.h"
#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSourceProxy.h"
#include "vtkTable.h"

#include <QCoreApplication>
#include <QDesktopServices>
#include <QDir>
#include <QDockWidget>
#include <QFileInfo>
#include <QGridLayout>
#ifdef ROCKFALL_OPENS_HELP
#include <QHelpEngine>
#endif
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QPointer>
#include <QStatusBar>
#include <QUrl>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace
{

using rockfall::window::isOf;

constexpr int kLookAtRuns = 500;   // ms
constexpr int kLookForWindow = 20; // ms
constexpr int kReadNotes = 30000;  // ms

QMainWindow* mainWindow()
{
  return qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

/// The folder of the scripts, beside that of this plugin: ParaView would take them for plugins
/// there.
QString scriptFolder()
{
  Dl_info info;
  return dladdr(reinterpret_cast<void*>(&scriptFolder), &info) && info.dli_fname
    ? QFileInfo(QString::fromLocal8Bit(info.dli_fname)).absolutePath() + "/../RockfallScripts"
    : QString();
}

/// A text of Python.
QString quoted(QString text)
{
  return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'";
}

/// Whether nothing else of ours is shown yet.
bool isFirstSlope(vtkSMProxy* representation)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqDataRepresentation* other : model->findItems<pqDataRepresentation*>())
  {
    const rockfall::window::Shown shown = rockfall::window::shownBy(other->getProxy());
    if (other->getProxy() != representation && isOf(shown.source, { "vtkDEMToCFESource" }) &&
      shown.port == 0)
    {
      return false;
    }
  }
  return true;
}

/// Rock Blocks on a slope begin where their block is released, as long as they have the centre of
/// the test slope; a line that they may be told to draw begins there, too.
void standWhereReleased(vtkSMSourceProxy* proxy)
{
  vtkSMPropertyHelper draw(proxy, "Draw");
  if (draw.GetAsInt() != 0 || !proxy->GetProperty("Center")->IsValueDefault())
  {
    return;
  }
  constexpr int line = 2;
  std::array<double, 6> b{};
  proxy->GetDataInformation(0)->GetBounds(b.data());
  if (b[0] > b[1])
  {
    return; // the message says why
  }
  const std::array<double, 3> centre = { 0.5 * (b[0] + b[1]), 0.5 * (b[2] + b[3]),
    0.5 * (b[4] + b[5]) };
  draw.Set(line);
  proxy->UpdateVTKObjects();
  proxy->UpdatePipeline();
  draw.Set(0);
  vtkSMPropertyHelper(proxy, "Center").Set(centre.data(), unsigned(centre.size()));
}

/// Draws the line that a filter takes where nothing is drawn, so that the mouse finds one to move.
void drawPlaced(vtkSMSourceProxy* proxy)
{
  vtkSMPropertyHelper points(proxy, "Points");
  if (points.GetNumberOfElements() > 0)
  {
    return;
  }
  std::vector<double> placed = { 5.0, 45.0, 58.0, 5.0, 55.0, 58.0 }; // on the test slope
  vtkSMPropertyHelper terrain(proxy, "Terrain", true);
  const bool onSlope = terrain.GetNumberOfElements() > 0 && terrain.GetAsProxy();
  const bool blocks = proxy->GetXMLName() == std::string("RockBlocks");
  if (onSlope || !blocks)
  {
    proxy->UpdateVTKObjects();
    proxy->UpdatePipeline();
    if (blocks)
    {
      standWhereReleased(proxy);
    }
    proxy->UpdatePropertyInformation();
    placed = vtkSMPropertyHelper(proxy, "PlacedLine").GetDoubleArray();
  }
  if (placed.size() == 6 &&
    std::any_of(placed.begin(), placed.end(), [](double x) { return x != 0.0; }))
  {
    points.Set(placed.data(), unsigned(placed.size()));
  }
  proxy->UpdateVTKObjects();
}

/// Rocks stand on the slope that is there, as those of Rock Release do, unless they have one.
void standOnSlope(pqPipelineSource* rocks)
{
  vtkSMPropertyHelper terrain(rocks->getProxy(), "Terrain");
  if (pqApplicationCore::instance()->isLoadingState() ||
    (terrain.GetNumberOfElements() > 0 && terrain.GetAsProxy()))
  {
    return;
  }
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* slope : model->findItems<pqPipelineSource*>(rocks->getServer()))
  {
    if (isOf(slope->getProxy(), { "vtkDEMToCFESource", "vtkDrawnStructure" }))
    {
      terrain.Set(slope->getProxy(), 0);
    }
  }
  rocks->getProxy()->UpdateVTKObjects();
}

/// Units behind the captions of the panel, from the properties' hints: a caption in the XML is the
/// property's name in Python, where a unit would have to be part of it.
void showUnits(QMainWindow* window)
{
  for (pqPropertyWidget* widget : window->findChildren<pqPropertyWidget*>())
  {
    vtkPVXMLElement* hints = widget->property() ? widget->property()->GetHints() : nullptr;
    vtkPVXMLElement* unit = hints ? hints->FindNestedElementByName("Unit") : nullptr;
    QWidget* parent = widget->parentWidget();
    auto* grid = parent ? qobject_cast<QGridLayout*>(parent->layout()) : nullptr;
    const int index = grid ? grid->indexOf(widget) : -1;
    if (!unit || index < 0)
    {
      continue;
    }
    int row = 0, column = 0, rows = 0, columns = 0;
    grid->getItemPosition(index, &row, &column, &rows, &columns);
    QLayoutItem* item = grid->itemAtPosition(row, 0);
    auto* label = item ? qobject_cast<QLabel*>(item->widget()) : nullptr;
    const QString text =
      QString::fromUtf8(" (%1)").arg(QString::fromUtf8(unit->GetAttribute("text")));
    if (label && !label->text().endsWith(text))
    {
      label->setText(label->text() + text);
    }
  }
}

/// Once for each user: panels as wide as coordinates of seven digits need.
void widenPanels(QMainWindow* window)
{
  constexpr int wide = 400; // px
  constexpr const char* done = "RockfallPanelsWidened";
  pqSettings* settings = pqApplicationCore::instance()->settings();
  auto* panel = window->findChild<QDockWidget*>("propertiesDock");
  if (settings->contains(done) || !panel || window->width() < 3 * wide)
  {
    return;
  }
  settings->setValue(done, true);
  if (panel->width() < wide)
  {
    window->resizeDocks({ panel }, { wide }, Qt::Horizontal);
  }
}

void fitMarkers()
{
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

/// Palettes, legends and charts go with the data that are shown.
void followShown()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqView* view : model->findItems<pqView*>())
  {
    for (pqRepresentation* shown : view->getRepresentations())
    {
      if (shown->isVisible())
      {
        rockfall::window::follow(shown->getProxy(), view->getViewProxy());
      }
    }
    view->render();
  }
}

/// All views, with what is new in their pipelines, before this returns.
void renderNow()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqView* view : model->findItems<pqView*>())
  {
    view->forceRender();
  }
}

/// The time step by which the last rock of a run has come to its end, s; 0 if it is not known here.
/// ParaView goes from step to step: with an end between two it would go past it, and begin anew.
double lastEnd(vtkSMSourceProxy* run)
{
  auto* algorithm = vtkAlgorithm::SafeDownCast(run->GetClientSideObject());
  auto* table = algorithm ? vtkTable::SafeDownCast(algorithm->GetOutputDataObject(3)) : nullptr;
  vtkDataArray* ends = table ? table->GetRowData()->GetArray("EndTime") : nullptr;
  if (!ends || ends->GetNumberOfTuples() == 0)
  {
    return 0.0;
  }
  const double end = ends->GetRange(0)[1];
  const std::vector<double> steps =
    vtkSMPropertyHelper(run, "TimestepValues", true).GetDoubleArray();
  const auto step = std::lower_bound(steps.begin(), steps.end(), end);
  return step == steps.end() ? end : *step;
}

/// The same of all runs.
double lastEnd(pqServer* server)
{
  double end = 0.0;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* run : model->findItems<pqPipelineSource*>(server))
  {
    if (isOf(run->getProxy(), { "vtkRockfallSimulation" }))
    {
      end = std::max(end, lastEnd(run->getSourceProxy()));
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
  this->connect(
    model, &pqServerManagerModel::representationAdded, this, &pqRockfallWindow::onRepresentation);
  this->connect(&this->Clock, &QTimer::timeout, this, &pqRockfallWindow::tellRuns);
  this->connect(&this->Clock, &QTimer::timeout, [window] { showUnits(window); });
  this->connect(&this->Clock, &QTimer::timeout, &fitMarkers);
  this->connect(&this->Clock, &QTimer::timeout,
    [] { rockfall::window::layHandles(pqActiveObjects::instance().activeSource()); });
  auto* messages = new pqMessageBar(window);
  this->connect(&this->Clock, &QTimer::timeout, messages, &pqMessageBar::look);
  this->Clock.start(kLookAtRuns);
  this->connect(this->Picker, &pqPathPicker::picked, this, &pqRockfallWindow::onPicked);
  this->connect(this->Picker, &pqPathPicker::missed, this,
    [this] { this->tell(tr("There is no trajectory where you clicked")); });
  this->makeMenu(window);
  widenPanels(window);
  const QString pages = scriptFolder() + "/RockfallDDA.qch";
  if (QFileInfo::exists(pages))
  {
    pqApplicationCore* application = pqApplicationCore::instance();
#ifdef ROCKFALL_OPENS_HELP
    // Qt 6's engine begins read only, and ParaView leaves it so.
    QHelpEngine* help = application->helpEngine();
    help->setReadOnly(false);
    help->setupData();
#endif
    application->registerDocumentation(pages);
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::makeMenu(QMainWindow* window)
{
  auto* menu = new QMenu(tr("&Rockfall"), window->menuBar());
  menu->setObjectName("menuRockfall");
  QAction* before = nullptr;
  for (QAction* action : window->menuBar()->actions())
  {
    if (action->menu() && action->menu()->objectName() == "menuTools")
    {
      before = action;
    }
  }
  window->menuBar()->insertMenu(before, menu);
  menu
    ->addAction(tr("New Study of an Elevation File..."), this,
      [this]
      {
        pqFileDialog dialog(nullptr, mainWindow(), tr("Elevations of the slope"), QString(),
          tr("Elevation files (*.tif *.tiff *.asc *.dem *.hgt *.img *.nc *.grd *.vrt *.bil *.flt "
             "*.xyz "
             "*.gpkg *.shp *.geojson *.dxf);;All files (*)"));
        dialog.setObjectName("RockfallStudyDialog");
        dialog.setFileMode(pqFileDialog::ExistingFile);
        if (dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty())
        {
          this->runPython("new_study(" + quoted(dialog.getSelectedFiles().first()) + ")");
        }
      })
    ->setObjectName("actionNewStudy");
  menu->addAction(tr("Example: Test Slope"), this, [this] { this->runPython("new_study('')"); })
    ->setObjectName("actionTestSlope");
  menu->addAction(tr("Example: Jacksboro Fault"), this, [this] { this->runPython("jacksboro()"); })
    ->setObjectName("actionJacksboro");
  menu->addSeparator();
  menu->addAction(tr("Pick a Trajectory"), this, [this] { this->pickTrajectory(); })
    ->setObjectName("actionPickTrajectory");
  menu
    ->addAction(tr("Documentation"), this,
      [] { pqHelpReaction::showHelp("qthelp://RockfallDDA.pages/RockfallDDA/README.html"); })
    ->setObjectName("actionDocumentation");
  menu->addAction(tr("Clock"), this, [this] { this->runPython("clock()"); })
    ->setObjectName("actionClock");
  // Pictures for the documentation, taken by tests.
  const QString folder = qEnvironmentVariable("ROCKFALL_PICTURES");
  if (!folder.isEmpty())
  {
    window->resize(1400, 900);
    menu
      ->addAction("Picture", this,
        [this, window, folder]
        { window->grab().save(folder + "/window-" + QString::number(++this->Pictures) + ".png"); })
      ->setObjectName("actionPicture");
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::runPython(const QString& statement)
{
  auto* python = pqPVApplicationCore::instance()->pythonManager();
  if (!python)
  {
    qCritical("ParaView was built without Python: Rockfall studies cannot be made from the menu");
    return;
  }
  const QString folder = scriptFolder();
  const QString code = "import sys\nif '" + folder + "' not in sys.path: sys.path.insert(0, '" +
    folder + "')\nimport rockfall_study\nrockfall_study." + statement + "\n";
  python->executeCode(code.toUtf8());
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onSource(pqPipelineSource* source)
{
  vtkSMProxy* proxy = source->getProxy();
  const std::string name = proxy->GetXMLName();
  if (name == "RockSourceReader" || name == "RockBlocks" || name == "JointedRockMass")
  {
    standOnSlope(source);
  }
  if (name != "RockSourceReader" &&
    isOf(proxy, { "vtkRockBlockSource", "vtkTrajectoryCollector", "vtkDrawnStructure" }))
  {
    drawPlaced(source->getSourceProxy());
  }
  if (isOf(proxy, { "vtkDEMToCFESource" }))
  {
    for (const int event :
      { int(vtkCommand::UncheckedPropertyModifiedEvent), int(vtkCommand::ModifiedEvent) })
    {
      pqCoreUtilities::connect(
        proxy->GetProperty("Preset"), event, this, SLOT(onPreset(vtkObject*, unsigned long)));
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
void pqRockfallWindow::onPreset(vtkObject* property, unsigned long event)
{
  auto* preset = vtkSMProperty::SafeDownCast(property);
  vtkSMProxy* slope = preset ? preset->GetParent() : nullptr;
  if (!slope)
  {
    return;
  }
  // Numbers of the panel until Apply, those of the slope then or from a script.
  const bool panel = event == vtkCommand::UncheckedPropertyModifiedEvent;
  vtkSMPropertyHelper chosen(preset);
  chosen.SetUseUnchecked(panel);
  for (const auto& [name, value] : rockfall::window::presetValues(chosen.GetAsInt()))
  {
    vtkSMPropertyHelper number(slope, name.c_str());
    number.SetUseUnchecked(panel);
    if (number.GetAsDouble() != value)
    {
      number.Set(value);
    }
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::pickTrajectory()
{
  if (auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView()))
  {
    this->Picker->begin(view);
    this->tell(tr("Click a trajectory"));
  }
  else
  {
    this->tell(tr("Click into the view of the slope first"));
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onPicked(pqOutputPort* port, int cell)
{
  this->runPython(QString("profile(%1, %2, %3)")
                    .arg(quoted(port->getSource()->getSMName()))
                    .arg(port->getPortNumber())
                    .arg(cell));
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::tell(const QString& message)
{
  if (QMainWindow* window = mainWindow())
  {
    window->statusBar()->showMessage(message, kReadNotes);
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onRepresentation(pqRepresentation* added)
{
  vtkSMProxy* representation = added->getProxy();
  const rockfall::window::Shown shown = rockfall::window::shownBy(representation);
  rockfall::window::style(representation);
  const bool first = shown.source && shown.port == 0 &&
    isOf(shown.source, { "vtkDEMToCFESource" }) && isFirstSlope(representation);
  // Legends and cameras are set by ParaView after it has made a representation.
  QPointer<pqRepresentation> later = added;
  QTimer::singleShot(0, this,
    [later, shown, first]
    {
      pqView* view = later ? later->getView() : nullptr;
      if (!view)
      {
        return;
      }
      rockfall::window::styleIn(later->getProxy(), view->getViewProxy());
      if (first)
      {
        rockfall::window::lookFromValley(shown.source, view->getViewProxy());
      }
      view->render();
    });
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onData(pqPipelineSource* source)
{
  if (!isOf(source->getProxy(), { "vtkDEMToCFESource" }))
  {
    // Palettes go with what is made: the first paths of a run are not the range of all.
    QPointer<pqPipelineSource> later = source;
    QTimer::singleShot(0, this,
      [later]
      {
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
    this->endWithLastRock(source->getServer());
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::endWithLastRock(pqServer* server)
{
  const double end = lastEnd(server);
  vtkSMProxy* scene = sceneOf(server);
  if (!scene || !(end > 0.0))
  {
    return;
  }
  // A time that the user has locked stays.
  if (vtkSMPropertyHelper(scene, "LockEndTime").GetAsInt() &&
    vtkSMPropertyHelper(scene, "EndTime").GetAsDouble() != this->LastEnd)
  {
    return;
  }
  vtkSMPropertyHelper now(scene, "AnimationTime");
  const bool atEnd = this->LastEnd > 0.0 && (this->AtEnd || now.GetAsDouble() == this->LastEnd);
  this->LastEnd = end;
  vtkSMPropertyHelper(scene, "LockEndTime").Set(1);
  vtkSMPropertyHelper(scene, "EndTime").Set(end);
  if (atEnd || now.GetAsDouble() > end)
  {
    now.Set(end); // whoever looks at whole paths goes on doing so
  }
  scene->UpdateVTKObjects();
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::lookAtTime()
{
  pqServer* server = pqActiveObjects::instance().activeServer();
  vtkSMProxy* scene = server ? sceneOf(server) : nullptr;
  const double end = server ? lastEnd(server) : 0.0;
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
  else if (this->AtEnd && end == this->LastEnd)
  {
    scene->InvokeCommand("GoToLast"); // views may be elsewhere than its time says
    renderNow();
  }
  this->Waiting = false;
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::tellRuns()
{
  if (isUpdating())
  {
    return;
  }
  this->lookAtTime();
  bool settled = false;
  QMainWindow* window = mainWindow();
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
    else if (this->Running.remove(name))
    {
      // The last look, also where ParaView does not ask, as while tests are played.
      proxy->InvokeCommand("Watch");
      proxy->MarkDirty(nullptr);
      settled = true;
    }
  }
  if (settled)
  {
    renderNow();
    followShown();
  }
}
