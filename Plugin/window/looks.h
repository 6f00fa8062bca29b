#pragma once

/// @file
/// How what the plugin makes looks when it is first shown.

#include <initializer_list>

class vtkSMProxy;
class vtkSMSourceProxy;
class vtkSMViewProxy;

namespace rockfall::window
{

/// Whether a proxy is of one of these classes, under whatever name.
bool isOf(vtkSMProxy* proxy, std::initializer_list<const char*> classNames);

/// Content of the view, and its output port.
struct Shown
{
  vtkSMSourceProxy* source = nullptr;
  int port = 0;
};
Shown shownBy(vtkSMProxy* representation);

/// The whole paths of growing ones; all else as it is.
Shown wholePaths(const Shown& shown);

/// Colours, widths and palettes of a representation that was just made. Nothing for what is not
/// ours.
void style(vtkSMProxy* representation);

/// Looks that hang on the data, when they are new: the range of a palette, the text of a chart.
void follow(vtkSMProxy* representation, vtkSMViewProxy* view);

/// The same for what a view decides: legends, titles of charts. To be called when it is in `view`.
void styleIn(vtkSMProxy* representation, vtkSMViewProxy* view);

} // namespace rockfall::window
