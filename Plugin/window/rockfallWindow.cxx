#include "rockfallWindow.h"

#include "pqRockfallWindow.h"

#include <QCoreApplication>

void rockfallWindow()
{
  if (QCoreApplication* application = QCoreApplication::instance())
  {
    (new pqRockfallWindow(application))->begin(); // lives as long as the application
  }
}
