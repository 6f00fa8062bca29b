#include "pqRunBar.h"

#include "pqApplicationCore.h"
#include "pqProgressManager.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QMainWindow>
#include <QPushButton>
#include <QStatusBar>

namespace
{

constexpr int kReadState = 10000; // ms

} // namespace

//-----------------------------------------------------------------------------
pqRunBar::pqRunBar(QMainWindow* window)
  : Superclass(window)
  , State(new QLabel(this))
  , Stop(new QPushButton(tr("Stop"), this))
{
  this->setObjectName("rockfallRun");
  this->State->setObjectName("state");
  this->State->setMinimumWidth(1); // a long text does not make the window wider
  this->Stop->setObjectName("stop");
  this->Stop->setToolTip(tr("Ends the run; the trajectories that are made stay"));
  this->Stop->setFocusPolicy(Qt::NoFocus);
  // Heard while views are brought up to date, too.
  pqApplicationCore::instance()->getProgressManager()->addNonBlockableObject(this->Stop);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(this->State);
  row->addWidget(this->Stop);
  // ParaView's own progress and memory give way.
  window->statusBar()->insertPermanentWidget(0, this);
  this->hide();
  this->connect(this->Stop, &QPushButton::clicked, this,
    [this]
    {
      this->Stop->setEnabled(false);
      Q_EMIT this->stopped();
    });
  this->Gone.setSingleShot(true);
  this->Gone.setInterval(kReadState);
  this->connect(&this->Gone, &QTimer::timeout, this, &QWidget::hide);
}

//-----------------------------------------------------------------------------
void pqRunBar::tell(const QString& state, bool running)
{
  if (!running)
  {
    this->Stop->hide();
    this->Stop->setEnabled(true);
  }
  if (state.isEmpty())
  {
    return;
  }
  this->State->setText(state);
  this->State->setToolTip(state);
  this->Stop->setVisible(running);
  this->show();
  if (running)
  {
    this->Gone.stop();
  }
  else
  {
    this->Gone.start();
  }
}
