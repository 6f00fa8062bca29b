// Registers of the crowd's loops (crowdSweep.h): contacts side by side, as many as one holds. No
// function with external linkage may be used here, or the linker could take one of these for all.

#include "solve/island/crowdKernel.h"

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace
{

using rockfall::crowd::kLanes;

/// Numbers of a mover, and contacts side by side: as many as a register holds.
using Four = double __attribute__((vector_size(32), may_alias));
using FourMask = long long __attribute__((vector_size(32)));
#ifdef __AVX512F__
constexpr int kRegister = 8;
#else
constexpr int kRegister = 4;
#endif
using Lanes = double __attribute__((vector_size(8 * kRegister), may_alias));
using Mask = long long __attribute__((vector_size(8 * kRegister)));
static_assert(kLanes % kRegister == 0);

struct Triple
{
  Lanes x, y, z;
};

#define ROCKFALL_INLINE inline __attribute__((always_inline))

ROCKFALL_INLINE Four loadFour(const double* p)
{
  return *reinterpret_cast<const Four*>(p);
}

ROCKFALL_INLINE void store(double* p, Four v)
{
  *reinterpret_cast<Four*>(p) = v;
}

ROCKFALL_INLINE Lanes load(const double* p)
{
  return *reinterpret_cast<const Lanes*>(p);
}

#ifdef __AVX512F__
ROCKFALL_INLINE void store(double* p, Lanes v)
{
  *reinterpret_cast<Lanes*>(p) = v;
}
#endif

/// From lane `at` on.
ROCKFALL_INLINE Triple load3(const double (&p)[3][kLanes], int at)
{
  return { load(p[0] + at), load(p[1] + at), load(p[2] + at) };
}

ROCKFALL_INLINE Lanes all(double v)
{
  return v - Lanes{};
}

/// Rows to columns, or back, in each half of the registers: four numbers of four movers.
ROCKFALL_INLINE void transpose(Lanes (&m)[4])
{
#if defined(__AVX512F__)
  const Lanes even01 = __builtin_shufflevector(m[0], m[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes odd01 = __builtin_shufflevector(m[0], m[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes even23 = __builtin_shufflevector(m[2], m[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes odd23 = __builtin_shufflevector(m[2], m[3], 1, 9, 3, 11, 5, 13, 7, 15);
  m[0] = __builtin_shufflevector(even01, even23, 0, 1, 8, 9, 4, 5, 12, 13);
  m[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 8, 9, 4, 5, 12, 13);
  m[2] = __builtin_shufflevector(even01, even23, 2, 3, 10, 11, 6, 7, 14, 15);
  m[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 10, 11, 6, 7, 14, 15);
#elif defined(__AVX__)
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

/// Four numbers of each of as many movers as there are lanes: `m[k]` has their number k.
ROCKFALL_INLINE void gather(const double* const (&from)[kRegister], Lanes (&m)[4])
{
  for (int i = 0; i < 4; ++i)
  {
#ifdef __AVX512F__
    m[i] =
      __builtin_shufflevector(loadFour(from[i]), loadFour(from[i + 4]), 0, 1, 2, 3, 4, 5, 6, 7);
#else
    m[i] = loadFour(from[i]);
#endif
  }
  transpose(m);
}

ROCKFALL_INLINE void scatter(Lanes (&m)[4], double* const (&to)[kRegister])
{
  transpose(m);
  for (int i = 0; i < 4; ++i)
  {
#ifdef __AVX512F__
    store(to[i], __builtin_shufflevector(m[i], m[i], 0, 1, 2, 3));
    store(to[i + 4], __builtin_shufflevector(m[i], m[i], 4, 5, 6, 7));
#else
    store(to[i], m[i]);
#endif
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

ROCKFALL_INLINE Four absolute4(Four v)
{
  return v < 0.0 ? -v : v;
}

/// The lanes that are set, as bits.
ROCKFALL_INLINE int bits(Mask m)
{
#if defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m));
#elif defined(__AVX__)
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(m));
#else
  return int(-m[0] | -m[1] << 1 | -m[2] << 2 | -m[3] << 3);
#endif
}

ROCKFALL_INLINE Lanes squareRoot(Lanes v)
{
#if defined(__AVX512F__)
  return _mm512_mask_sqrt_pd(v, 0xff, v); // the plain one warns of what it does not use
#elif defined(__AVX__)
  return _mm256_sqrt_pd(v);
#else
  return Lanes{ __builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]),
    __builtin_sqrt(v[3]) };
#endif
}

} // namespace
