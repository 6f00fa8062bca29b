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

std::string boundsText(const Eigen::AlignedBox2d& box, int digits)
{
  const auto along = [&](int axis)
  { return numberText(box.min()[axis], digits) + " to " + numberText(box.max()[axis], digits); };
  return "x " + along(0) + ", y " + along(1);
}

} // namespace rockfall
