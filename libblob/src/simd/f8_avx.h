// SPDX-License-Identifier: Apache-2.0
// Eight lanes in one register of AVX2 or AVX-512VL. Include inside a namespace whose functions have
// that target.

struct F8 {
  __m256 v;
};
struct M8 {
  __m256 v;
};

inline F8 set1(float x) {
  return {_mm256_set1_ps(x)};
}
inline F8 load(const float* p) {
  return {_mm256_loadu_ps(p)};
}
inline void store(float* p, F8 a) {
  _mm256_storeu_ps(p, a.v);
}
inline F8 operator+(F8 a, F8 b) {
  return {_mm256_add_ps(a.v, b.v)};
}
inline F8 operator-(F8 a, F8 b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
inline F8 operator*(F8 a, F8 b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
inline F8 operator/(F8 a, F8 b) {
  return {_mm256_div_ps(a.v, b.v)};
}
inline M8 less(F8 a, F8 b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
inline F8 select(M8 m, F8 a, F8 b) {
  return {_mm256_blendv_ps(b.v, a.v, m.v)};
}
inline unsigned maskBits(M8 m) {
  return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}
/// The lesser of a and b; b where a lane is NaN.
inline F8 min(F8 a, F8 b) {
  return {_mm256_min_ps(a.v, b.v)};
}
inline F8 max(F8 a, F8 b) {
  return {_mm256_max_ps(a.v, b.v)};
}
inline F8 sqrt(F8 a) {
  return {_mm256_sqrt_ps(a.v)};
}
/// 2^n from n + 1.5 * 2^23.
inline F8 powerOf2(F8 shifted) {
  const __m256i n = _mm256_add_epi32(_mm256_castps_si256(shifted.v), _mm256_set1_epi32(127));
  return {_mm256_castsi256_ps(_mm256_slli_epi32(n, 23))};
}
inline float multiplyLanes(F8 a) {
  const __m256 b = _mm256_mul_ps(a.v, _mm256_permute_ps(a.v, 0x0E));  // lanes 0*2, 1*3 of each half
  const __m256 c = _mm256_mul_ps(b, _mm256_permute_ps(b, 0x01));
  return _mm_cvtss_f32(_mm_mul_ss(_mm256_castps256_ps128(c), _mm256_extractf128_ps(c, 1)));
}
inline float sumLanes(F8 a) {
  const __m256 b = _mm256_add_ps(a.v, _mm256_permute_ps(a.v, 0x0E));
  const __m256 c = _mm256_add_ps(b, _mm256_permute_ps(b, 0x01));
  return _mm_cvtss_f32(_mm_add_ss(_mm256_castps256_ps128(c), _mm256_extractf128_ps(c, 1)));
}
inline float leastLane(F8 a) {
  __m128 b = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  b = _mm_min_ps(b, _mm_movehl_ps(b, b));
  return _mm_cvtss_f32(_mm_min_ss(b, _mm_shuffle_ps(b, b, 1)));
}

struct F4 {
  __m128 v;
};
inline F4 set4(float x) {
  return {_mm_set1_ps(x)};
}
inline F4 load4(const float* p) {
  return {_mm_loadu_ps(p)};
}
inline void store4(float* p, F4 a) {
  _mm_storeu_ps(p, a.v);
}
inline float firstLane(F4 a) {
  return _mm_cvtss_f32(a.v);
}
inline F4 operator+(F4 a, F4 b) {
  return {_mm_add_ps(a.v, b.v)};
}
inline F4 operator-(F4 a, F4 b) {
  return {_mm_sub_ps(a.v, b.v)};
}
inline F4 operator*(F4 a, F4 b) {
  return {_mm_mul_ps(a.v, b.v)};
}
/// Four doubles.
struct D4 {
  __m256d v;
};
inline D4 load4(const double* p) {
  return {_mm256_loadu_pd(p)};
}
/// Loads three doubles; the fourth is zero.
inline D4 load3(const double* p) {
  return {_mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_load_sd(p + 2), 1)};
}
/// Three doubles; the fourth is zero.
inline D4 makePoint(double x, double y, double z) {
  return {_mm256_setr_pd(x, y, z, 0.0)};
}
/// a - b as floats.
inline F4 subtractToFloat(D4 a, D4 b) {
  return {_mm256_cvtpd_ps(_mm256_sub_pd(a.v, b.v))};
}
/// Copy of one of the four numbers in all lanes.
template <int lane>
inline F8 splat(F4 a) {
  return {_mm256_permutevar8x32_ps(_mm256_castps128_ps256(a.v), _mm256_set1_epi32(lane))};
}
/// A row of four numbers.
inline F4 makeRow(float a, float b, float c, float d) {
  return {_mm_setr_ps(a, b, c, d)};
}
/// Copy of a with another first number.
inline F4 withFirst(float first, F4 a) {
  return {_mm_blend_ps(a.v, _mm_set_ss(first), 1)};
}
/// Whether -limit <= a <= limit for the first three numbers; false if one is NaN.
inline bool isWithin(F4 a, float limit) {
  const __m128 size = _mm_andnot_ps(_mm_set1_ps(-0.0f), a.v);
  return (_mm_movemask_ps(_mm_cmp_ps(size, _mm_set1_ps(limit), _CMP_LE_OQ)) & 7) == 7;
}
inline void storeAsDoubles(double* p, F4 a) {
  _mm256_storeu_pd(p, _mm256_cvtps_pd(a.v));
}
/// The sums of a, b, c and d.
inline F4 sums(F8 a, F8 b, F8 c, F8 d) {
  // a0+a2 b0+b2 a1+a3 b1+b3 in each half
  const __m256 ab = _mm256_add_ps(_mm256_unpacklo_ps(a.v, b.v), _mm256_unpackhi_ps(a.v, b.v));
  const __m256 cd = _mm256_add_ps(_mm256_unpacklo_ps(c.v, d.v), _mm256_unpackhi_ps(c.v, d.v));
  const __m256 r = _mm256_add_ps(_mm256_shuffle_ps(ab, cd, 0x44), _mm256_shuffle_ps(ab, cd, 0xEE));
  return {_mm_add_ps(_mm256_castps256_ps128(r), _mm256_extractf128_ps(r, 1))};
}
/// Transposes four rows of four in each half.
inline void turn(F8 m[4]) {
  const __m256 a = _mm256_unpacklo_ps(m[0].v, m[1].v), b = _mm256_unpackhi_ps(m[0].v, m[1].v);
  const __m256 c = _mm256_unpacklo_ps(m[2].v, m[3].v), d = _mm256_unpackhi_ps(m[2].v, m[3].v);
  m[0].v = _mm256_shuffle_ps(a, c, 0x44);
  m[1].v = _mm256_shuffle_ps(a, c, 0xEE);
  m[2].v = _mm256_shuffle_ps(b, d, 0x44);
  m[3].v = _mm256_shuffle_ps(b, d, 0xEE);
}
/// Eight rows of four numbers as four columns, and back.
inline void fromRows(const float (*rows)[4], F8 columns[4]) {
  for (int i = 0; i < 4; ++i)
    columns[i].v = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[i])),
                                        _mm_loadu_ps(rows[i + 4]), 1);
  turn(columns);
}
/// The row of the first lanes.
inline F4 firstLanes(const F8 columns[4]) {
  const __m128 a =
      _mm_unpacklo_ps(_mm256_castps256_ps128(columns[0].v), _mm256_castps256_ps128(columns[1].v));
  const __m128 b =
      _mm_unpacklo_ps(_mm256_castps256_ps128(columns[2].v), _mm256_castps256_ps128(columns[3].v));
  return {_mm_movelh_ps(a, b)};
}
inline void toRows(const F8 columns[4], float (*rows)[4]) {
  F8 m[4] = {columns[0], columns[1], columns[2], columns[3]};
  turn(m);
  for (int i = 0; i < 4; ++i) {
    _mm_storeu_ps(rows[i], _mm256_castps256_ps128(m[i].v));
    _mm_storeu_ps(rows[i + 4], _mm256_extractf128_ps(m[i].v, 1));
  }
}
