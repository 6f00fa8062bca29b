#include "rockMaker.h"

#include "base/errors.h"
#include "geometry/shell.h"
#include "shapeFile.h"

#include <cmath>

namespace rockfall::filters
{

namespace
{

void requireFinite(const Vec3& value, const char* field)
{
  for (int k = 0; k < 3; ++k)
  {
    if (!std::isfinite(value[k]))
    {
      throw ParameterError(std::string(field) + " has " + numberText(value[k]) + " for its " +
        "xyz"[k] + ", it must be finite");
    }
  }
}

} // namespace

Quat orientationFromDegrees(const Vec3& angles)
{
  return Eigen::AngleAxisd(radians(angles.z()), Vec3::UnitZ()) *
    Eigen::AngleAxisd(radians(angles.x()), Vec3::UnitX()) *
    Eigen::AngleAxisd(radians(angles.y()), Vec3::UnitY());
}

Polyhedron RockMaker::shape(Shape kind, const SourceRow& row)
{
  // A volume that the row itself gives is meant; the property has one always.
  if (kind == Shape::Box)
  {
    const Polyhedron box = makeBox(row.lengths.value_or(defaults_.lengths));
    return row.volume ? box.withVolume(*row.volume) : box;
  }
  const double volume = row.volume.value_or(defaults_.volume);
  if (kind == Shape::File)
  {
    if (!haveFile_)
    {
      fromFile_ = readShape(defaults_.shapeFile, defaults_.shapeFileAsItIs, notes_).centred();
      haveFile_ = true;
    }
    return defaults_.scaleToVolume || row.volume ? fromFile_.withVolume(volume) : fromFile_;
  }
  return makeShape(kind, volume);
}

ReleasedRock RockMaker::make(const SourceRow& row, std::int64_t blockId)
{
  ReleasedRock released;
  released.shape = row.shape.value_or(defaults_.shape);
  Rock& rock = released.rock;
  rock.blockId = blockId;
  rock.shape = this->shape(released.shape, row);
  rock.position = row.position;
  const Vec3 angles = row.orientation.value_or(defaults_.orientation);
  requireFinite(rock.position, "Center");
  requireFinite(angles, "Orientation");
  rock.orientation = orientationFromDegrees(angles);
  rock.velocity = row.velocity.value_or(defaults_.velocity);
  rock.angularVelocity = row.angularVelocity.value_or(defaults_.angularVelocity);
  rock.density = row.density.value_or(defaults_.density);
  rock.youngModulus = defaults_.youngModulus;
  rock.poissonRatio = defaults_.poissonRatio;
  rock.validate();
  return released;
}

} // namespace rockfall::filters
