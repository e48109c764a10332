// SPDX-License-Identifier: Apache-2.0
// From f and its gradient to distance and normal, eight points at a time; see blob_sample in
// blob.h. Include after path_body.h.

// Up to eight points between evaluation and answer.
struct Group {
  float field[kLanes][4];  ///< f and grad f
  float at[kLanes][4];     ///< the point relative to its node's centre, and the radius
  float shift[kLanes];
  float wall[kLanes][4];  ///< distance and normal
  unsigned insideBits;
};

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

// h, and |grad h| from |grad f| / f.
template <int kernel>
inline void straighten(F8 f, F8 inverseF, F8 relativeGradient, F8 shift, F8& h, F8& slope) {
  if constexpr (kernel == BLOB_CAUCHY) {
    h = sqrt(inverseF);
    slope = set1(0.5f) * h * relativeGradient;
  } else if constexpr (kernel == BLOB_GAUSSIAN) {
    h = shift - logarithm(f);
    slope = relativeGradient;
  } else {
    const F8 root = sqrt(f);
    h = set1(0.0f) - root;
    slope = set1(0.5f) * root * relativeGradient;
  }
}

// With D = h_T - h, g = |grad h| and s = sqrt(D^2 + R^2 g^2), |grad h| / (2 c) - R is, without
// cancellation, K R / (D + s) inside and K / g outside, where K = |D| (g R + s + |D|) / (g R + s).
inline F8 wallDistance(F8 difference, F8 slope, F8 radius, M8 inside) {
  const F8 zero = set1(0.0f), one = set1(1.0f);
  const F8 d = max(difference, zero - difference), gr = slope * radius;
  const F8 s = sqrt(d * d + gr * gr), t = gr + s;
  const F8 numerator = d * (t + d) * select(inside, zero - radius, one);
  const F8 distance = numerator / (t * select(inside, d + s, slope));
  return select(less(zero, d), distance, zero);
}

// From f, grad f, the point relative to its node and the radius: distance and normal; f and grad f
// without their shift; which lanes are inside.
template <int kernel>
inline M8 finishLanes(const View& view, F8 field[4], const F8 at[4], F8 shift, F8 wall[4]) {
  const F8 zero = set1(0.0f), one = set1(1.0f);
  const F8 f = field[0], radius = at[3];
  const F8 inverseF = one / f;
  F8 ex = field[1] * inverseF, ey = field[2] * inverseF, ez = field[3] * inverseF;
  if constexpr (kernel == BLOB_GAUSSIAN) {
    const F8 kept = exponential(max(zero - shift, set1(-87.0f)));
    const F8 scale = select(less(set1(87.0f), shift), zero, kept);
    for (int i = 0; i < 4; ++i) field[i] = field[i] * scale;
  }
  const M8 inside = less(set1(view.level), field[0]);
  F8 length = sqrt((ex * ex + ey * ey) + ez * ez);
  F8 h, slope;
  straighten<kernel>(f, inverseF, length, shift, h, slope);
  F8 distance = wallDistance(set1(view.straightLevel) - h, slope, radius, inside);

  // The wall is no farther than the other side of the node's ball: a bound where grad f is nearly
  // zero outside. Where f vanishes there is only the ball.
  if (maskBits(inside) != (1U << kLanes) - 1U) {
    const F8 toCentre = sqrt((at[0] * at[0] + at[1] * at[1]) + at[2] * at[2]);
    const M8 usable = less(set1(kVanished), f);
    distance = select(inside, distance, min(distance, toCentre + radius));
    distance = select(usable, distance, max(toCentre - radius, zero));
    ex = select(usable, ex, zero - at[0]);
    ey = select(usable, ey, zero - at[1]);
    ez = select(usable, ez, zero - at[2]);
    length = select(usable, length, toCentre);
  }
  const F8 inverse = select(less(zero, length), set1(-1.0f) / length, zero);
  wall[0] = distance;
  wall[1] = ex * inverse;
  wall[2] = ey * inverse;
  wall[3] = ez * inverse;
  return inside;
}

template <int kernel>
LUMEN_NOINLINE void finishGroup(const View& view, Group& g) {
  F8 field[4], at[4], wall[4];
  fromRows(g.field, field);
  fromRows(g.at, at);
  g.insideBits = maskBits(finishLanes<kernel>(view, field, at, load(g.shift), wall));
  if constexpr (kernel == BLOB_GAUSSIAN) toRows(field, g.field);
  toRows(wall, g.wall);
}
