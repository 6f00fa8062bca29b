#include "pqMessageBar.h"

#include "looks.h"

#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkSMFileListDomain.h"
#include "vtkSMOrderedPropertyIterator.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkStringArray.h"

#include <QAction>
#include <QLabel>
#include <QMainWindow>
#include <QMultiHash>
#include <QStringList>

#include <algorithm>

namespace
{

constexpr int kCloseWidth = 80; // px, of what stands beside the text
constexpr int kMostNotes = 6;   // objects; more would leave the views little room

/// The texts of a field array of any output; nothing if the data are on another machine.
QStringList textsOf(vtkSMSourceProxy* source, const char* array)
{
  QStringList all;
  auto* algorithm = vtkAlgorithm::SafeDownCast(source->GetClientSideObject());
  for (int port = 0; algorithm && port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* data = algorithm->GetOutputDataObject(port);
    auto* texts =
      vtkStringArray::SafeDownCast(data ? data->GetFieldData()->GetAbstractArray(array) : nullptr);
    for (vtkIdType k = 0; texts && k < texts->GetNumberOfValues(); ++k)
    {
      all << QString::fromUtf8(texts->GetValue(k).c_str());
    }
  }
  all.removeDuplicates();
  return all;
}

/// A message with the field of the panel before it whose file it names: of a file that was moved
/// nobody knows whether it was the slope's or that of its trees.
QString withField(vtkSMSourceProxy* source, const QString& text)
{
  vtkNew<vtkSMOrderedPropertyIterator> properties;
  properties->SetProxy(source);
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    vtkSMProperty* property = properties->GetProperty();
    if (!property->FindDomain<vtkSMFileListDomain>())
    {
      continue;
    }
    const QString label = QString::fromUtf8(property->GetXMLLabel());
    const vtkSMPropertyHelper files(property, true);
    for (unsigned int k = 0; k < files.GetNumberOfElements(); ++k)
    {
      const QString file = QString::fromUtf8(files.GetAsString(k));
      if (!file.isEmpty() && text.startsWith(file))
      {
        return label + ": " + text;
      }
    }
  }
  return text;
}

/// Whether what a source makes comes by its inputs from another one, or that is itself.
bool comesFrom(pqPipelineSource* source, pqPipelineSource* other)
{
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  const QList<pqOutputPort*> inputs = filter ? filter->getAllInputs() : QList<pqOutputPort*>();
  return source == other ||
    std::any_of(inputs.begin(), inputs.end(),
      [other](pqOutputPort* input) { return comesFrom(input->getSource(), other); });
}

/// Structures that were drawn, and that no rocks fall on.
QStringList toldOfStructures()
{
  QStringList notes;
  for (pqPipelineSource* source :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    if (rockfall::window::isOf(source->getProxy(), { "vtkDrawnStructure" }) &&
      source->modifiedState() != pqProxy::UNINITIALIZED && source->getNumberOfConsumers() == 0)
    {
      notes << "<b>" + source->getSMName().toHtmlEscaped() +
          "</b>: " + QObject::tr("no rocks fall on it yet: Rockfall, Rocks Meet This Structure");
    }
  }
  return notes;
}

} // namespace

//-----------------------------------------------------------------------------
pqMessageBar::pqMessageBar(QMainWindow* window)
  : Superclass(tr("Rockfall Messages"), window)
  , Text(new QLabel(this))
{
  this->setObjectName("rockfallMessages");
  this->setMovable(false);
  this->Text->setObjectName("text");
  this->Text->setWordWrap(true);
  this->Text->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->Text->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  this->addWidget(this->Text);
  this->connect(this->addAction(tr("Close")), &QAction::triggered, this,
    [this]
    {
      this->Closed = this->Told;
      this->setVisible(false);
    });
  window->addToolBar(Qt::BottomToolBarArea, this);
  this->setVisible(false);
}

//-----------------------------------------------------------------------------
void pqMessageBar::look()
{
  QStringList errors, notes;
  QMultiHash<QString, pqPipelineSource*> told;
  for (const char* array : { "Error", "Notes" })
  {
    for (pqPipelineSource* source :
      pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
    {
      vtkSMSourceProxy* proxy = source->getSourceProxy();
      const bool ours = proxy && QString(proxy->GetXMLGroup()) != "extended_sources" &&
        source->modifiedState() != pqProxy::UNINITIALIZED;
      const QStringList texts = ours ? textsOf(proxy, array) : QStringList();
      const bool error = QString(array) == "Error";
      QStringList fresh;
      for (const QString& text : texts)
      {
        // Filters after a failed one have the same text: the first one says it.
        const QList<pqPipelineSource*> before = told.values(text);
        if (std::none_of(before.begin(), before.end(),
              [source](pqPipelineSource* one) { return comesFrom(source, one); }))
        {
          told.insert(text, source);
          fresh << (error ? withField(proxy, text) : text).toHtmlEscaped();
        }
      }
      if (!fresh.isEmpty())
      {
        (error ? errors : notes) << "<b>" + source->getSMName().toHtmlEscaped() +
            "</b>: " + fresh.join("<br>&nbsp;&nbsp;&nbsp;");
      }
    }
  }
  notes += toldOfStructures();
  this->Told = errors + notes;
  QStringList closed; // and still so
  for (const QString& line : this->Closed)
  {
    if (this->Told.contains(line))
    {
      closed << line;
      errors.removeAll(line);
      notes.removeAll(line);
    }
  }
  this->Closed = closed;
  if (const int more = int(notes.size()) - kMostNotes; more > 0)
  {
    // The last ones are of the study that is worked on.
    notes = notes.mid(more);
    notes.prepend(tr("Earlier notes (%1): View, Output Messages").arg(more));
  }
  const QString text = (errors + notes).join("<br>");
  if (text.isEmpty())
  {
    this->setVisible(false); // ParaView brings bars back as they were when it was left
  }
  if (text == this->Shown)
  {
    return;
  }
  this->Shown = text;
  this->Text->setText(text);
  this->Text->setStyleSheet(!errors.isEmpty()
      ? "QLabel { background: #ffd9a8; color: black; padding: 4px; }"
      : "QLabel { padding: 4px; }");
  this->fit();
  this->setVisible(!text.isEmpty());
}

//-----------------------------------------------------------------------------
void pqMessageBar::resizeEvent(QResizeEvent* event)
{
  this->Superclass::resizeEvent(event);
  this->fit();
}

//-----------------------------------------------------------------------------
void pqMessageBar::fit()
{
  // A tool bar gives a text of several lines far more than these. The width is known before it is
  // shown, or it would come tall and shrink, and the views be drawn for both.
  const int width = this->isVisible() ? this->Text->width() : 0;
  this->Text->setFixedHeight(
    this->Text->heightForWidth(std::max(width, this->parentWidget()->width() - kCloseWidth)));
}
