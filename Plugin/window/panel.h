#pragma once

/// @file
/// ParaView's window and its properties panel: units of captions, and its width.

class QMainWindow;
class vtkSMSessionProxyManager;

namespace rockfall::window
{

/// ParaView's window, null before there is one.
QMainWindow* mainWindow();

/// Units behind the captions of the panel, from the properties' hints: a caption in the XML is the
/// property's name in Python, where a unit would have to be part of it.
void showUnits(QMainWindow* window);

/// Choices as narrow as their column: one with a long entry makes the panel wider than its dock, and
/// the buttons of its files are out of sight.
void narrowChoices(QMainWindow* window);

/// Numbers of nine digits where the user has not chosen how many: coordinates of a map need them,
/// ParaView's six are some 10 m there.
void showCentimetres(vtkSMSessionProxyManager* session);

/// Panels as wide as what stands in them: 400 px, in a window of less than 1200 px a third of it. Once for
/// each user, and again in a wider window.
void widenPanels(QMainWindow* window);

} // namespace rockfall::window
