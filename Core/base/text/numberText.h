#pragma once

#include <string>

namespace rockfall
{

/// A number for a message: shortest form of at most so many digits, whatever the locale.
std::string numberText(double value, int digits = 9);

} // namespace rockfall
