#include "terrain/holes.h"

#include "terrain/Terrain.h"

#include <algorithm>
#include <array>

namespace rockfall
{

bool isHole(const Terrain& terrain, double x, double y)
{
  const auto onMap = [&terrain](double px, double py)
  { return px >= 0.0 && py >= 0.0 && px <= terrain.width() && py <= terrain.height(); };
  if (!onMap(x, y) || terrain.cfeAt(x, y) != 0)
  {
    return false;
  }
  const auto hasGround = [&](double dx, double dy)
  {
    const double step = terrain.geometry().cellSize;
    double px = x, py = y;
    do
    {
      px += step * dx;
      py += step * dy;
    } while (onMap(px, py) && terrain.cfeAt(px, py) == 0);
    return onMap(px, py);
  };
  // Along a row, a column and the diagonals.
  constexpr std::array<std::array<double, 2>, 4> axes{ { { 1, 0 }, { 0, 1 }, { 1, 1 },
    { 1, -1 } } };
  return std::any_of(axes.begin(), axes.end(),
    [&](const std::array<double, 2>& axis)
    { return hasGround(axis[0], axis[1]) && hasGround(-axis[0], -axis[1]); });
}

} // namespace rockfall
