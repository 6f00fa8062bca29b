#pragma once
// Spike of one island solver for 2 and for 10,000 rocks. Two designs in one frame:
//   Resolved: explicit penalty springs, n substeps per step follow the stiffest impact.
//   Soft:     implicit soft rows (Macklin 2019 / Box2D 3), fixed n, restitution in each substep.
#include "block/Block.h"
#include "block/cayley.h"
#include "contact/PlacedBlock.h"
#include "contact/pairTouch.h"
#include "contact/pairs.h"
#include "law/settings.h"
#include "law/springs.h"
#include "system/broadPhase.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace spike
{
using namespace rockfall;
enum class Design
{
  Resolved,
  Soft
};
struct Plane
{
  Vec3 n;
  double d;
};
struct Field // heights on a grid: vertices on triangles only
{
  int n = 0;
  double cell = 1;
  std::vector<double> z, top;
  double at(int i, int j) const { return z[std::size_t(n - 1 - j) * n + i]; }
  void make(std::vector<double> heights, int nodes, double c)
  {
    z = std::move(heights);
    n = nodes;
    cell = c;
    top.assign(z.size(), -1e9);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (int b = -1; b <= 2; ++b)
          for (int a = -1; a <= 2; ++a)
            if (i + a >= 0 && i + a < n && j + b >= 0 && j + b < n)
              top[std::size_t(j) * n + i] = std::max(top[std::size_t(j) * n + i], at(i + a, j + b));
  }
  double highest(const Vec3& x) const
  {
    return top[std::size_t(std::clamp(int(x.y() / cell), 0, n - 2)) * n +
      std::clamp(int(x.x() / cell), 0, n - 2)];
  }
  int plane(const Vec3& x, Vec3& normal, double& d) const
  {
    const double fx = x.x() / cell, fy = x.y() / cell;
    const int i = std::clamp(int(fx), 0, n - 2), j = std::clamp(int(fy), 0, n - 2);
    const double u = fx - i, v = fy - j, a = at(i, j), b = at(i + 1, j), c = at(i, j + 1),
                 e = at(i + 1, j + 1);
    const bool lower = u + v < 1;
    const double sx = (lower ? b - a : e - c) / cell, sy = (lower ? c - a : e - b) / cell;
    normal = Vec3(-sx, -sy, 1) / std::sqrt(1 + sx * sx + sy * sy);
    const Vec3 p = lower ? Vec3(i * cell, j * cell, a) : Vec3((i + 1) * cell, (j + 1) * cell, e);
    d = normal.dot(p);
    return 2 * (j * n + i) + lower;
  }
};
struct Settings
{
  Design design = Design::Resolved;
  double dt = 0.005, g = 9.81;
  double penalty = 1e9;
  double e = 0.5, mu = 0.577, eGround = 0.3, muGround = 0.7;
  double perHalf = 8;           // substeps per half period (Resolved)
  int minSub = 4, maxSub = 256; // bounds of n
  double floorOmega = 2500;     // springs of light rocks are resolved to this at least, rad/s
  double deepest = 0.01;        // of r, impact depth (stiffens)
  double softDeepest = 0.05;    // of r, to which a light rock's spring may be softened
  double recover = 0.1, groundFirm = 10;
  double slack = 0.01, slackSpeed = 0.5; // margin: of r; of the way that speed makes
  int softSub = 8;                       // n (Soft)
  double zetaSoft = 1.0;
  double hertzCap = 0.25; // of the substep rate (Soft)
  int bouncePasses = 200;
  double bounceTol = 1e-3, quiet = 0.1;
  bool halve = true;
  double look = 0.009; // overlap at the end, of r, from which a step is done again in halves
  double far = 0.25; // deviation, of r, from the foreseen way, beyond the margin, from which it is
  int depth = 6;
  double finer = 1.0;
  double kappa = 0.7, sigma = 0.2; // friction of Resolved: dashpot, spring
  int generations = 6;
  double slop = 0.0;
};
struct Mem // of a contact, from step to step
{
  int kind = -1, f1 = -1, f2 = -1;
  Vec3 point;
  double gap = 0, offset = 0, P = 0, c = 0, p = 0, vin = 0;
  Vec3 Pt = Vec3::Zero();
};
struct Body
{
  Vec3 x, v, w, L;
  Quat q;
  double im, m, r, iiso;
  bool iso;
  Mat3 Ib, IbInv, Iinv;
  const Block* block;
  // step
  Vec3 x0, v0, w0, L0;
  Quat q0;
  double s; // margin
  int island, place;
  std::vector<Mem> ground;
  double low0;
};
struct Pair
{
  int a, b;
  PairAxis axis;
  int count = 0;
  bool touches = false;
  bool fresh = false; // the axis is that of where the rocks stand
  double before = 0;  // gap at the start of the step
  PairAxis end;
  std::vector<Mem> mem;
};
struct SBody // while solved
{
  Vec3 v, w;
  double im;
  double iiso;
  Vec3 dx, dth;
  bool iso;
  Mat3 Iinv;
  Vec3 L;
  int of;
  bool touched;
  Vec3 vb;
};
struct Row
{
  int a, b;                // places; b < 0: ground. The point moves with a.
  Vec3 n, l1, a1, a2, l20; // n from b to a
  double g0, g;
  double p, c, meff, mt, mu, e;
  double P = 0, Q = 0;
  Vec3 Pt = Vec3::Zero(), Qt = Vec3::Zero();
  double cmax, vin, vpre, offset, rsmall;
  bool closed;
  // provenance
  int pair, body;
  Mem mem;
};
struct Books
{
  double friction = 0, dash = 0, yield = 0, hand = 0, gained = 0;
};
struct Timers
{
  double place = 0, broad = 0, axis = 0, touch = 0, rows = 0, solve = 0, rest = 0;
};
inline double now()
{
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

class World
{
public:
  Settings set;
  std::vector<Plane> planes;
  Field field;
  std::vector<Body> bodies;
  std::vector<Pair> pairs;
  Books books;
  Timers t;
  long substeps = 0, islandsSolved = 0, redone = 0, rowsTotal = 0, rowSub = 0, closedSub = 0,
       bodySub = 0, solvedBodies = 0, steps = 0, generationsRun = 0, bounceRows = 0, held = 0,
       axes = 0, st[10] = {};
  int largest = 0;
  double time = 0;
  bool booking = true;

  int add(const Block& block, const Vec3& x, const Quat& q, const Vec3& v, const Vec3& w)
  {
    Body b;
    b.block = &block;
    b.x = x;
    b.q = q.normalized();
    b.v = v;
    b.w = w;
    b.m = block.mass();
    b.im = 1 / b.m;
    b.r = block.radius();
    b.iso = block.isotropic();
    b.Ib = block.inertia();
    b.IbInv = block.inverseInertia();
    b.iiso = b.IbInv(0, 0);
    const Mat3 R = b.q.toRotationMatrix();
    b.Iinv = b.iso ? Mat3(b.iiso * Mat3::Identity()) : Mat3(R * b.IbInv * R.transpose());
    b.L = R * b.Ib * R.transpose() * w;
    bodies.push_back(b);
    placed_.emplace_back();
    pb_.emplace_back();
    return int(bodies.size()) - 1;
  }
  BlockState state(int i) const
  {
    BlockState s;
    const Body& b = bodies[i];
    s.position = b.x;
    s.orientation = b.q;
    s.velocity = b.v;
    s.spin = b.q.conjugate() * b.w;
    return s;
  }
  double energy() const // kinetic + potential + springs
  {
    double e = 0;
    for (auto& b : bodies)
    {
      e += 0.5 * b.m * b.v.squaredNorm() + 0.5 * b.L.dot(b.Iinv * b.L) + b.m * set.g * b.x.z();
      for (auto& m : b.ground)
        e += 0.5 * m.p * std::pow(std::min(0.0, m.gap), 2);
    }
    for (auto& p : pairs)
      for (int k = 0; k < p.count; ++k)
        e += 0.5 * p.mem[k].p * std::pow(std::min(0.0, p.mem[k].gap), 2);
    return e;
  }
  void step()
  {
    ++steps;
    double t0 = now();
    const int N = int(bodies.size());
    all_.resize(N);
    boxes_.resize(N);
    stands_.resize(N);
    for (int i = 0; i < N; ++i)
    {
      all_[i] = i;
      Body& b = bodies[i];
      margin(b, set.dt);
      boxes_[i].center = b.x + 0.5 * set.dt * b.v;
      boxes_[i].radius = b.r + 0.5 * set.dt * b.v.norm() + b.s;
    }
    broad_.place(boxes_);
    auto near = broad_.pairs();
    // merge with what was
    std::vector<Pair>& next = next_;
    std::size_t k = 0;
    std::size_t used = 0;
    if (next.size() < near.size())
      next.resize(near.size());
    for (auto& p : near)
    {
      while (k < pairs.size() && (pairs[k].a < p[0] || (pairs[k].a == p[0] && pairs[k].b < p[1])))
      {
        lost(pairs[k]);
        ++k;
      }
      Pair& to = next[used++];
      if (k < pairs.size() && pairs[k].a == p[0] && pairs[k].b == p[1])
      {
        std::swap(to, pairs[k]);
        ++k;
      }
      else
      {
        to.a = p[0];
        to.b = p[1];
        to.axis = PairAxis();
        to.count = 0;
        to.fresh = false;
      }
    }
    while (k < pairs.size())
      lost(pairs[k++]);
    next.resize(used);
    std::swap(pairs, next);
    allPairs_.resize(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      allPairs_[i] = int(i);
    t.broad += now() - t0;
    advance(all_, allPairs_, set.dt, 0);
    time += set.dt;
  }

private:
  std::vector<PlacedBlock> placed_;
  std::vector<PairBody> pb_;
  std::vector<char> stands_;
  std::vector<int> all_, allPairs_;
  std::vector<BroadBox> boxes_;
  std::vector<Pair> next_;
  BroadPhase broad_;
  std::vector<int> parent_;

  void lost(Pair& p)
  {
    for (int k = 0; k < p.count; ++k)
      books.hand += 0.5 * p.mem[k].p * std::pow(std::min(0.0, p.mem[k].gap), 2);
    p.count = 0;
  }
  void margin(Body& b, double dt)
  {
    b.s = set.slack * b.r + set.slackSpeed * dt * std::max(b.v.norm(), 1.0);
  }
  int root(int i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  static Vec3 turned(const Vec3& x, const Vec3& th)
  {
    return x + th.cross(x) + 0.5 * th.cross(th.cross(x));
  }

  /// A row of a point on `a` over a plane of normal n (towards a).
  void row(std::vector<Row>& rows, int a, int b, const Vec3& point, const Vec3& n, double d,
    double dt, bool ownerIsB, const Mem* old, int kind, int f1, int f2, int pair, int body)
  {
    Row r;
    Body& A = bodies[a];
    Body* B = b >= 0 ? &bodies[b] : nullptr;
    r.a = a;
    r.b = b;
    const Vec3 l0 = point - A.x;
    r.l1 = turned(l0, 0.5 * dt * A.w);
    r.n = B ? turned(n, 0.5 * dt * (ownerIsB ? B->w : Vec3(0.5 * (A.w + B->w)))).normalized() : n;
    r.l20 = B ? Vec3(r.l1 + A.x - B->x) : Vec3::Zero();
    r.a1 = r.l1.cross(r.n);
    double mob = A.im + r.a1.dot(A.Iinv * r.a1), mobt = A.im + A.iiso * r.l1.squaredNorm();
    double rs = A.r;
    if (B)
    {
      r.a2 = r.l20.cross(r.n);
      mob += B->im + r.a2.dot(B->Iinv * r.a2);
      mobt += B->im + B->iiso * r.l20.squaredNorm();
      rs = std::min(rs, B->r);
    }
    else
      r.a2 = Vec3::Zero();
    if (!A.iso || (B && !B->iso))
    {
      mobt = A.im + A.Iinv.trace() * r.l1.squaredNorm();
      if (B)
        mobt += B->im + B->Iinv.trace() * r.l20.squaredNorm();
    }
    r.meff = 1 / mob;
    r.mt = 1 / mobt;
    Vec3 u = A.v + A.w.cross(l0);
    if (B)
      u -= B->v + B->w.cross(point - B->x);
    const double vn = u.dot(r.n);
    r.vpre = vn;
    r.rsmall = rs;
    r.mu = b < 0 ? set.muGround : set.mu;
    r.e = b < 0 ? set.eGround : set.e;
    r.mem.kind = kind;
    r.mem.f1 = f1;
    r.mem.f2 = f2;
    r.mem.point = point;
    r.pair = pair;
    r.body = body;
    if (old)
    {
      r.g0 = old->gap;
      r.offset = d - old->gap;
      if (old->gap >= 0)
      {
        r.offset = std::min(0.0, old->offset);
        r.g0 = d - r.offset;
      }
      r.P = old->P;
      r.Pt = old->Pt - r.n * r.n.dot(old->Pt);
      r.c = old->c;
      r.p = old->p;
      r.vin = old->vin;
    }
    else
    {
      r.offset = std::min(0.0, d);
      r.g0 = d - r.offset;
      r.c = 0;
      r.p = 0;
      r.vin = 0;
    }
    // recover: the spring is compressed by no more than a speed
    const double by = set.recover * std::min(1.0, std::sqrt(std::max(set.g, 1e-3) * rs)) * dt;
    if (set.design == Design::Resolved)
    {
      const double before = 0.5 * r.p * std::pow(std::min(0.0, r.g0), 2);
      const double o = r.offset < 0 ? std::min(0.0, r.offset + by) : std::max(0.0, r.offset - by);
      r.g0 -= o - r.offset;
      r.offset = o;
      const double approach = std::max(0.0, -vn);
      double w2 = set.penalty * mob;                                 // as asked for
      w2 = std::max(w2, std::pow(approach / (set.deepest * rs), 2)); // stiffened
      const double need = std::max(set.floorOmega, approach / (set.softDeepest * rs));
      w2 = std::min(w2, need * need); // light rocks: no stiffer than it takes
      const double p = w2 * r.meff;
      if (r.g0 >= 0 || r.p == 0)
        r.p = p; // a compressed spring stays what it is
      if (old)
        books.gained += 0.5 * r.p * std::pow(std::min(0.0, r.g0), 2) - before;
    }
    else
    {
      r.g0 = d;
      r.offset = 0;
      r.p = set.penalty;
    }
    r.g = r.g0;
    r.closed = r.g0 < 0;
    rows.push_back(r);
  }
  static const Mem* find(const std::vector<Mem>& mem, int count, std::vector<char>& taken, int kind,
    int f1, int f2, const Vec3& point, double same)
  {
    for (int k = 0; k < count; ++k)
      if (!taken[k] && mem[k].kind == kind && mem[k].f1 == f1 && mem[k].f2 == f2 &&
        (mem[k].f1 >= 0 || (mem[k].point - point).norm() < same))
      {
        taken[k] = 1;
        return &mem[k];
      }
    for (int k = 0; k < count; ++k)
      if (!taken[k] && (mem[k].point - point).squaredNorm() < same * same)
      {
        taken[k] = 1;
        return &mem[k];
      }
    return nullptr;
  }
  /// Energy of springs that are gone goes to those that are new.
  void handOver(std::vector<Row>& rows, std::size_t from, const std::vector<Mem>& mem, int count,
    const std::vector<char>& taken)
  {
    if (set.design != Design::Resolved)
      return;
    double E = 0;
    const Mem* strong = nullptr;
    for (int k = 0; k < count; ++k)
      if (!taken[k] && mem[k].gap < 0)
      {
        E += 0.5 * mem[k].p * mem[k].gap * mem[k].gap;
        strong = !strong || mem[k].gap < strong->gap ? &mem[k] : strong;
      }
    if (E == 0)
      return;
    int fresh = 0;
    for (std::size_t i = from; i < rows.size(); ++i)
      fresh += rows[i].g0 >= 0 && rows[i].offset < 0;
    if (!fresh)
    {
      books.hand += E;
      return;
    }
    for (std::size_t i = from; i < rows.size(); ++i)
    {
      Row& r = rows[i];
      if (!(r.g0 >= 0 && r.offset < 0))
        continue;
      const double comp = std::sqrt(2 * E / fresh / r.p), d = r.g0 + r.offset;
      r.g0 = r.g = -comp;
      r.offset = d + comp;
      r.c = strong->c;
      r.closed = true;
      r.vin = strong->vin;
    }
  }

  void advance(const std::vector<int>& who, const std::vector<int>& which, double dt, int depth)
  {
    double t0 = now();
    for (int i : who)
    {
      Body& b = bodies[i];
      margin(b, dt);
      b.x0 = b.x;
      b.v0 = b.v;
      b.w0 = b.w;
      b.L0 = b.L;
      b.q0 = b.q;
      BlockState s;
      s.position = b.x;
      s.orientation = b.q;
      if (!stands_[i])
      {
        placed_[i].place(*b.block, s);
        pb_[i].update(placed_[i]);
        stands_[i] = 1;
      }
      b.low0 = 0;
    }
    double t1 = now();
    t.place += t1 - t0;
    std::vector<Row> rows;
    std::vector<char> taken;
    const Vec3 G(0, 0, -set.g);
    t0 = now();
    for (int k : which)
    {
      Pair& p = pairs[k];
      Body &A = bodies[p.a], &B = bodies[p.b];
      p.before = 0;
      p.touches = false;
      const Vec3 vr = A.v - B.v;
      const double s = A.s + B.s, far = A.r + B.r + s + dt * vr.norm();
      if ((A.x - B.x).squaredNorm() > far * far)
      {
        lost(p);
        continue;
      }
      const double rims = A.w.norm() * A.r + B.w.norm() * B.r;
      const double reach = s + dt * (vr.norm() + rims);
      if (!p.fresh)
      {
        p.axis = findAxis(pb_[p.a], pb_[p.b], p.axis, reach);
        ++axes;
      }
      p.fresh = true;
      p.before = p.axis.distance;
      const double along = s + dt * std::max(0.0, rims - p.axis.normal.dot(vr));
      if (p.axis.distance > std::min(reach, along))
      {
        lost(p);
        continue;
      }
      p.touches = true;
    }
    t1 = now();
    t.axis += t1 - t0;
    for (int k : which)
    {
      Pair& p = pairs[k];
      if (!p.touches)
        continue;
      Body &A = bodies[p.a], &B = bodies[p.b];
      const Vec3 vr = A.v - B.v;
      const double s = A.s + B.s,
                   reach = s + dt * (vr.norm() + A.w.norm() * A.r + B.w.norm() * B.r);
      auto found = touchesAlong(pb_[p.a], pb_[p.b], p.axis, reach);
      found = orAlongBest(found, pb_[p.a], pb_[p.b], p.axis, reach);
      taken.assign(p.count, 0);
      const std::size_t from = rows.size();
      const double same = 0.05 * std::min(A.r, B.r);
      for (auto& f : found)
      {
        const bool first = p.axis.kind != PairAxis::Kind::FaceOfFirst; // point's rock
        const Vec3 u = vr + A.w.cross(f.point - A.x) - B.w.cross(f.point - B.x);
        const double vn = u.dot(p.axis.normal);
        const TouchFeatures tf(f, p.axis);
        const Mem* old =
          find(p.mem, p.count, taken, int(tf.kind), tf.first, tf.second, f.point, same);
        if (f.distance + dt * std::min(0.0, vn) > s && !(old && old->gap < 0))
          continue;
        if (first)
          row(rows, p.a, p.b, f.point, p.axis.normal, f.distance, dt,
            p.axis.kind == PairAxis::Kind::FaceOfSecond, old, int(tf.kind), tf.first, tf.second, k,
            -1);
        else
          row(rows, p.b, p.a, f.point, -p.axis.normal, f.distance, dt, true, old, int(tf.kind),
            tf.first, tf.second, k, -1);
      }
      handOver(rows, from, p.mem, p.count, taken);
    }
    double t2 = now();
    t.touch += t2 - t1;
    for (int i : who)
    {
      Body& b = bodies[i];
      taken.assign(b.ground.size(), 0);
      const std::size_t from = rows.size();
      for (std::size_t j = 0; j < planes.size(); ++j)
      {
        const Plane& pl = planes[j];
        const double way = b.s + dt * (b.v.norm() + b.w.norm() * b.r);
        if (pl.n.dot(b.x) - pl.d - b.r > way)
          continue;
        const auto& vs = placed_[i].vertices();
        for (std::size_t v = 0; v < vs.size(); ++v)
        {
          const double d = pl.n.dot(vs[v]) - pl.d;
          b.low0 = std::min(b.low0, d);
          const double vn = pl.n.dot(b.v + b.w.cross(vs[v] - b.x));
          if (d + dt * std::min(0.0, vn) > b.s)
            continue;
          const Mem* old = nullptr;
          for (std::size_t k = 0; k < b.ground.size(); ++k)
            if (b.ground[k].f1 == int(v) && b.ground[k].f2 == int(j))
            {
              old = &b.ground[k];
              taken[k] = 1;
            }
          row(rows, i, -1, vs[v], pl.n, d, dt, true, old, 9, int(v), int(j), -1, i);
        }
      }
      if (field.n &&
        b.x.z() - field.highest(b.x) - b.r <= b.s + dt * (b.v.norm() + b.w.norm() * b.r))
      {
        const auto& vs = placed_[i].vertices();
        for (std::size_t v = 0; v < vs.size(); ++v)
        {
          Vec3 n;
          double d;
          const int tri = field.plane(vs[v], n, d);
          const Vec3 u = b.v + b.w.cross(vs[v] - b.x);
          d = n.dot(vs[v]) - d;
          b.low0 = std::min(b.low0, d);
          if (d + dt * std::min(0.0, n.dot(u)) > b.s)
            continue;
          const Mem* old = nullptr;
          for (std::size_t k = 0; k < b.ground.size(); ++k)
            if (b.ground[k].f1 == int(v))
            {
              old = &b.ground[k];
              taken[k] = 1;
            }
          row(rows, i, -1, vs[v], n, d, dt, true, old, 9, int(v), tri, -1, i);
        }
      }
      handOver(rows, from, b.ground, int(b.ground.size()), taken);
    }
    t.rows += now() - t2;
    t2 = now();
    // islands
    parent_.resize(bodies.size());
    for (int i : who)
      parent_[i] = i;
    for (auto& r : rows)
      if (r.b >= 0)
      {
        int x = root(r.a), y = root(r.b);
        parent_[std::max(x, y)] = std::min(x, y);
      }
    std::vector<int> ids; // by root
    std::vector<std::vector<int>> members;
    for (int i : who)
      bodies[i].island = -1;
    for (int i : who)
    {
      const int r = root(i);
      if (bodies[r].island < 0)
      {
        bodies[r].island = int(members.size());
        members.emplace_back();
      }
      bodies[i].island = bodies[r].island;
      bodies[i].place = int(members[bodies[i].island].size());
      members[bodies[i].island].push_back(i);
    }
    std::vector<std::vector<int>> rowsOf(members.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      rowsOf[bodies[rows[k].a].island].push_back(int(k));
    std::vector<std::vector<Row>> solved(members.size());
    std::vector<char> bad(members.size(), 0);
    std::vector<Books> booksOf(members.size());
    t.rest += now() - t2;
    bool anyBad = false;
    t2 = now();
    for (std::size_t m = 0; m < members.size(); ++m)
    {
      std::vector<Row>& rr = solved[m];
      rr.reserve(rowsOf[m].size());
      for (int k : rowsOf[m])
      {
        rr.push_back(rows[k]);
        Row& r = rr.back();
        r.a = bodies[r.a].place;
        r.b = r.b >= 0 ? bodies[r.b].place : -1;
      }
      largest = std::max(largest, int(members[m].size()));
      solve(members[m], rr, dt, booksOf[m]);
    }
    // where all stand now
    t0 = now();
    t.solve += t0 - t2;
    for (int i : who)
    {
      Body& b = bodies[i];
      BlockState st;
      st.position = b.x;
      st.orientation = b.q;
      placed_[i].place(*b.block, st);
      pb_[i].update(placed_[i]);
    }
    t1 = now();
    t.place += t1 - t0;
    const bool may = set.halve && depth < set.depth;
    for (int k : which)
    {
      Pair& p = pairs[k];
      p.fresh = false;
      Body &A = bodies[p.a], &B = bodies[p.b];
      const double nextS = 2 * set.slack * std::max(A.r, B.r) +
        set.slackSpeed * dt * (std::max(A.v.norm(), 1.0) + std::max(B.v.norm(), 1.0));
      const double way = nextS + dt * (A.v - B.v).norm();
      if ((A.x - B.x).norm() - A.r - B.r > way)
        continue;
      p.end =
        findAxis(pb_[p.a], pb_[p.b], p.axis, way + dt * (A.w.norm() * A.r + B.w.norm() * B.r));
      ++axes;
      p.fresh = true;
      const double r = std::min(A.r, B.r);
      if (may && -p.end.distance > set.look * r &&
        p.end.distance < std::min(0.0, p.before) - 0.1 * set.look * r)
      {
        bad[A.island] = bad[B.island] = 1;
        anyBad = true;
        if (depth == 0)
        {
          ++st[0];
          if (!p.touches)
            ++st[1];
          else if (p.axis.kind == p.end.kind && p.axis.first == p.end.first &&
            p.axis.second == p.end.second)
          {
            ++st[2];
          }
          else
            ++st[3];
          const Vec3 vr = A.v0 - B.v0;
          if (vr.norm() * dt > 0.05 * r)
            ++st[4];
          if (dt * (A.w0.norm() * A.r + B.w0.norm() * B.r) > 0.05 * r)
            ++st[5];
          if (p.before < 0)
            ++st[6];
          if (dt * (A.w.norm() * A.r + B.w.norm() * B.r) > 0.05 * r)
            ++st[7];
          if ((A.w - A.w0).norm() * A.r + (B.w - B.w0).norm() * B.r >
            0.5 * (A.w0.norm() * A.r + B.w0.norm() * B.r))
            ++st[8];
        }
      }
    }
    t.axis += now() - t1;
    t1 = now();
    if (may)
      for (int i : who)
      {
        Body& b = bodies[i];
        if (rowsOf[b.island].empty())
          continue;
        double low = 0;
        for (auto& pl : planes)
          if (pl.n.dot(b.x) - pl.d < b.r)
            for (auto& v : placed_[i].vertices())
              low = std::min(low, pl.n.dot(v) - pl.d);
        if (field.n && b.x.z() - field.highest(b.x) - b.r <= 0)
          for (auto& v : placed_[i].vertices())
          {
            Vec3 n;
            double d;
            field.plane(v, n, d);
            low = std::min(low, n.dot(v) - d);
          }
        const double off =
          (b.x - (b.x0 + dt * b.v0 + 0.5 * dt * dt * G)).norm() + b.r * devTurn(b, dt);
        if ((-low > set.look * b.r && low < b.low0 - 0.25 * set.look * b.r) ||
          off > b.s + set.far * b.r)
        {
          if (depth == 0)
            ++st[9];
          bad[b.island] = 1;
          anyBad = true;
        }
      }
    t.rest += now() - t1;
    if (anyBad) // what is near goes with it
    {
      std::vector<char> more = bad;
      for (int k : which)
      {
        const int x = bodies[pairs[k].a].island, y = bodies[pairs[k].b].island;
        if (bad[x] != bad[y])
          more[x] = more[y] = 1;
      }
      bad = more;
    }
    t2 = now();
    for (std::size_t m = 0; m < members.size(); ++m)
    {
      if (bad[m])
      {
        for (int i : members[m])
        {
          Body& b = bodies[i];
          b.x = b.x0;
          b.v = b.v0;
          b.w = b.w0;
          b.L = b.L0;
          b.q = b.q0;
          inertia(b);
          stands_[i] = 0;
        }
        continue;
      }
      books.friction += booksOf[m].friction;
      books.dash += booksOf[m].dash;
      books.yield += booksOf[m].yield;
      books.gained += booksOf[m].gained;
    }
    for (int k : which)
    {
      Pair& p = pairs[k];
      if (!bad[bodies[p.a].island])
        p.count = 0;
      if (!bad[bodies[p.a].island] && !bad[bodies[p.b].island])
      {
        if (p.fresh)
          p.axis = p.end;
      }
      else
        p.fresh = false;
    }
    for (int i : who)
      if (!bad[bodies[i].island])
        bodies[i].ground.clear();
    for (std::size_t m = 0; m < members.size(); ++m)
    {
      if (bad[m])
        continue;
      for (Row& r : solved[m])
      {
        r.mem.gap = r.g;
        r.mem.offset = r.offset;
        r.mem.P = r.P;
        r.mem.Pt = r.Pt;
        r.mem.c = r.c;
        r.mem.p = r.p;
        r.mem.vin = r.vin;
        const Body& A = bodies[members[m][r.a]];
        r.mem.point = A.x + r.l1;
        if (r.pair >= 0)
        {
          Pair& p = pairs[r.pair];
          if (int(p.mem.size()) <= p.count)
            p.mem.resize(p.count + 4);
          p.mem[p.count++] = r.mem;
        }
        else
          bodies[r.body].ground.push_back(r.mem);
      }
    }
    t.rest += now() - t2;
    if (!anyBad)
      return;
    std::vector<int> who2, which2;
    for (int i : who)
      if (bad[bodies[i].island])
        who2.push_back(i);
    for (int k : which)
      if (bad[bodies[pairs[k].a].island] && bad[bodies[pairs[k].b].island])
        which2.push_back(k);
    redone += long(who2.size());
    advance(who2, which2, 0.5 * dt, depth + 1);
    advance(who2, which2, 0.5 * dt, depth + 1);
  }
  static double devTurn(const Body& b, double dt)
  {
    const Quat dq = b.q * b.q0.conjugate();
    Vec3 th = 2.0 * dq.vec() * (dq.w() < 0 ? -1.0 : 1.0);
    return (th - dt * b.w0).norm();
  }
  static void inertia(Body& b)
  {
    if (!b.iso)
    {
      const Mat3 R = b.q.toRotationMatrix();
      b.Iinv = R * b.IbInv * R.transpose();
    }
  }
  /// Free turn over h from angular momentum L, second order. Returns the turn.
  static Vec3 turn(Body& b, const Vec3& L, Vec3& w, double h)
  {
    if (b.iso)
    {
      const Vec3 th = h * w;
      b.q = cayley(th) * b.q;
      return th;
    }
    const Quat half = cayley(0.5 * h * w) * b.q;
    const Mat3 R = half.toRotationMatrix();
    const Vec3 th = h * (R * (b.IbInv * (R.transpose() * L)));
    b.q = (cayley(th) * b.q).normalized();
    inertia(b);
    w = b.Iinv * L;
    return th;
  }

  void solve(const std::vector<int>& who, std::vector<Row>& rows, double dt, Books& bk)
  {
    const Vec3 G(0, 0, -set.g);
    if (rows.empty())
    {
      for (int i : who)
      {
        Body& b = bodies[i];
        b.x += dt * b.v + 0.5 * dt * dt * G;
        b.v += dt * G;
        const int n = b.iso ? 1 : 4;
        for (int k = 0; k < n; ++k)
          turn(b, b.L, b.w, dt / n);
        b.q.normalize();
      }
      return;
    }
    double w2 = 0;
    for (Row& r : rows)
      w2 = std::max(w2, r.p / r.meff);
    int n = set.softSub;
    n = std::max(1, int(std::ceil(set.softSub * std::pow(dt / set.dt, std::log2(1 / set.finer)))));
    const double h = dt / n;
    substeps += n;
    ++islandsSolved;
    rowsTotal += long(rows.size());
    rowSub += long(rows.size()) * n;
    bodySub += long(who.size()) * n;
    solvedBodies += long(who.size());
    thread_local std::vector<SBody> sb;
    sb.resize(who.size());
    for (std::size_t i = 0; i < who.size(); ++i)
    {
      Body& b = bodies[who[i]];
      SBody& s = sb[i];
      s.v = b.v;
      s.w = b.w;
      s.L = b.L;
      s.touched = false;
      s.im = b.im;
      s.iiso = b.iiso;
      s.iso = b.iso;
      s.Iinv = b.Iinv;
      s.of = who[i];
      s.dx.setZero();
      s.dth.setZero();
    }
    std::vector<Hot>& hot = hot_;
    hot.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      Row& r = rows[k];
      Hot& q = hot[k];
      const double scale = r.c > 0 ? h / r.c : 0;
      q.a = r.a;
      q.b = r.b;
      q.n = r.n;
      q.l1 = r.l1;
      q.l20 = r.l20;
      q.a1 = r.a1;
      q.a2 = r.a2;
      q.g0 = r.g0;
      q.meff = r.meff;
      q.mt = r.mt;
      q.mu = r.mu;
      q.e = r.e;
      q.P = r.P * scale;
      q.Pt = r.Pt * scale;
      q.thr = std::max(kRestingSpeed * std::sqrt(std::max(set.g, 1e-3) * r.rsmall), 2 * h * set.g);
      const double om = std::min(std::sqrt(set.penalty / q.meff), 2 * M_PI * set.hertzCap / h),
                   z = set.zetaSoft, s1 = 2 * z + h * om, s2 = h * om * s1, s3 = 1 / (1 + s2);
      q.rate = om / s1;
      q.mass = q.meff * s2 * s3;
      q.soft = s3;
    }
    manifolds_.clear();
    for (int k = 0; k < int(hot.size()); ++k)
    {
      const bool with = k > 0 &&
        ((rows[k].pair >= 0 && rows[k].pair == rows[k - 1].pair) ||
          (rows[k].pair < 0 && rows[k].body == rows[k - 1].body && rows[k - 1].pair < 0));
      if (with)
        manifolds_.back()[1] = k + 1;
      else
        manifolds_.push_back({ k, k + 1 });
    }
    for (int k = 0; k < n; ++k)
      soft(sb, hot, h, bk, G);
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      Row& r = rows[k];
      const Hot& q = hot[k];
      r.P = q.P;
      r.Pt = q.Pt;
      r.c = h;
      r.p = 0;
      r.g = gapOf(q, sb[q.a], q.b >= 0 ? &sb[q.b] : nullptr);
    }
    for (std::size_t i = 0; i < who.size(); ++i)
    {
      Body& b = bodies[who[i]];
      SBody& s = sb[i];
      b.v = s.v;
      b.w = s.w;
      b.L = s.iso ? Vec3(s.w / s.iiso) : s.L;
      b.x = b.x0 + s.dx;
      b.q.normalize();
      inertia(b);
    }
  }
  struct Hot
  {
    int a, b, seen;
    Vec3 n, l1, l20, a1, a2;
    double g0, g, meff, mt, mu, e, P, Q, thr, vpre, rate, mass, soft;
    Vec3 Pt, Qt, upre;
  };
  std::vector<Hot> hot_;
  std::vector<int> struck_;
  std::vector<int> stamp_, moved_, first_, of_;
  std::vector<std::array<int, 2>> manifolds_; // rows of the same two bodies
  /// Rows of a manifold that strike within h; those that do within half as long again share the
  /// impact.
  void strike(std::vector<SBody>& sb, std::vector<Hot>& rows, int m, double h)
  {
    const int from = manifolds_[m][0], to = manifolds_[m][1];
    bool any = false, more = false;
    for (int k = from; k < to; ++k)
    {
      Hot& r = rows[k];
      Vec3 l2;
      r.upre = speed(r, sb[r.a], r.b >= 0 ? &sb[r.b] : nullptr, l2);
      r.vpre = r.upre.dot(r.n);
      if (-r.vpre > r.thr)
      {
        const double g = r.g + h * r.vpre;
        any = any || g < 0;
        more = true;
      }
    }
    if (!any)
      return;
    for (int k = from; more && k < to; ++k)
    {
      Hot& r = rows[k];
      if (-r.vpre > r.thr && r.g + 1.5 * h * r.vpre < 0)
      {
        struck_.push_back(k);
        r.Q = 0;
        r.Qt.setZero();
      }
    }
  }
  void link(std::size_t bodiesHere, const std::vector<Hot>& rows)
  {
    first_.assign(bodiesHere + 2, 0);
    for (auto& m : manifolds_)
    {
      auto& r = rows[m[0]];
      ++first_[r.a + 2];
      if (r.b >= 0)
        ++first_[r.b + 2];
    }
    for (std::size_t i = 2; i < first_.size(); ++i)
      first_[i] += first_[i - 1];
    of_.resize(std::size_t(first_.back()));
    for (std::size_t k = 0; k < manifolds_.size(); ++k)
    {
      auto& r = rows[manifolds_[k][0]];
      of_[first_[r.a + 1]++] = int(k);
      if (r.b >= 0)
        of_[first_[r.b + 1]++] = int(k);
    }
  }

  /// Twice the work of J beside J·u.
  static double push(SBody& A, const Vec3& J, const Vec3& l)
  {
    A.touched = true;
    A.v += A.im * J;
    const Vec3 m = l.cross(J);
    if (A.iso)
    {
      const Vec3 d = A.iiso * m;
      A.w += d;
      return A.im * J.squaredNorm() + m.dot(d);
    }
    const Vec3 d = A.Iinv * m;
    A.L += m;
    A.w += d;
    return A.im * J.squaredNorm() + m.dot(d);
  }
  template <class R>
  static double gapOf(const R& r, const SBody& A, const SBody* B)
  {
    double g = r.g0 + r.n.dot(A.dx) + r.a1.dot(A.dth);
    if (B)
      g -= r.n.dot(B->dx) + r.a2.dot(B->dth);
    return g;
  }
  static Vec3 speed(const Hot& r, const SBody& A, const SBody* B, Vec3& l2)
  {
    Vec3 u = A.v + A.w.cross(r.l1);
    if (B)
    {
      l2 = r.l20 + (A.dx - B->dx);
      u -= B->v + B->w.cross(l2);
    }
    return u;
  }
  static double apply(const Hot& r, SBody& A, SBody* B, const Vec3& l2, const Vec3& J)
  {
    double w = push(A, J, r.l1);
    if (B)
      w += push(*B, -J, l2);
    return 0.5 * w;
  }
  static void clampTo(Vec3& T, double most)
  {
    const double t2 = T.squaredNorm();
    if (t2 > most * most)
      T *= most / std::sqrt(t2);
  }
  void impacts(std::vector<SBody>& sb, std::vector<Hot>& rows, double h, Books& bk)
  {
    // struck_ holds the first generation
    int tick = 0;
    bool linked = false;
    stamp_.assign(sb.size(), -1);
    for (int gen = 0; gen < set.generations && !struck_.empty(); ++gen)
    {
      ++generationsRun;
      const int begun = tick;
      double work = 0;
      moved_.clear();
      for (int pass = 0; pass < set.bouncePasses; ++pass, ++tick)
      {
        bool any = false;
        for (int k : struck_)
        {
          Hot& r = rows[k];
          SBody& A = sb[r.a];
          SBody* B = r.b >= 0 ? &sb[r.b] : nullptr;
          if (pass > 0 && stamp_[r.a] < tick - 1 && (!B || stamp_[r.b] < tick - 1))
            continue;
          ++bounceRows;
          Vec3 l2;
          const Vec3 u = speed(r, A, B, l2);
          const double vn = u.dot(r.n), Q = std::max(0.0, r.Q - r.meff * (vn + r.e * r.vpre));
          const double dQ = Q - r.Q;
          r.Q = Q;
          Vec3 T = r.Qt - r.mt * (u - vn * r.n);
          clampTo(T, r.mu * Q);
          const Vec3 dT = T - r.Qt;
          r.Qt = T;
          const double size = std::abs(dQ) + dT.norm();
          if (size == 0)
            continue;
          const Vec3 J = dQ * r.n + dT;
          const double w = apply(r, A, B, l2, J),
                       f = dT.dot(u) + std::min(w, 0.5 * dT.squaredNorm() / r.mt);
          bk.friction -= f;
          bk.dash -= dQ * vn + w + dT.dot(u) - f;
          work += dQ * vn + dT.dot(u) + w;
          if (size > r.meff * std::max(set.bounceTol * -r.vpre, set.quiet * r.thr))
          {
            if (stamp_[r.a] < begun)
              moved_.push_back(r.a);
            stamp_[r.a] = tick;
            if (B)
            {
              if (stamp_[r.b] < begun)
                moved_.push_back(r.b);
              stamp_[r.b] = tick;
            }
            any = true;
          }
        }
        if (!any)
          break;
      }
      if (work > 0) // no more than was there: all impulses of the generation by one factor
      {
        double b = 0;
        for (int k : struck_)
          b += rows[k].Q * rows[k].vpre + rows[k].Qt.dot(rows[k].upre);
        const double s = std::clamp(-b / (work - b), 0.0, 1.0);
        ++held;
        for (int k : struck_)
        {
          Hot& r = rows[k];
          if (r.Q == 0)
            continue;
          SBody& A = sb[r.a];
          SBody* B = r.b >= 0 ? &sb[r.b] : nullptr;
          Vec3 l2;
          const Vec3 u = speed(r, A, B, l2), J = (s - 1) * (r.Q * r.n + r.Qt);
          bk.dash -= J.dot(u) + apply(r, A, B, l2, J);
        }
      }
      tick += 2;
      struck_.clear();
      if (gen + 1 == set.generations)
        break;
      if (!linked)
      {
        link(sb.size(), rows);
        linked = true;
      }
      for (int i : moved_)
        for (int j = first_[i]; j < first_[i + 1]; ++j)
        {
          Hot& r = rows[manifolds_[of_[j]][0]];
          if (r.seen == gen + 1)
            continue;
          r.seen = gen + 1;
          strike(sb, rows, of_[j], h);
        }
      std::sort(struck_.begin(), struck_.end());
    }
  }
  void soft(std::vector<SBody>& sb, std::vector<Hot>& rows, double h, Books& bk, const Vec3& G)
  {
    struck_.clear();
    for (Hot& r : rows)
    {
      r.g = gapOf(r, sb[r.a], r.b >= 0 ? &sb[r.b] : nullptr);
      r.seen = 0;
    }
    for (std::size_t m = 0; m < manifolds_.size(); ++m)
      strike(sb, rows, int(m), h);
    if (!struck_.empty())
      impacts(sb, rows, h, bk);
    for (SBody& s : sb)
    {
      s.vb = s.v;
      s.v += h * G;
      s.touched = false;
    }
    const double fastest = -10 * set.recover;
    for (Hot& r : rows)
    {
      if (r.P == 0)
      {
        r.Pt.setZero();
        continue;
      }
      SBody& A = sb[r.a];
      SBody* B = r.b >= 0 ? &sb[r.b] : nullptr;
      Vec3 l2;
      const Vec3 u = speed(r, A, B, l2), J = r.P * r.n + r.Pt;
      bk.dash -= J.dot(u) + apply(r, A, B, l2, J);
    }
    for (Hot& r : rows)
    {
      SBody& A = sb[r.a];
      SBody* B = r.b >= 0 ? &sb[r.b] : nullptr;
      Vec3 l2;
      const double vn = speed(r, A, B, l2).dot(r.n);
      double dP = r.g > 0
        ? -r.meff * (vn + r.g / h)
        : -r.mass * (vn + std::max(r.rate * r.g, r.b < 0 ? set.groundFirm * fastest : fastest)) -
          r.soft * r.P;
      const double P = std::max(0.0, r.P + dP);
      dP = P - r.P;
      r.P = P;
      if (dP != 0)
        bk.dash -= dP * vn + apply(r, A, B, l2, dP * r.n);
    }
    for (SBody& s : sb)
    {
      const Vec3 dx = s.touched ? Vec3(h * s.v) : Vec3(h * s.v - 0.5 * h * h * G);
      s.dx += dx;
      // what contacts take is what gravity gave along the way gone, less what the kick did
      if (s.touched)
        bk.dash += G.dot(dx - h * (s.vb + 0.5 * h * G)) / s.im;
      if (s.iso)
      {
        const Vec3 th = h * s.w;
        Body& b = bodies[s.of];
        b.q = cayley(th) * b.q;
        s.dth += th;
      }
      else
      {
        Body& b = bodies[s.of];
        s.dth += turn(b, s.L, s.w, h);
        s.Iinv = b.Iinv;
      }
    }
    for (Hot& r : rows) // relax, friction
    {
      if (r.P == 0)
        continue;
      ++closedSub;
      SBody& A = sb[r.a];
      SBody* B = r.b >= 0 ? &sb[r.b] : nullptr;
      Vec3 l2;
      const Vec3 u = speed(r, A, B, l2);
      const double vn = u.dot(r.n), P = std::max(0.0, r.P - r.meff * vn), dP = P - r.P;
      r.P = P;
      Vec3 T = r.Pt - r.mt * (u - vn * r.n);
      T -= T.dot(r.n) * r.n;
      clampTo(T, r.mu * P);
      const Vec3 dT = T - r.Pt;
      r.Pt = T;
      const double w = apply(r, A, B, l2, dP * r.n + dT),
                   f = dT.dot(u) + std::min(w, 0.5 * dT.squaredNorm() / r.mt);
      bk.friction -= f;
      bk.dash -= dP * vn + w + dT.dot(u) - f;
    }
  }
};
} // namespace spike
