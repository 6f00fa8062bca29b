#pragma once

#include "base/types.h"

#include <string>

namespace rockfall
{

/// A place or a vector for a message: (x, y, z), each as `numberText` writes it.
std::string pointText(const Vec3& point);

} // namespace rockfall
