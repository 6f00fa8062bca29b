#pragma once

/// @file
/// How what the plugin makes looks when it is first shown.

class vtkSMProxy;
class vtkSMSourceProxy;
class vtkSMViewProxy;

namespace rockfall::window
{

/// What is shown: the source's name in the XML, and its output port.
struct Shown
{
  vtkSMSourceProxy* source = nullptr;
  int port = 0;
};
Shown shownBy(vtkSMProxy* representation);

/// Colours, widths and palettes of a representation that was just made. Nothing for what is not
/// ours.
void style(vtkSMProxy* representation);

/// The palette's range is that of what is shown.
void rescale(vtkSMProxy* representation);

/// The same for what a view decides: legends, titles of charts. To be called when it is in `view`.
void styleIn(vtkSMProxy* representation, vtkSMViewProxy* view);

} // namespace rockfall::window
