// SPDX-License-Identifier: Apache-2.0
// Vectors of numbers. Each translation unit of the search includes this file once, and defines
// PHALANX_SEARCH_SET (the namespace), PHALANX_DOUBLES and PHALANX_FLOATS (lanes). Only lane-wise IEEE
// operations are used, so that every width gives the same bits. No other standard header may be included. The
// linker could pick an inline function compiled here for a processor without these instructions.
#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define PHALANX_INLINE inline __attribute__((always_inline))

namespace phalanx::search::PHALANX_SEARCH_SET {

inline constexpr int kDoubles = PHALANX_DOUBLES;
inline constexpr int kFloats = PHALANX_FLOATS;

using Doubles = double __attribute__((vector_size(8 * PHALANX_DOUBLES)));
using DoubleMask = std::int64_t __attribute__((vector_size(8 * PHALANX_DOUBLES)));
using Floats = float __attribute__((vector_size(4 * PHALANX_FLOATS)));
using FloatMask = std::int32_t __attribute__((vector_size(4 * PHALANX_FLOATS)));

PHALANX_INLINE Doubles all(double x) noexcept { return Doubles{} + x; }
PHALANX_INLINE Floats all(float x) noexcept { return Floats{} + x; }

PHALANX_INLINE Doubles load(const double* p) noexcept {
  Doubles v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
PHALANX_INLINE Floats load(const float* p) noexcept {
  Floats v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
PHALANX_INLINE void store(const Doubles& v, double* p) noexcept { __builtin_memcpy(p, &v, sizeof v); }
PHALANX_INLINE void store(const Floats& v, float* p) noexcept { __builtin_memcpy(p, &v, sizeof v); }

PHALANX_INLINE Doubles pick(const DoubleMask& m, const Doubles& a, const Doubles& b) noexcept {
  return m ? a : b;
}
PHALANX_INLINE Doubles least(const Doubles& a, const Doubles& b) noexcept { return a < b ? a : b; }
PHALANX_INLINE Doubles most(const Doubles& a, const Doubles& b) noexcept { return a > b ? a : b; }
PHALANX_INLINE Floats least(const Floats& a, const Floats& b) noexcept { return a < b ? a : b; }
PHALANX_INLINE Floats most(const Floats& a, const Floats& b) noexcept { return a > b ? a : b; }
PHALANX_INLINE Doubles positive(const Doubles& a) noexcept { return most(a, all(0.0)); }
PHALANX_INLINE Doubles clamp01(const Doubles& a) noexcept { return least(most(a, all(0.0)), all(1.0)); }
PHALANX_INLINE Floats magnitude(const Floats& a) noexcept { return most(a, -a); }

/// Returns the lane-wise square root, correctly rounded.
PHALANX_INLINE Doubles square_root(const Doubles& a) noexcept {
#if PHALANX_DOUBLES == 8
  return static_cast<Doubles>(_mm512_maskz_sqrt_pd(0xFF, static_cast<__m512d>(a)));
#elif PHALANX_DOUBLES == 4
  return static_cast<Doubles>(_mm256_sqrt_pd(static_cast<__m256d>(a)));
#elif defined(__SSE2__)
  return static_cast<Doubles>(_mm_sqrt_pd(static_cast<__m128d>(a)));
#else
  Doubles r;
  for (int i = 0; i < kDoubles; ++i) r[i] = __builtin_sqrt(a[i]);
  return r;
#endif
}

/// Returns bit i set if lane i of the mask is set.
PHALANX_INLINE unsigned double_bits(const DoubleMask& m) noexcept {
#if PHALANX_DOUBLES == 8
  return static_cast<unsigned>(_mm512_movepi64_mask(reinterpret_cast<__m512i>(m)));
#elif PHALANX_DOUBLES == 4
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m)));
#else
  unsigned b = 0;
  for (int i = 0; i < kDoubles; ++i) b |= (m[i] != 0 ? 1U : 0U) << i;
  return b;
#endif
}
PHALANX_INLINE unsigned float_bits(const FloatMask& m) noexcept {
#if PHALANX_FLOATS == 8
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(m)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(m)));
#else
  unsigned b = 0;
  for (int i = 0; i < kFloats; ++i) b |= (m[i] != 0 ? 1U : 0U) << i;
  return b;
#endif
}

/// Points or vectors in three dimensions, one a lane.
struct Vectors {
  Doubles x, y, z;
};
PHALANX_INLINE Vectors operator+(const Vectors& a, const Vectors& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
PHALANX_INLINE Vectors operator-(const Vectors& a, const Vectors& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
PHALANX_INLINE Vectors operator*(const Doubles& s, const Vectors& a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
PHALANX_INLINE Doubles dot(const Vectors& a, const Vectors& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
PHALANX_INLINE Vectors cross(const Vectors& a, const Vectors& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
PHALANX_INLINE Vectors pick(const DoubleMask& m, const Vectors& a, const Vectors& b) noexcept {
  return {pick(m, a.x, b.x), pick(m, a.y, b.y), pick(m, a.z, b.z)};
}
PHALANX_INLINE Vectors all(const double (&v)[3]) noexcept { return {all(v[0]), all(v[1]), all(v[2])}; }

}  // namespace phalanx::search::PHALANX_SEARCH_SET
