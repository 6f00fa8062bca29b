#include "contact/ground/lowPlaces.h"

namespace rockfall
{

double bend(const HeightWindow& window, int family, int row, int column)
{
  const auto z = [&](int r, int c)
  {
    return r >= 0 && c >= 0 && r < window.rows() && c < window.columns()
      ? window.z(r, c)
      : std::numeric_limits<double>::quiet_NaN();
  };
  const auto rises = [&](int r, int c) { return isCutAlong(window, true, r, c); };
  switch (family)
  {
    case 0: // between the cells in the west and in the east: rows of their wings
    {
      const int west = rises(row, column - 1) ? row + 1 : row;
      const int east = rises(row, column) ? row : row + 1;
      return 0.5 * (z(west, column) + z(east, column) - z(west, column - 1) - z(east, column + 1));
    }
    case 1: // in the north and in the south: columns
    {
      const int north = rises(row - 1, column) ? column + 1 : column;
      const int south = rises(row, column) ? column : column + 1;
      return 0.5 * (z(row, north) + z(row, south) - z(row - 1, north) - z(row + 1, south));
    }
    default:
    {
      const double twice =
        z(row, column) + z(row + 1, column + 1) - z(row + 1, column) - z(row, column + 1);
      return isCutAlong(window, family == 3, row, column)
        ? (family == 3 ? -0.5 : 0.5) * twice
        : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

} // namespace rockfall
