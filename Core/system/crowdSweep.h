// The loops of crowd::kAnywhere and kAvx2: included by the two files that compile it. No
// function with external linkage may be used here, or the linker could take the AVX2 one for all.

#include "solver/cohesion.h"
#include "system/crowdKernel.h"

namespace
{

using rockfall::crowd::Batch;
using rockfall::crowd::Forces;
using rockfall::crowd::Further;
using rockfall::crowd::Kernel;
using rockfall::crowd::kLanes;
using rockfall::crowd::Mover;
using rockfall::crowd::Pass;
using rockfall::crowd::Springs;
using rockfall::crowd::Watch;
using rockfall::crowd::Watched;
using rockfall::crowd::Way;

using Lanes = double __attribute__((vector_size(32), may_alias));
using Mask = long long __attribute__((vector_size(32)));

struct Triple
{
  Lanes x, y, z;
};

#define ROCKFALL_INLINE inline __attribute__((always_inline))

ROCKFALL_INLINE Lanes load(const double* p)
{
  return *reinterpret_cast<const Lanes*>(p);
}

ROCKFALL_INLINE void store(double* p, Lanes v)
{
  *reinterpret_cast<Lanes*>(p) = v;
}

ROCKFALL_INLINE Triple load3(const double (&p)[3][kLanes])
{
  return { load(p[0]), load(p[1]), load(p[2]) };
}

/// Rows to columns: four numbers of each of four movers.
ROCKFALL_INLINE void transpose(Lanes (&m)[4])
{
#ifdef __AVX__
  const Lanes even01 = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);
  const Lanes odd01 = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
  const Lanes even23 = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
  const Lanes odd23 = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
  m[0] = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
  m[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
  m[2] = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
  m[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 6, 7);
#else
  const Lanes a = m[0], b = m[1], c = m[2], d = m[3];
  m[0] = Lanes{ a[0], b[0], c[0], d[0] };
  m[1] = Lanes{ a[1], b[1], c[1], d[1] };
  m[2] = Lanes{ a[2], b[2], c[2], d[2] };
  m[3] = Lanes{ a[3], b[3], c[3], d[3] };
#endif
}

ROCKFALL_INLINE void scatter(Lanes (&m)[4], double* (&to)[4])
{
  transpose(m);
  for (int i = 0; i < 4; ++i)
  {
    store(to[i], m[i]);
  }
}

ROCKFALL_INLINE Triple cross(const Triple& a, const Triple& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

ROCKFALL_INLINE Lanes dot(const Triple& a, const Triple& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

ROCKFALL_INLINE Lanes absolute(Lanes v)
{
  return v < 0.0 ? -v : v;
}

/// Which lanes are set, as bits.
ROCKFALL_INLINE int bits(Mask m)
{
#ifdef __AVX__
  return __builtin_ia32_movmskpd256(reinterpret_cast<Lanes>(m));
#else
  return int(-m[0] | -m[1] << 1 | -m[2] << 2 | -m[3] << 3);
#endif
}

ROCKFALL_INLINE Lanes squareRoot(Lanes v)
{
#ifdef __AVX__
  return __builtin_ia32_sqrtpd256(v);
#else
  return Lanes{ __builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]),
    __builtin_sqrt(v[3]) };
#endif
}

/// One side of four contacts.
struct Side
{
  double* way[4];
  double* turn[4];
  const double* inertia[4];
  Lanes ways[4], turns[4];
};

ROCKFALL_INLINE void take(Mover* movers, const int (&body)[kLanes], Side& side)
{
  for (int i = 0; i < kLanes; ++i)
  {
    Mover& m = movers[body[i]];
    side.way[i] = m.way;
    side.turn[i] = m.turn;
    side.inertia[i] = m.inertia;
    side.ways[i] = load(m.way);
    side.turns[i] = load(m.turn);
  }
  transpose(side.ways);
  transpose(side.turns);
}

/// What a force does to its rocks.
ROCKFALL_INLINE void push(Side& side, const Triple& lever, const Triple& force)
{
  side.ways[0] += side.ways[3] * force.x;
  side.ways[1] += side.ways[3] * force.y;
  side.ways[2] += side.ways[3] * force.z;
  const Triple moment = cross(lever, force);
  Lanes diagonal[4], others[4];
  for (int i = 0; i < kLanes; ++i)
  {
    diagonal[i] = load(side.inertia[i]);
    others[i] = load(side.inertia[i] + 4);
  }
  transpose(diagonal);
  transpose(others);
  const Lanes xx = diagonal[0], yy = diagonal[1], zz = diagonal[2], xy = diagonal[3];
  const Lanes xz = others[0], yz = others[1];
  side.turns[0] += xx * moment.x + xy * moment.y + xz * moment.z;
  side.turns[1] += xy * moment.x + yy * moment.y + yz * moment.z;
  side.turns[2] += xz * moment.x + yz * moment.y + zz * moment.z;
  scatter(side.ways, side.way);
  scatter(side.turns, side.turn);
}

/// Returns by how much displacements change at each contact, m.
template <bool onSlope>
ROCKFALL_INLINE Lanes relax(const Batch& batch, Forces& forces, const Pass& pass)
{
  Side a, b;
  take(pass.movers, batch.body[0], a);
  const Triple leverA = load3(batch.lever[0]);
  Triple way = cross({ a.turns[0], a.turns[1], a.turns[2] }, leverA);
  way.x += a.ways[0];
  way.y += a.ways[1];
  way.z += a.ways[2];
  Triple leverB = leverA;
  if (!onSlope)
  {
    take(pass.movers, batch.body[1], b);
    leverB = load3(batch.lever[1]);
    const Triple turned = cross({ b.turns[0], b.turns[1], b.turns[2] }, leverB);
    way.x -= b.ways[0] + turned.x;
    way.y -= b.ways[1] + turned.y;
    way.z -= b.ways[2] + turned.z;
  }
  const Triple n = load3(batch.directions[0]);
  const Lanes before = load(forces.along[0]);
  const Lanes before1 = load(forces.along[1]), before2 = load(forces.along[2]);
  const Lanes w = load(batch.w), friction = load(batch.friction), cohesion = load(batch.cohesion);
  const Lanes coupling1 = load(batch.coupling[0]), coupling2 = load(batch.coupling[1]);
  const Lanes zero = { 0.0, 0.0, 0.0, 0.0 }, one = { 1.0, 1.0, 1.0, 1.0 };
  // Where it slides friction grows with the normal force, and may work against it under a long
  // lever: taken for fixed, both would drive each other up from visit to visit. What is solved for
  // is the same.
  const Lanes pressed = before > zero ? before : zero; // between sweeps it may be less
  const Lanes coheres = pressed * rockfall::kCohesionPerForce;
  const Lanes held = friction * pressed + (coheres < cohesion ? coheres : cohesion);
  const Lanes across = friction * (coupling1 * before1 + coupling2 * before2);
  const Mask slid = before1 * before1 + before2 * before2 > 0.999 * held * held;
  const Mask against = slid & (across > zero) & (held > zero);
  const Lanes tied = against ? across / (against ? held : one) : zero;
  // The gap that the others leave, and the spring that closes it.
  const Lanes open = load(batch.gap) + dot(n, way) - (w + tied) * before;
  const Mask closes = open < zero;
  const Lanes stiffness = load(batch.stiffness);
  const Lanes normal = closes ? -stiffness * open / (one + stiffness * tied) : zero;
  const Lanes any = normal + absolute(before) + absolute(before1) + absolute(before2);
  if (bits(any > zero) == 0)
  {
    return zero;
  }
  const Lanes more = normal - before;
  // One step towards the locked spring, then back onto the Coulomb cone.
  const Triple u = load3(batch.directions[1]), v = load3(batch.directions[2]);
  const Lanes shear = load(batch.shear), gain = load(batch.gain);
  Lanes s = load(batch.slip[0]) + dot(u, way) + coupling1 * more;
  Lanes t = load(batch.slip[1]) + dot(v, way) + coupling2 * more;
  s = before1 - gain * (s + before1 * shear);
  t = before2 - gain * (t + before2 * shear);
  const Lanes holds = normal * rockfall::kCohesionPerForce;
  const Lanes limit = closes ? friction * normal + (holds < cohesion ? holds : cohesion) : zero;
  const Lanes square = s * s + t * t;
  const Mask slides = square > limit * limit;
  const Lanes root = squareRoot(slides ? square : one);
  const Lanes back = slides ? limit / root : one;
  s *= back;
  t *= back;
  const Lanes slide1 = s - before1, slide2 = t - before2;
  store(forces.along[0], normal);
  store(forces.along[1], s);
  store(forces.along[2], t);
  const Triple force = { more * n.x + slide1 * u.x + slide2 * v.x,
    more * n.y + slide1 * u.y + slide2 * v.y, more * n.z + slide1 * u.z + slide2 * v.z };
  push(a, leverA, force);
  if (!onSlope)
  {
    push(b, leverB, { -force.x, -force.y, -force.z });
  }
  const Lanes change = w * (absolute(more) + absolute(slide1) + absolute(slide2));
  const int moved = bits(change > pass.quiet);
  for (int i = 0; i < kLanes; ++i)
  {
    int &first = pass.changed[batch.body[0][i]], &second = pass.changed[batch.body[1][i]];
    const bool moves = (moved >> i & 1) != 0;
    first = moves ? pass.number : first;
    if (!onSlope)
    {
      second = moves ? pass.number : second;
    }
  }
  return change > pass.quiet ? change : zero;
}

template <bool onSlope>
ROCKFALL_INLINE double sweepAll(const Pass& pass)
{
  Lanes most = { 0.0, 0.0, 0.0, 0.0 };
  for (int k = 0; k < pass.count; ++k)
  {
    const int at = pass.backwards ? pass.count - 1 - k : k;
    const Batch& batch = pass.first[at];
    // Where nothing has changed since the last visit there is nothing to do.
    int last = pass.changed[batch.body[0][0]];
    for (int i = 0; i < kLanes; ++i)
    {
      const int a = pass.changed[batch.body[0][i]];
      const int c = onSlope ? a : pass.changed[batch.body[1][i]];
      last = a > last ? a : last;
      last = c > last ? c : last;
    }
    if (last < pass.number - 1)
    {
      continue;
    }
    const Lanes change = relax<onSlope>(batch, pass.forces[at], pass);
    most = change > most ? change : most;
  }
  const double low = most[0] > most[1] ? most[0] : most[1];
  const double high = most[2] > most[3] ? most[2] : most[3];
  return low > high ? low : high;
}

double sweepHere(const Pass& pass)
{
  return pass.slope ? sweepAll<true>(pass) : sweepAll<false>(pass);
}

/// What forces along three directions do along them and along each other, by way of one rock.
struct Mobility
{
  Lanes nn, nu, nv, uu, vv, uv;
};

/// h² I⁻¹ of a rock times a vector.
ROCKFALL_INLINE Triple turned(const Lanes (&inertia)[6], const Triple& v)
{
  return { inertia[0] * v.x + inertia[3] * v.y + inertia[4] * v.z,
    inertia[3] * v.x + inertia[1] * v.y + inertia[5] * v.z,
    inertia[4] * v.x + inertia[5] * v.y + inertia[2] * v.z };
}

ROCKFALL_INLINE void addMobility(const Mover* movers, const int (&body)[kLanes],
  const Triple& lever, const Triple (&directions)[3], Mobility& sum)
{
  Lanes ways[4], diagonal[4], others[4];
  for (int i = 0; i < kLanes; ++i)
  {
    const Mover& m = movers[body[i]];
    ways[i] = load(m.way);
    diagonal[i] = load(m.inertia);
    others[i] = load(m.inertia + 4);
  }
  transpose(ways);
  transpose(diagonal);
  transpose(others);
  const Lanes mass = ways[3];
  const Lanes inertia[6] = { diagonal[0], diagonal[1], diagonal[2], diagonal[3], others[0],
    others[1] };
  const Triple jn = cross(lever, directions[0]), ju = cross(lever, directions[1]);
  const Triple jv = cross(lever, directions[2]);
  const Triple in = turned(inertia, jn), iv = turned(inertia, jv);
  sum.nn += mass * dot(directions[0], directions[0]) + dot(jn, in);
  sum.nu += mass * dot(directions[0], directions[1]) + dot(ju, in);
  sum.nv += mass * dot(directions[0], directions[2]) + dot(jv, in);
  sum.uu += mass + dot(ju, turned(inertia, ju));
  sum.vv += mass + dot(jv, iv);
  sum.uv += dot(ju, iv);
}

void assembleHere(Batch* batches, const Springs* springs, const Mover* movers, std::size_t count)
{
  const Lanes zero = { 0.0, 0.0, 0.0, 0.0 }, one = { 1.0, 1.0, 1.0, 1.0 };
  for (std::size_t k = 0; k < count; ++k)
  {
    Batch& batch = batches[k];
    const Triple directions[3] = { load3(batch.directions[0]), load3(batch.directions[1]),
      load3(batch.directions[2]) };
    Mobility m = { zero, zero, zero, zero, zero, zero };
    addMobility(movers, batch.body[0], load3(batch.lever[0]), directions, m);
    addMobility(movers, batch.body[1], load3(batch.lever[1]), directions, m);
    const Lanes penalty = load(springs[k].penalty), shear = load(springs[k].shear);
    store(batch.w, m.nn);
    store(batch.coupling[0], m.nu);
    store(batch.coupling[1], m.nv);
    store(batch.stiffness, penalty / (one + penalty * m.nn));
    store(batch.shear, shear > zero ? one / (shear > zero ? shear : one) : zero);
    const Lanes mobile = (m.uu > m.vv ? m.uu : m.vv) + absolute(m.uv);
    store(batch.gain, shear / (one + shear * mobile));
  }
}

/// How the points of four contacts on one of their rocks go.
ROCKFALL_INLINE Triple wayOf(
  const Mover* movers, const int (&body)[kLanes], const double (&lever)[3][kLanes])
{
  Lanes ways[4], turns[4];
  for (int i = 0; i < kLanes; ++i)
  {
    const Mover& m = movers[body[i]];
    ways[i] = load(m.way);
    turns[i] = load(m.turn);
  }
  transpose(ways);
  transpose(turns);
  const Triple turned = cross({ turns[0], turns[1], turns[2] }, load3(lever));
  return { ways[0] + turned.x, ways[1] + turned.y, ways[2] + turned.z };
}

bool watchHere(const Watch& watch)
{
  bool any = false;
  for (std::size_t k = 0; k < watch.count; ++k)
  {
    const Watched& four = watch.first[k];
    watch.closes[k] = 0;
    int last = watch.changed[four.body[0][0]];
    for (int i = 0; i < kLanes; ++i)
    {
      const int a = watch.changed[four.body[0][i]], b = watch.changed[four.body[1][i]];
      last = a > last ? a : last;
      last = b > last ? b : last;
    }
    if (last < watch.since)
    {
      continue;
    }
    const Triple a = wayOf(watch.movers, four.body[0], four.lever[0]);
    const Triple b = wayOf(watch.movers, four.body[1], four.lever[1]);
    const Lanes gap = load(four.gap) + dot(load3(four.normal), { a.x - b.x, a.y - b.y, a.z - b.z });
    watch.closes[k] = static_cast<unsigned char>(bits(gap < 0.0));
    any = any || watch.closes[k] != 0;
  }
  return any;
}

double changeHere(const Mover* movers, const Way* before, int count)
{
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
  {
    const Mover& m = movers[i];
    Lanes way = load(m.way) - load(before[i].way), turn = load(m.turn) - load(before[i].turn);
    way *= way;
    turn *= turn;
    const double mobile = m.inertia[0] + m.inertia[1] + m.inertia[2];
    sum += (way[0] + way[1] + way[2]) / m.way[3] + 3.0 * (turn[0] + turn[1] + turn[2]) / mobile;
  }
  return sum;
}

/// Four numbers go on; by how much.
ROCKFALL_INLINE Lanes go(const Further& further, double* now, double* before, double* along)
{
  const Lanes reached = load(now), went = load(along);
  const Lanes step = reached - load(before), more = further.share * went;
  store(now, reached + more);
  store(before, reached + more);
  const Lanes none = { 0.0, 0.0, 0.0, 0.0 };
  store(along, further.anew ? none : more + step);
  return more;
}

void goForcesHere(
  const Further& further, Forces* now, Forces* before, Forces* along, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      go(further, now[k].along[i], before[k].along[i], along[k].along[i]);
    }
  }
}

void goMoversHere(
  const Further& further, Mover* now, Way* before, Way* along, int* changed, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k)
  {
    // What is no displacement does not change.
    const Lanes way = go(further, now[k].way, before[k].way, along[k].way);
    const Lanes turn = go(further, now[k].turn, before[k].turn, along[k].turn);
    const Mask moved = (absolute(way) > further.quiet) | (absolute(turn) > further.quiet);
    if (bits(moved) != 0)
    {
      changed[k] = further.number;
    }
  }
}

constexpr Kernel kernelHere = { sweepHere, assembleHere, watchHere, changeHere, goForcesHere,
  goMoversHere };

} // namespace
