// SPDX-License-Identifier: Apache-2.0
// Distance and normal from f and its gradient, eight points at a time; see blob_sample in
// blob.h. Include after blend.h.

// Up to eight points between evaluation and answer.
struct Group {
  float field[kLanes][4];  ///< f and grad f
  float at[kLanes][4];     ///< the point relative to its node's centre, and the radius
  float shift[kLanes];
  float wall[kLanes][4];             ///< distance and normal
  float difference[kLanes][kLanes];  ///< of power, in the first block of neighbours, if blended
  unsigned rivals[kLanes];           ///< findRivals(), if blended
  unsigned insideBits;
};

struct alignas(32) Inputs {
  double point[kLanes][4];  ///< the fourth is not used
  std::uint32_t node[kLanes];
};

inline void keep(const Lane& lane, Group& g, std::size_t i) {
  store4(g.field[i], lane.field);
  g.at[i][3] = lane.radius;
  g.shift[i] = lane.shift;
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

// Computes from f, grad f, the point relative to its node and the radius: distance and normal; f
// and grad f without their shift; the bits of the lanes inside.
template <class K>
inline M8 finishLanes(const View& view, F8 field[4], const F8 at[4], F8 shift, F8 wall[4]) {
  const F8 zero = set1(0.0f), one = set1(1.0f);
  const F8 f = field[0], radius = at[3];
  const F8 inverseF = one / f;
  F8 ex = field[1] * inverseF, ey = field[2] * inverseF, ez = field[3] * inverseF;
  if constexpr (kIsShifted<K>) {
    const F8 kept = exponential(max(zero - shift, set1(-87.0f)));
    const F8 scale = select(less(set1(87.0f), shift), zero, kept);
    for (int i = 0; i < 4; ++i) field[i] = field[i] * scale;
  }
  const M8 inside = less(set1(view.level), field[0]);
  F8 length = sqrt((ex * ex + ey * ey) + ez * ez);
  const F8 h = K::level(f, inverseF, shift), slope = K::levelSlope(h, length);
  F8 distance = wallDistance(set1(view.transformedLevel) - h, slope, radius, inside);

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

template <class K>
LUMEN_NOINLINE void finishGroup(const View& view, Group& g) {
  F8 field[4], at[4], wall[4];
  fromRows(g.field, field);
  fromRows(g.at, at);
  g.insideBits = maskBits(finishLanes<K>(view, field, at, load(g.shift), wall));
  if constexpr (kIsShifted<K>) toRows(field, g.field);
  toRows(wall, g.wall);
}
