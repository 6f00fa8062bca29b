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
  Int64,
  UInt64,
  Float32,
  Float64,
};

constexpr int sizeOf(NumberType type)
{
  constexpr int sizes[] = { 0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8 };
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

/// A number of any type as a double; whole ones beyond 2⁵³ lose digits.
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
    case NumberType::Int64:
      return double(takeNumber<std::int64_t>(bytes, bigEndian));
    case NumberType::UInt64:
      return double(takeNumber<std::uint64_t>(bytes, bigEndian));
    case NumberType::Float32:
      return takeNumber<float>(bytes, bigEndian);
    case NumberType::Float64:
      return takeNumber<double>(bytes, bigEndian);
    case NumberType::None:
      break;
  }
  return 0.0;
}

/// A whole number of an integral type; those beyond the range of 64 bits with sign are −1.
inline std::int64_t takeInteger(NumberType type, const char* bytes, bool bigEndian)
{
  if (type == NumberType::Int64)
  {
    return takeNumber<std::int64_t>(bytes, bigEndian);
  }
  if (type == NumberType::UInt64)
  {
    const auto value = takeNumber<std::uint64_t>(bytes, bigEndian);
    return value <= std::uint64_t(INT64_MAX) ? std::int64_t(value) : -1;
  }
  return isReal(type) ? -1 : std::int64_t(takeNumber(type, bytes, bigEndian));
}

} // namespace rockfall
