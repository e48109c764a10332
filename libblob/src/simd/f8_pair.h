// SPDX-License-Identifier: Apache-2.0
// Eight lanes as two of the compiler's vectors of four: SSE2, NEON, WebAssembly SIMD, or whatever
// the build's target has. Include inside a namespace.

typedef float F4 __attribute__((vector_size(16)));
typedef std::int32_t I4 __attribute__((vector_size(16)));

struct F8 {
  F4 lo, hi;
};
struct M8 {
  I4 lo, hi;
};

inline F4 set4(float x) {
  return F4{x, x, x, x};
}
inline F8 set1(float x) {
  return {set4(x), set4(x)};
}
inline F8 load(const float* p) {
  F8 r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void store(float* p, F8 a) {
  std::memcpy(p, &a, sizeof a);
}
inline F8 operator+(F8 a, F8 b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
inline F8 operator-(F8 a, F8 b) {
  return {a.lo - b.lo, a.hi - b.hi};
}
inline F8 operator*(F8 a, F8 b) {
  return {a.lo * b.lo, a.hi * b.hi};
}
inline F8 operator/(F8 a, F8 b) {
  return {a.lo / b.lo, a.hi / b.hi};
}
inline M8 less(F8 a, F8 b) {
  return {a.lo < b.lo, a.hi < b.hi};
}
inline F4 select4(I4 m, F4 a, F4 b) {
  return (F4)((m & (I4)a) | (~m & (I4)b));
}
inline F8 select(M8 m, F8 a, F8 b) {
  return {select4(m.lo, a.lo, b.lo), select4(m.hi, a.hi, b.hi)};
}
#if defined(__SSE2__)
inline unsigned maskBits(M8 m) {
  return static_cast<unsigned>(_mm_movemask_ps((F4)m.lo) | _mm_movemask_ps((F4)m.hi) << 4);
}
inline F4 sqrt4(F4 a) {
  return _mm_sqrt_ps(a);
}
#else
inline unsigned maskBits(M8 m) {
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i)
    bits |= (m.lo[i] != 0 ? 1U : 0U) << i | (m.hi[i] != 0 ? 1U : 0U) << (i + 4);
  return bits;
}
inline F4 sqrt4(F4 a) {
#if defined(__ARM_NEON) && defined(__aarch64__)
  return (F4)vsqrtq_f32((float32x4_t)a);
#elif defined(__wasm_simd128__)
  return (F4)wasm_f32x4_sqrt((v128_t)a);
#else
  return F4{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]),
            __builtin_sqrtf(a[3])};
#endif
}
#endif
/// The lesser of a and b; b where a lane is NaN.
inline F8 min(F8 a, F8 b) {
  return select(less(a, b), a, b);
}
inline F8 max(F8 a, F8 b) {
  return select(less(b, a), a, b);
}
inline F8 sqrt(F8 a) {
  return {sqrt4(a.lo), sqrt4(a.hi)};
}
/// 2^n from n + 1.5 * 2^23.
inline F8 powerOf2(F8 shifted) {
  typedef std::uint32_t U4 __attribute__((vector_size(16)));
  return {(F4)(((U4)shifted.lo + 127U) << 23), (F4)(((U4)shifted.hi + 127U) << 23)};
}
inline float sum4(F4 a) {
  return (a[0] + a[2]) + (a[1] + a[3]);
}
inline float multiplyLanes(F8 a) {
  return ((a.lo[0] * a.lo[2]) * (a.lo[1] * a.lo[3])) * ((a.hi[0] * a.hi[2]) * (a.hi[1] * a.hi[3]));
}
inline float sumLanes(F8 a) {
  return sum4(a.lo) + sum4(a.hi);
}
inline float leastLane(F8 a) {
  const F4 b = select4(a.lo < a.hi, a.lo, a.hi);
  const float x = b[0] < b[1] ? b[0] : b[1], y = b[2] < b[3] ? b[2] : b[3];
  return x < y ? x : y;
}
#if defined(__SSE2__)
inline F4 sums4(F4 a, F4 b, F4 c, F4 d) {
  const F4 ab = (F4)_mm_unpacklo_ps(a, b) + (F4)_mm_unpackhi_ps(a, b);  // a0+a2 b0+b2 a1+a3 b1+b3
  const F4 cd = (F4)_mm_unpacklo_ps(c, d) + (F4)_mm_unpackhi_ps(c, d);
  return (F4)_mm_movelh_ps(ab, cd) + (F4)_mm_movehl_ps(cd, ab);
}
#else
inline F4 sums4(F4 a, F4 b, F4 c, F4 d) {
  return F4{sum4(a), sum4(b), sum4(c), sum4(d)};
}
#endif
/// The sums of a, b, c and d.
inline F4 sums(F8 a, F8 b, F8 c, F8 d) {
  return sums4(a.lo, b.lo, c.lo, d.lo) + sums4(a.hi, b.hi, c.hi, d.hi);
}
inline F4 load4(const float* p) {
  F4 r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void store4(float* p, F4 a) {
  std::memcpy(p, &a, sizeof a);
}
inline float firstLane(F4 a) {
  return a[0];
}
/// Eight rows of four numbers as four columns, and back.
inline void fromRows(const float (*rows)[4], F8 columns[4]) {
  for (int c = 0; c < 4; ++c) {
    columns[c].lo = F4{rows[0][c], rows[1][c], rows[2][c], rows[3][c]};
    columns[c].hi = F4{rows[4][c], rows[5][c], rows[6][c], rows[7][c]};
  }
}
/// The row of the first lanes.
inline F4 firstLanes(const F8 columns[4]) {
  return F4{columns[0].lo[0], columns[1].lo[0], columns[2].lo[0], columns[3].lo[0]};
}
inline void toRows(const F8 columns[4], float (*rows)[4]) {
  for (int c = 0; c < 4; ++c)
    for (int i = 0; i < 4; ++i) {
      rows[i][c] = columns[c].lo[i];
      rows[i + 4][c] = columns[c].hi[i];
    }
}
/// Four doubles.
struct D4 {
  double v[4];
};
inline D4 load4(const double* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
/// Loads three doubles; the fourth is zero.
inline D4 load3(const double* p) {
  return {{p[0], p[1], p[2], 0.0}};
}
/// Three doubles; the fourth is zero.
inline D4 makePoint(double x, double y, double z) {
  return {{x, y, z, 0.0}};
}
/// a - b as floats.
inline F4 subtractToFloat(const D4& a, const D4& b) {
  return F4{static_cast<float>(a.v[0] - b.v[0]), static_cast<float>(a.v[1] - b.v[1]),
            static_cast<float>(a.v[2] - b.v[2]), static_cast<float>(a.v[3] - b.v[3])};
}
/// Copy of one of the four numbers in all lanes.
template <int lane>
inline F8 splat(F4 a) {
  return set1(a[lane]);
}
/// A row of four numbers.
inline F4 makeRow(float a, float b, float c, float d) {
  return F4{a, b, c, d};
}
/// Copy of a with another first number.
inline F4 withFirst(float first, F4 a) {
  return select4(I4{-1, 0, 0, 0}, set4(first), a);
}
/// Whether -limit <= a <= limit for the first three numbers; false if one is NaN.
inline bool isWithin(F4 a, float limit) {
  const I4 within = (a <= set4(limit)) & (a >= set4(-limit));
  return (within[0] & within[1] & within[2]) != 0;
}
inline void storeAsDoubles(double* p, F4 a) {
  for (int i = 0; i < 4; ++i) p[i] = static_cast<double>(a[i]);
}
