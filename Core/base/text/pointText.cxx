#include "base/text/pointText.h"

#include "base/text/numberText.h"

namespace rockfall
{

std::string pointText(const Vec3& point)
{
  std::string text = "(";
  text += numberText(point.x()) + ", " + numberText(point.y()) + ", " + numberText(point.z());
  return text + ")";
}

} // namespace rockfall
