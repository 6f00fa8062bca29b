#pragma once

/// @file
/// The polygon that faces of two rocks share.

#include "contact/pairs.h"

#include <algorithm>
#include <memory>
#include <span>

namespace rockfall
{

/// Work space for some, mostly few.
template <class T, std::size_t N>
class Room
{
public:
  /// Elements before are lost.
  T* of(std::size_t count)
  {
    if (count <= N)
    {
      return few_;
    }
    many_ = std::make_unique_for_overwrite<T[]>(count);
    return many_.get();
  }

  /// Elements before go with it: `used` of them, from where they are.
  T* more(const T* there, std::size_t used, std::size_t count)
  {
    auto many = std::make_unique_for_overwrite<T[]>(count);
    std::copy_n(there, used, many.get());
    many_ = std::move(many);
    return many_.get();
  }

private:
  T few_[N];
  std::unique_ptr<T[]> many_;
};

/// A corner of the polygon.
struct Corner
{
  Vec3 point;
  int feature;               ///< Of the face that is cut: a vertex, or < 0: where a side of it is.
  alignas(16) double out[4]; ///< How far out it is of the four sides at hand, m.
};

class SharedPolygon
{
public:
  /// The face of `body` that lies towards a face of `owner`, cut by the prism over that (Sutherland
  /// & Hodgman 1974). `gap` (m): of the body's lowest vertex over it.
  SharedPolygon(
    const PairBody& body, const PairBody& owner, int ownerFace, double gap, double tolerance);

  std::size_t size() const { return size_; }
  const Corner& operator[](std::size_t i) const { return corners_[order_[i]]; }

private:
  /// Of four sides, outward.
  struct Sides
  {
    Eigen::Array2d x[2], y[2], z[2], offset[2];

    void set(const Vec3& normal, const Vec3 (&starts)[4], const Vec3 (&along)[4], double tolerance);
    void look(Corner& corner) const; ///< How far out it is.
  };
  void clip(const Sides& sides, int side, int lane, bool last);

  static constexpr std::size_t kFew = 24;
  Room<Corner, kFew> corner_;
  Room<int, kFew> orders_[2];
  std::size_t room_ = 0;      ///< Of each of these.
  Corner* corners_ = nullptr; ///< All that ever were.
  int made_ = 0;
  int* order_ = nullptr; ///< Corners of the polygon, the first one again behind them.
  int* other_ = nullptr;
  int at_ = 0; ///< Where they are of the two.
  std::size_t size_ = 0;
};

} // namespace rockfall
