#include "panel.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPropertyWidget.h"
#include "pqSettings.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettings.h"

#include <QAbstractItemView>
#include <QComboBox>
#include <QDockWidget>
#include <QGridLayout>
#include <QLabel>
#include <QMainWindow>
#include <QString>

#include <algorithm>
#include <string>

namespace rockfall::window
{

QMainWindow* mainWindow()
{
  return qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

void narrowChoices(QMainWindow* window)
{
  constexpr int narrow = 120; // px
  auto* panel = window->findChild<QDockWidget*>("propertiesDock");
  const QList<QComboBox*> choices = panel ? panel->findChildren<QComboBox*>() : QList<QComboBox*>();
  for (QComboBox* choice : choices)
  {
    QWidget* parent = choice;
    while (parent && !qobject_cast<pqPropertyWidget*>(parent))
    {
      parent = parent->parentWidget();
    }
    auto* property = qobject_cast<pqPropertyWidget*>(parent);
    const QString group = property ? property->proxy()->GetXMLGroup() : "";
    if ((group == "sources" || group == "filters") && choice->minimumWidth() < narrow)
    {
      choice->setMinimumWidth(narrow);
      choice->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
      choice->view()->setMinimumWidth(choice->view()->sizeHintForColumn(0));
    }
  }
}

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
      QString::fromUtf8("\u00a0(%1)").arg(QString::fromUtf8(unit->GetAttribute("text")));
    if (QString shown = label ? label->text() : QString(); label && !shown.contains(text))
    {
      const int end = shown.lastIndexOf("</"); // of a paragraph, which labels may be
      label->setText(shown.insert(end < 0 ? shown.size() : end, text));
      grid->setAlignment(label, Qt::AlignTop); // as wide as its column, or short names break in two
    }
  }
}

void showCentimetres(vtkSMSessionProxyManager* session)
{
  constexpr int digits = 9; // of 1,000,000.00 m
  constexpr const char* precision = "RealNumberDisplayedPrecision";
  vtkSMProxy* general = session->GetProxy("settings", "GeneralSettings");
  if (general && general->GetProperty(precision) &&
    vtkSMPropertyHelper(general, precision).GetAsInt() < digits &&
    !vtkSMSettings::GetInstance()->HasSetting(
      (std::string(".settings.GeneralSettings.") + precision).c_str()))
  {
    vtkSMPropertyHelper(general, precision).Set(digits);
    general->UpdateVTKObjects();
  }
}

void widenPanels(QMainWindow* window)
{
  constexpr const char* done = "RockfallPanelsWidth";
  const int wide = std::min(400, 3 * window->width() / 8); // px: as ParaView 6.1 takes of 1024
  pqSettings* settings = pqApplicationCore::instance()->settings();
  auto* panel = window->findChild<QDockWidget*>("propertiesDock");
  if (!panel || !panel->isVisible() || settings->value(done, 0).toInt() >= wide)
  {
    return;
  }
  if (panel->width() >= wide)
  {
    settings->setValue(done, wide);
  }
  else if (!panel->isFloating())
  {
    // resizeDocks has no effect before the window has laid out its docks: a later look sees whether it had.
    window->resizeDocks({ panel }, { wide }, Qt::Horizontal);
  }
}

} // namespace rockfall::window
