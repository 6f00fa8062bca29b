#pragma once

/// @file
/// A hash of numbers, bit for bit.

#include "base/types.h"

#include <bit>
#include <cstdint>

namespace rockfall
{

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection in which every bit of the
/// input changes every bit of the result with probability one half.
inline std::uint64_t scramble(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Takes numbers one after the other.
class Mixer
{
public:
  void add(std::int64_t value) { this->add(std::uint64_t(value)); }
  void add(int value) { this->add(std::uint64_t(std::int64_t(value))); }
  void add(double value) { this->add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::uint64_t bits) { state_ = scramble(state_ ^ bits); }
  void add(const Vec3& v)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->add(v[k]);
    }
  }
  std::uint64_t value() const { return state_; }

private:
  std::uint64_t state_ = 0;
};

} // namespace rockfall
