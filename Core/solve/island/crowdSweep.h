// The loops of crowd::kAnywhere, kAvx2 and kAvx512: included by the files that compile it. No
// function with external linkage may be used here, or the linker could take one of these for all.

#include "law/cohesion.h"
#include "solve/island/crowdKernel.h"
#include "solve/island/crowdLanes.h"

namespace
{

using rockfall::crowd::Batch;
using rockfall::crowd::Forces;
using rockfall::crowd::Further;
using rockfall::crowd::Kernel;
using rockfall::crowd::Motion;
using rockfall::crowd::Mover;
using rockfall::crowd::Pass;
using rockfall::crowd::Speculative;
using rockfall::crowd::SpeculativePass;
using rockfall::crowd::Springs;

/// One side of the contacts.
struct Side
{
  double* displacement[kRegister];
  double* turn[kRegister];
  const double* inertia[kRegister];
  const double* others[kRegister]; ///< Off the diagonal of the inertia.
  Lanes displacements[4], turns[4];
};

/// `body`: from the first lane on.
ROCKFALL_INLINE void take(Mover* movers, const int* body, Side& side)
{
  for (int i = 0; i < kRegister; ++i)
  {
    Mover& m = movers[body[i]];
    side.displacement[i] = m.displacement;
    side.turn[i] = m.turn;
    side.inertia[i] = m.inertia;
    side.others[i] = m.inertia + 4;
  }
  gather(side.displacement, side.displacements);
  gather(side.turn, side.turns);
}

/// Adds a force to the displacements of its rocks.
ROCKFALL_INLINE void push(Side& side, const Triple& lever, const Triple& force)
{
  side.displacements[0] += side.displacements[3] * force.x;
  side.displacements[1] += side.displacements[3] * force.y;
  side.displacements[2] += side.displacements[3] * force.z;
  const Triple moment = cross(lever, force);
  Lanes diagonal[4], others[4];
  gather(side.inertia, diagonal);
  gather(side.others, others);
  const Lanes xx = diagonal[0], yy = diagonal[1], zz = diagonal[2], xy = diagonal[3];
  const Lanes xz = others[0], yz = others[1];
  side.turns[0] += xx * moment.x + xy * moment.y + xz * moment.z;
  side.turns[1] += xy * moment.x + yy * moment.y + yz * moment.z;
  side.turns[2] += xz * moment.x + yz * moment.y + zz * moment.z;
  scatter(side.displacements, side.displacement);
  scatter(side.turns, side.turn);
}

/// From lane `at` on. Returns by how much displacements change at each contact, m.
template <bool onSlope>
ROCKFALL_INLINE Lanes relax(const Batch& batch, Forces& forces, const Pass& pass, int at)
{
  Side a, b;
  take(pass.movers, batch.body[0] + at, a);
  const Triple leverA = load3(batch.lever[0], at);
  Triple displacement = cross({ a.turns[0], a.turns[1], a.turns[2] }, leverA);
  displacement.x += a.displacements[0];
  displacement.y += a.displacements[1];
  displacement.z += a.displacements[2];
  Triple leverB = leverA;
  if (!onSlope)
  {
    take(pass.movers, batch.body[1] + at, b);
    leverB = load3(batch.lever[1], at);
    const Triple turned = cross({ b.turns[0], b.turns[1], b.turns[2] }, leverB);
    displacement.x -= b.displacements[0] + turned.x;
    displacement.y -= b.displacements[1] + turned.y;
    displacement.z -= b.displacements[2] + turned.z;
  }
  const Triple n = load3(batch.directions[0], at);
  const Lanes before = load(forces.along[0] + at);
  const Lanes before1 = load(forces.along[1] + at), before2 = load(forces.along[2] + at);
  const Lanes w = load(batch.w + at), friction = load(batch.friction + at),
              cohesion = load(batch.cohesion + at);
  const Lanes coupling1 = load(batch.coupling[0] + at), coupling2 = load(batch.coupling[1] + at);
  const Lanes zero = all(0.0), one = all(1.0);
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
  const Lanes open = load(batch.gap + at) + dot(n, displacement) - (w + tied) * before;
  const Mask closes = open < zero;
  const Lanes stiffness = load(batch.stiffness + at);
  const Lanes normal = closes ? -stiffness * open / (one + stiffness * tied) : zero;
  const Lanes any = normal + absolute(before) + absolute(before1) + absolute(before2);
  if (bits(any > zero) == 0)
  {
    return zero;
  }
  const Lanes more = normal - before;
  // One step towards the locked spring, then back onto the Coulomb cone.
  const Triple u = load3(batch.directions[1], at), v = load3(batch.directions[2], at);
  const Lanes shear = load(batch.shear + at), gain = load(batch.gain + at);
  Lanes s = load(batch.slip[0] + at) + dot(u, displacement) + coupling1 * more;
  Lanes t = load(batch.slip[1] + at) + dot(v, displacement) + coupling2 * more;
  s = before1 - gain * (s + before1 * shear);
  t = before2 - gain * (t + before2 * shear);
  const Lanes holds = normal * rockfall::kCohesionPerForce;
  const Lanes limit = closes ? friction * normal + (holds < cohesion ? holds : cohesion) : zero;
  const Lanes square = s * s + t * t;
  const Mask slides = square > limit * limit;
  const Lanes root = squareRoot(slides ? square : one);
  const Lanes back = slides ? limit / root : one;
  const Mask carries = limit > zero; // else zero without a sign, as where nothing is reckoned
  s = carries ? s * back : zero;
  t = carries ? t * back : zero;
  const Lanes slide1 = s - before1, slide2 = t - before2;
  store(forces.along[0] + at, normal);
  store(forces.along[1] + at, s);
  store(forces.along[2] + at, t);
  const Triple force = { more * n.x + slide1 * u.x + slide2 * v.x,
    more * n.y + slide1 * u.y + slide2 * v.y, more * n.z + slide1 * u.z + slide2 * v.z };
  push(a, leverA, force);
  if (!onSlope)
  {
    push(b, leverB, { -force.x, -force.y, -force.z });
  }
  const Lanes change = w * (absolute(more) + absolute(slide1) + absolute(slide2));
  const int moved = bits(change > pass.quiet);
  for (int i = 0; i < kRegister; ++i)
  {
    int& first = pass.changed[batch.body[0][at + i]];
    int& second = pass.changed[batch.body[1][at + i]];
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
  Lanes most = all(0.0);
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
    for (int lane = 0; lane < kLanes; lane += kRegister)
    {
      const Lanes change = relax<onSlope>(batch, pass.forces[at], pass, lane);
      most = change > most ? change : most;
    }
  }
  double largest = 0.0;
  for (int i = 0; i < kRegister; ++i)
  {
    largest = most[i] > largest ? most[i] : largest;
  }
  return largest;
}

double sweepHere(const Pass& pass)
{
  return pass.slope ? sweepAll<true>(pass) : sweepAll<false>(pass);
}

/// Mobility of one rock along three directions and between them, m/N.
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

ROCKFALL_INLINE void addMobility(
  Mover* movers, const int* body, const Triple& lever, const Triple (&directions)[3], Mobility& sum)
{
  Side side;
  take(movers, body, side);
  Lanes diagonal[4], others[4];
  gather(side.inertia, diagonal);
  gather(side.others, others);
  const Lanes mass = side.displacements[3];
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

void assembleHere(Batch* batches, const Springs* springs, Mover* movers, std::size_t count)
{
  const Lanes zero = all(0.0), one = all(1.0);
  for (std::size_t k = 0; k < count; ++k)
  {
    Batch& batch = batches[k];
    for (int at = 0; at < kLanes; at += kRegister)
    {
      const Triple directions[3] = { load3(batch.directions[0], at), load3(batch.directions[1], at),
        load3(batch.directions[2], at) };
      Mobility m = { zero, zero, zero, zero, zero, zero };
      addMobility(movers, batch.body[0] + at, load3(batch.lever[0], at), directions, m);
      addMobility(movers, batch.body[1] + at, load3(batch.lever[1], at), directions, m);
      const Lanes penalty = load(springs[k].penalty + at), shear = load(springs[k].shear + at);
      store(batch.w + at, m.nn);
      store(batch.coupling[0] + at, m.nu);
      store(batch.coupling[1] + at, m.nv);
      store(batch.stiffness + at, penalty / (one + penalty * m.nn));
      store(batch.shear + at, shear > zero ? one / (shear > zero ? shear : one) : zero);
      const Lanes mobile = (m.uu > m.vv ? m.uu : m.vv) + absolute(m.uv);
      store(batch.gain + at, shear / (one + shear * mobile));
    }
  }
}

/// How the points of contacts on one of their rocks go; from lane `at` on.
ROCKFALL_INLINE Triple displacementOf(
  Mover* movers, const int (&body)[kLanes], const double (&lever)[3][kLanes], int at)
{
  Side side;
  take(movers, body + at, side);
  const Triple turned = cross({ side.turns[0], side.turns[1], side.turns[2] }, load3(lever, at));
  return { side.displacements[0] + turned.x, side.displacements[1] + turned.y,
    side.displacements[2] + turned.z };
}

bool findClosingHere(const SpeculativePass& pass)
{
  bool any = false;
  for (std::size_t k = 0; k < pass.count; ++k)
  {
    const Speculative& of = pass.first[k];
    pass.closes[k] = 0;
    int last = pass.changed[of.body[0][0]];
    for (int i = 0; i < kLanes; ++i)
    {
      const int a = pass.changed[of.body[0][i]], b = pass.changed[of.body[1][i]];
      last = a > last ? a : last;
      last = b > last ? b : last;
    }
    if (last < pass.since)
    {
      continue;
    }
    int closes = 0;
    for (int at = 0; at < kLanes; at += kRegister)
    {
      const Triple a = displacementOf(pass.movers, of.body[0], of.lever[0], at);
      const Triple b = displacementOf(pass.movers, of.body[1], of.lever[1], at);
      const Lanes gap =
        load(of.gap + at) + dot(load3(of.normal, at), { a.x - b.x, a.y - b.y, a.z - b.z });
      closes |= bits(gap < all(0.0)) << at;
    }
    pass.closes[k] = static_cast<unsigned char>(closes);
    any = any || closes != 0;
  }
  return any;
}

double changeHere(const Mover* movers, const Motion* before, int count)
{
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
  {
    const Mover& m = movers[i];
    Four displacement = loadFour(m.displacement) - loadFour(before[i].displacement);
    Four turn = loadFour(m.turn) - loadFour(before[i].turn);
    displacement *= displacement;
    turn *= turn;
    const double mobile = m.inertia[0] + m.inertia[1] + m.inertia[2];
    sum += (displacement[0] + displacement[1] + displacement[2]) / m.displacement[3] +
      3.0 * (turn[0] + turn[1] + turn[2]) / mobile;
  }
  return sum;
}

/// Four numbers go on; by how much.
ROCKFALL_INLINE Four go(const Further& further, double* now, double* before, double* along)
{
  const Four reached = loadFour(now), went = loadFour(along);
  const Four step = reached - loadFour(before), more = further.share * went;
  store(now, reached + more);
  store(before, reached + more);
  const Four none = { 0.0, 0.0, 0.0, 0.0 };
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
      for (int at = 0; at < kLanes; at += 4)
      {
        go(further, now[k].along[i] + at, before[k].along[i] + at, along[k].along[i] + at);
      }
    }
  }
}

void goMoversHere(const Further& further, Mover* now, Motion* before, Motion* along, int* changed,
  std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k)
  {
    // Numbers that are no displacement do not change.
    const Four displacement =
      go(further, now[k].displacement, before[k].displacement, along[k].displacement);
    const Four turn = go(further, now[k].turn, before[k].turn, along[k].turn);
    const FourMask moved =
      (absolute4(displacement) > further.quiet) | (absolute4(turn) > further.quiet);
    if ((moved[0] | moved[1] | moved[2] | moved[3]) != 0)
    {
      changed[k] = further.number;
    }
  }
}

constexpr Kernel kernelHere = { sweepHere, assembleHere, findClosingHere, changeHere, goForcesHere,
  goMoversHere };

} // namespace
