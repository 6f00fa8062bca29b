#pragma once

/// @file
/// Changes of the plugin's own, kept off the undo stack.

#include "pqApplicationCore.h"
#include "pqUndoStack.h"

#include <QPointer>

namespace rockfall::window
{

/// While it lives nothing goes on the undo stack: legends, ranges and times that follow the data are
/// nothing that somebody did, and Undo would take them back one by one before what was done.
class NotUndone
{
public:
  NotUndone()
    : stack_(pqApplicationCore::instance()->getUndoStack())
  {
    if (stack_)
    {
      stack_->beginNonUndoableChanges();
    }
  }
  ~NotUndone()
  {
    if (stack_)
    {
      stack_->endNonUndoableChanges();
    }
  }
  NotUndone(const NotUndone&) = delete;
  NotUndone& operator=(const NotUndone&) = delete;

private:
  QPointer<pqUndoStack> stack_;
};

} // namespace rockfall::window
