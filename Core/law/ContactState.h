#pragma once

/// @file
/// Shi's contact states.

#include <cstdint>

namespace rockfall
{

enum class ContactState : std::uint8_t
{
  Open,
  Sliding,
  Locked,
};

} // namespace rockfall
