#pragma once

/// @file
/// Numbers in bytes of either order.

#include "base/types.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace rockfall
{

enum class NumberType
{
  None,
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Float32,
  Float64,
};

constexpr int sizeOf(NumberType type)
{
  constexpr int sizes[] = { 0, 1, 1, 2, 2, 4, 4, 4, 8 };
  return sizes[int(type)];
}

constexpr bool isReal(NumberType type)
{
  return type == NumberType::Float32 || type == NumberType::Float64;
}

/// `bytes` must be long enough.
template <typename T>
T takeNumber(const char* bytes, bool bigEndian)
{
  char ordered[sizeof(T)];
  std::memcpy(ordered, bytes, sizeof(T));
  if (bigEndian != (std::endian::native == std::endian::big))
  {
    std::reverse(ordered, ordered + sizeof(T));
  }
  T value;
  std::memcpy(&value, ordered, sizeof(T));
  return value;
}

/// A number of any type as a double.
inline double takeNumber(NumberType type, const char* bytes, bool bigEndian)
{
  switch (type)
  {
    case NumberType::Int8:
      return takeNumber<std::int8_t>(bytes, bigEndian);
    case NumberType::UInt8:
      return takeNumber<std::uint8_t>(bytes, bigEndian);
    case NumberType::Int16:
      return takeNumber<std::int16_t>(bytes, bigEndian);
    case NumberType::UInt16:
      return takeNumber<std::uint16_t>(bytes, bigEndian);
    case NumberType::Int32:
      return takeNumber<std::int32_t>(bytes, bigEndian);
    case NumberType::UInt32:
      return takeNumber<std::uint32_t>(bytes, bigEndian);
    case NumberType::Float32:
      return takeNumber<float>(bytes, bigEndian);
    case NumberType::Float64:
      return takeNumber<double>(bytes, bigEndian);
    case NumberType::None:
      break;
  }
  return 0.0;
}

} // namespace rockfall
