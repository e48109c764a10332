// SPDX-License-Identifier: Apache-2.0
// Eight lanes as plain loops: the reference. Include inside a namespace.

struct F8 {
  float v[8];
};
struct M8 {
  bool v[8];
};

#define LUMEN_EACH for (int i = 0; i < 8; ++i)

inline F8 set1(float x) {
  F8 r;
  LUMEN_EACH r.v[i] = x;
  return r;
}
inline F8 load(const float* p) {
  F8 r;
  LUMEN_EACH r.v[i] = p[i];
  return r;
}
inline void store(float* p, F8 a) {
  LUMEN_EACH p[i] = a.v[i];
}
inline F8 operator+(F8 a, F8 b) {
  LUMEN_EACH a.v[i] += b.v[i];
  return a;
}
inline F8 operator-(F8 a, F8 b) {
  LUMEN_EACH a.v[i] -= b.v[i];
  return a;
}
inline F8 operator*(F8 a, F8 b) {
  LUMEN_EACH a.v[i] *= b.v[i];
  return a;
}
inline F8 operator/(F8 a, F8 b) {
  LUMEN_EACH a.v[i] /= b.v[i];
  return a;
}
inline M8 less(F8 a, F8 b) {
  M8 r;
  LUMEN_EACH r.v[i] = a.v[i] < b.v[i];
  return r;
}
inline F8 select(M8 m, F8 a, F8 b) {
  LUMEN_EACH a.v[i] = m.v[i] ? a.v[i] : b.v[i];
  return a;
}
inline unsigned maskBits(M8 m) {
  unsigned bits = 0;
  LUMEN_EACH bits |= (m.v[i] ? 1U : 0U) << i;
  return bits;
}
/// The lesser of a and b; b where a lane is NaN.
inline F8 min(F8 a, F8 b) {
  return select(less(a, b), a, b);
}
inline F8 max(F8 a, F8 b) {
  return select(less(b, a), a, b);
}
inline F8 sqrt(F8 a) {
  LUMEN_EACH a.v[i] = __builtin_sqrtf(a.v[i]);
  return a;
}
/// 2^n from n + 1.5 * 2^23.
inline F8 powerOf2(F8 shifted) {
  LUMEN_EACH {
    std::uint32_t bits;
    std::memcpy(&bits, &shifted.v[i], sizeof bits);
    bits = (bits + 127U) << 23;
    std::memcpy(&shifted.v[i], &bits, sizeof bits);
  }
  return shifted;
}
// The order in which every back end adds or multiplies its lanes.
inline float sumLanes(F8 a) {
  return ((a.v[0] + a.v[2]) + (a.v[1] + a.v[3])) + ((a.v[4] + a.v[6]) + (a.v[5] + a.v[7]));
}
inline float multiplyLanes(F8 a) {
  return ((a.v[0] * a.v[2]) * (a.v[1] * a.v[3])) * ((a.v[4] * a.v[6]) * (a.v[5] * a.v[7]));
}
inline float leastLane(F8 a) {
  float least = a.v[0];
  LUMEN_EACH least = a.v[i] < least ? a.v[i] : least;
  return least;
}

struct F4 {
  float v[4];
};
inline F4 set4(float x) {
  return {{x, x, x, x}};
}
inline F4 load4(const float* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
inline void store4(float* p, F4 a) {
  for (int i = 0; i < 4; ++i) p[i] = a.v[i];
}
inline float firstLane(F4 a) {
  return a.v[0];
}
inline F4 operator+(F4 a, F4 b) {
  for (int i = 0; i < 4; ++i) a.v[i] += b.v[i];
  return a;
}
inline F4 operator-(F4 a, F4 b) {
  for (int i = 0; i < 4; ++i) a.v[i] -= b.v[i];
  return a;
}
inline F4 operator*(F4 a, F4 b) {
  for (int i = 0; i < 4; ++i) a.v[i] *= b.v[i];
  return a;
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
  F4 r;
  for (int i = 0; i < 4; ++i) r.v[i] = static_cast<float>(a.v[i] - b.v[i]);
  return r;
}
/// Copy of one of the four numbers in all lanes.
template <int lane>
inline F8 splat(F4 a) {
  return set1(a.v[lane]);
}
/// A row of four numbers.
inline F4 makeRow(float a, float b, float c, float d) {
  return {{a, b, c, d}};
}
/// Copy of a with another first number.
inline F4 withFirst(float first, F4 a) {
  return {{first, a.v[1], a.v[2], a.v[3]}};
}
/// Whether -limit <= a <= limit for the first three numbers; false if one is NaN.
inline bool isWithin(F4 a, float limit) {
  bool within = true;
  for (int i = 0; i < 3; ++i) within = within && a.v[i] <= limit && a.v[i] >= -limit;
  return within;
}
inline void storeAsDoubles(double* p, F4 a) {
  for (int i = 0; i < 4; ++i) p[i] = static_cast<double>(a.v[i]);
}
/// The sums of a, b, c and d.
inline F4 sums(F8 a, F8 b, F8 c, F8 d) {
  return {{sumLanes(a), sumLanes(b), sumLanes(c), sumLanes(d)}};
}
/// Eight rows of four numbers as four columns, and back.
inline void fromRows(const float (*rows)[4], F8 columns[4]) {
  for (int c = 0; c < 4; ++c) LUMEN_EACH columns[c].v[i] = rows[i][c];
}
/// The row of the first lanes.
inline F4 firstLanes(const F8 columns[4]) {
  return {{columns[0].v[0], columns[1].v[0], columns[2].v[0], columns[3].v[0]}};
}
inline void toRows(const F8 columns[4], float (*rows)[4]) {
  for (int c = 0; c < 4; ++c) LUMEN_EACH rows[i][c] = columns[c].v[i];
}

#undef LUMEN_EACH
