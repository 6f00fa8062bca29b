// The menu Rockfall, and what its entries do.

#include "pqRockfallWindow.h"

#include "looks.h"
#include "panel.h"
#include "pqPathPicker.h"
#include "undo.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqFileDialog.h"
#include "pqHelpReaction.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqPythonManager.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSettings.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"

#include <QDateTime>
#include <QFileInfo>
#ifdef ROCKFALL_OPENS_HELP
#include <QHelpEngine>
#endif
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QScreen>
#include <QStatusBar>
#include <QTimer>

#include <dlfcn.h>

namespace
{

using rockfall::window::isOf;
using rockfall::window::mainWindow;
using rockfall::window::NotUndone;

constexpr int kReadNotes = 30000; // ms

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

/// A file that the user chooses; empty: none.
QString chosenFile(const char* dialogName, const QString& title, const QString& types)
{
  pqFileDialog dialog(nullptr, mainWindow(), title, QString(), types);
  dialog.setObjectName(dialogName);
  dialog.setFileMode(pqFileDialog::ExistingFile);
  return dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty()
    ? dialog.getSelectedFiles().first()
    : QString();
}

/// The pages behind ? and Documentation.
void registerPages()
{
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

} // namespace

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
        const QString file = chosenFile("RockfallStudyDialog", tr("Elevations of the slope"),
          tr("Elevation files (*.tif *.tiff *.asc *.dem *.hgt *.img *.nc *.grd *.vrt *.bil *.flt "
             "*.xyz *.gpkg *.shp *.geojson *.dxf);;All files (*)"));
        if (!file.isEmpty())
        {
          this->runPython("new_study(" + quoted(file) + ")");
        }
      })
    ->setObjectName("actionNewStudy");
  menu->addAction(tr("Example: Test Slope"), this, [this] { this->runPython("new_study('')"); })
    ->setObjectName("actionTestSlope");
  menu->addAction(tr("Example: Jacksboro Fault"), this, [this] { this->runPython("jacksboro()"); })
    ->setObjectName("actionJacksboro");
  menu->addSeparator();
  menu
    ->addAction(tr("Report of a Batch Study..."), this,
      [this]
      {
        const QString file = chosenFile("RockfallReportDialog",
          tr("manifest.json of a finished study"), tr("Finished studies (manifest.json)"));
        if (!file.isEmpty())
        {
          this->makeReport(file);
        }
      })
    ->setObjectName("actionReport");
  menu->addAction(tr("Pick a Trajectory"), this, [this] { this->pickTrajectory(); })
    ->setObjectName("actionPickTrajectory");
  menu->addAction(tr("Rocks Meet This Structure"), this, [this] { this->meetStructure(); })
    ->setObjectName("actionMeetStructure");
  menu
    ->addAction(tr("Documentation"), this,
      [] { pqHelpReaction::showHelp("qthelp://RockfallDDA.pages/RockfallDDA/README.html"); })
    ->setObjectName("actionDocumentation");
  menu->addAction(tr("Clock"), this, [this] { this->runPython("clock()"); })
    ->setObjectName("actionClock");
  menu->addAction(tr("Scale, North and Date"), this, [this] { this->runPython("sheet()"); })
    ->setObjectName("actionSheet");
  // Pictures for the documentation, taken by tests, and what tests ask the pipeline for.
  const QString checks = qEnvironmentVariable("ROCKFALL_CHECKS");
  if (!checks.isEmpty())
  {
    menu
      ->addAction("Check", this,
        [this, checks]
        {
          pqPVApplicationCore::instance()->pythonManager()->executeCode(
            ("import runpy\nrunpy.run_path(" + quoted(checks) +
              ", {'number': " + QString::number(++this->Checks) + "})\n")
              .toUtf8());
        })
      ->setObjectName("actionCheck");
  }
  const QString folder = qEnvironmentVariable("ROCKFALL_PICTURES");
  if (!folder.isEmpty())
  {
    window->resize(QSize(1400, 900).boundedTo(window->screen()->size()));
    menu
      ->addAction("Picture", this,
        [this, window, folder]
        { window->grab().save(folder + "/window-" + QString::number(++this->Pictures) + ".png"); })
      ->setObjectName("actionPicture");
  }
  // Tests draw without smoothing, which is half of what drawing takes where there is no graphics card.
  if (qEnvironmentVariableIsSet("ROCKFALL_UNSMOOTHED"))
  {
    vtkSMSettings::GetInstance()->AddCollectionFromString(
      R"({"views": {"RenderView": {"UseFXAA": 0}}})", 1.0);
    for (pqRenderView* view : // that of the start
      pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
    {
      vtkSMPropertyHelper(view->getProxy(), "UseFXAA").Set(0);
      view->getProxy()->UpdateVTKObjects();
    }
  }
  registerPages();
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
  const NotUndone own; // a study of many steps is not taken back one by one
  this->Scripting = true;
  python->executeCode(code.toUtf8());
  this->Scripting = false;
  this->settleRuns();
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::makeReport(const QString& manifest)
{
  // The window waits for it; without a browser nothing else says where it is.
  this->tell(tr("Making the report..."));
  mainWindow()->statusBar()->repaint();
  const QDateTime start = QDateTime::currentDateTime();
  this->runPython("report(" + quoted(manifest) + ")");
  const QFileInfo page(QFileInfo(manifest).absolutePath() + "/report.html");
  this->tell(page.lastModified() >= start ? tr("Report: %1").arg(page.filePath()) : QString());
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::pickTrajectory()
{
  auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (!view)
  {
    this->tell(tr("Click into the view of the slope first"));
  }
  else if (!pqPathPicker::hasPaths(view))
  {
    this->tell(tr("This view shows no paths yet"));
  }
  else
  {
    this->Picker->begin(view);
    this->tell(tr("Click a trajectory"));
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::meetStructure()
{
  pqPipelineSource* structure = pqActiveObjects::instance().activeSource();
  if (!structure || !isOf(structure->getProxy(), { "vtkDrawnStructure" }))
  {
    this->tell(tr("Click the drawn structure in the pipeline first"));
    return;
  }
  vtkSMProxy* under = vtkSMPropertyHelper(structure->getProxy(), "Terrain").GetAsProxy();
  int met = 0;
  const pqScopedUndoSet undo(tr("Rocks Meet %1").arg(structure->getSMName()));
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    vtkSMProxy* proxy = source->getProxy();
    if (!isOf(proxy, { "vtkRockBlockSource", "vtkJointedRockMass", "vtkRockfallSimulation" }))
    {
      continue;
    }
    vtkSMPropertyHelper slope(proxy, "Terrain", true);
    if (slope.GetNumberOfElements() > 0 && slope.GetAsProxy() == under)
    {
      SM_SCOPED_TRACE(PropertiesModified).arg("proxy", proxy);
      slope.Set(structure->getProxy(), 0);
      proxy->UpdateVTKObjects();
      ++met;
    }
  }
  // ParaView 6.1 chooses a port of it as well when its rocks come to stand under it.
  pqProxySelection chosen;
  chosen.append(structure);
  pqActiveObjects::instance().setSelection(chosen, structure);
  if (met == 0)
  {
    this->tell(tr("No rocks are released on the slope that it was drawn on"));
  }
  pqApplicationCore::instance()->render();
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onPicked(pqOutputPort* port, int cell)
{
  this->tell(QString());
  this->runPython(QString("profile(%1, %2, %3)")
                    .arg(quoted(port->getSource()->getSMName()))
                    .arg(port->getPortNumber())
                    .arg(cell));
  const NotUndone own;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    if (isOf(source->getProxy(), { "vtkTrajectoryProfile" }))
    {
      pqPathPicker::fade(source->getProxy(), true);
    }
  }
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::onRemoved(pqPipelineSource* source)
{
  if (!isOf(source->getProxy(), { "vtkTrajectoryProfile" }))
  {
    return;
  }
  // Another profile of the same paths keeps them pale.
  const rockfall::window::Shown paths = rockfall::window::shownBy(source->getProxy());
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* other : model->findItems<pqPipelineSource*>())
  {
    const rockfall::window::Shown of = isOf(other->getProxy(), { "vtkTrajectoryProfile" })
      ? rockfall::window::shownBy(other->getProxy())
      : rockfall::window::Shown();
    if (other != source && of.source == paths.source && of.port == paths.port)
    {
      return;
    }
  }
  const NotUndone own;
  pqPathPicker::fade(source->getProxy(), false);
}

//-----------------------------------------------------------------------------
void pqRockfallWindow::tell(const QString& message)
{
  if (QMainWindow* window = mainWindow())
  {
    window->statusBar()->showMessage(message, kReadNotes);
    window->statusBar()->setStatusTip(message); // comes back under the mouse, as long as it is news
    QTimer::singleShot(kReadNotes, window->statusBar(),
      [bar = window->statusBar(), message]
      {
        if (bar->statusTip() == message)
        {
          bar->setStatusTip(QString());
        }
      });
  }
}
