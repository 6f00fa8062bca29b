#pragma once
#include "Benchmark/manyCubes.h"
#include "Core/piles.h"
#include "world.h"
#include <deque>
namespace spike
{
struct Scene
{
  World w;
  std::deque<Block> blocks;
  void add(const std::vector<Rock>& rocks)
  {
    for (auto& r : rocks)
    {
      blocks.emplace_back(r.shape, r.density, r.youngModulus, r.poissonRatio);
      w.add(blocks.back(), r.position, r.orientation, r.velocity, r.angularVelocity);
    }
  }
  void floor() { w.planes.push_back({ Vec3::UnitZ(), 0.0 }); }
  double overlap() const
  {
    return rockfall::testing::deepestOverlap(
      int(w.bodies.size()), [&](int i) -> const Block& { return *w.bodies[i].block; },
      [&](int i) { return w.state(i); });
  }
  void run(double d)
  {
    for (double e = w.time + d; w.time < e - 1e-9;)
      w.step();
  }
  std::vector<Vec3> places() const
  {
    std::vector<Vec3> p;
    for (auto& b : w.bodies)
      p.push_back(b.x);
    return p;
  }
  double drift(const std::vector<Vec3>& f) const
  {
    double m = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
      m = std::max(m, (w.bodies[i].x - f[i]).norm());
    return m;
  }
  double fastest() const
  {
    double m = 0;
    for (auto& b : w.bodies)
      m = std::max(m, b.v.norm());
    return m;
  }
  void totals(const Vec3& at, Vec3& p, Vec3& l, double& size, double& ke) const
  {
    p.setZero();
    l.setZero();
    size = 0;
    ke = 0;
    for (auto& b : w.bodies)
    {
      p += b.m * b.v;
      l += b.m * (b.x - at).cross(b.v) + b.L;
      size += b.m * b.v.norm();
      ke += 0.5 * b.m * b.v.squaredNorm() + 0.5 * b.L.dot(b.Iinv * b.L);
    }
  }
};
}
