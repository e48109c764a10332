// SPDX-License-Identifier: Apache-2.0
// Functions that the formulas of kernels and weights require of their number type, for eight
// floats. Include after the vector types. No operation is contracted or reordered, so every set of
// instructions gives the same bits.

// Functions that are not inlined, so that each loop gets all registers.
#if defined(__GNUC__)
#define LUMEN_NOINLINE __attribute__((noinline))
#else
#define LUMEN_NOINLINE
#endif

inline float constant(float, double value) {
  return static_cast<float>(value);
}
inline F8 constant(const F8&, double value) {
  return set1(static_cast<float>(value));
}
inline F8 positivePart(F8 v) {
  return max(v, set1(0.0f));
}
inline F8 ifPositive(F8 v, F8 value) {
  return select(less(set1(0.0f), v), value, set1(0.0f));
}

// exp(x) for -87 < x < 88, to a few units in the last place; S. Moshier, Cephes library, 1989.
inline F8 exponential(F8 x) {
  const F8 round = set1(12582912.0f);  // 1.5 * 2^23
  const F8 shifted = x * set1(1.44269504f) + round;
  const F8 n = shifted - round;
  const F8 r = (x - n * set1(0.693359375f)) - n * set1(-2.12194440e-4f);
  F8 p = set1(1.9875691500e-4f);
  p = p * r + set1(1.3981999507e-3f);
  p = p * r + set1(8.3334519073e-3f);
  p = p * r + set1(4.1665795894e-2f);
  p = p * r + set1(1.6666665459e-1f);
  p = p * r + set1(5.0000001201e-1f);
  return (p * (r * r) + (r + set1(1.0f))) * powerOf2(shifted);
}

inline float exponential(float x) {
  float lanes[kLanes];
  store(lanes, exponential(set1(x < -87.0f ? -87.0f : x > 88.0f ? 88.0f : x)));
  return lanes[0];
}

// exp(-u) for u >= 0, and exp(-87) beyond.
inline F8 expOfMinus(F8 u) {
  return exponential(max(set1(0.0f) - u, set1(-87.0f)));
}

// Natural logarithm of x > 0 to a few units in the last place; S. Moshier, Cephes library, 1989.
inline float logarithm(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  int exponent = static_cast<int>(bits >> 23) - 126;
  bits = (bits & 0x007FFFFFU) | 0x3F000000U;
  float m;
  std::memcpy(&m, &bits, sizeof m);
  if (m < 0.70710678f) {
    --exponent;
    m = m + m;
  }
  m -= 1.0f;
  float p = 7.0376836292e-2f;
  for (const float c : {-1.1514610310e-1f, 1.1676998740e-1f, -1.2420140846e-1f, 1.4249322787e-1f,
                        -1.6668057665e-1f, 2.0000714765e-1f, -2.4999993993e-1f, 3.3333331174e-1f})
    p = p * m + c;
  const float e = static_cast<float>(exponent), square = m * m;
  return (m + ((m * square * p + e * -2.12194440e-4f) - 0.5f * square)) + e * 0.693359375f;
}

inline F8 logarithm(F8 x) {
  float lanes[kLanes];
  store(lanes, x);
  for (float& lane : lanes) lane = logarithm(lane);
  return load(lanes);
}

inline F8 naturalLog(F8 x) {
  return logarithm(x);
}
