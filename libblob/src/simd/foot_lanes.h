// SPDX-License-Identifier: Apache-2.0
// Steps of the search for the nearest point of the wall, eight searches at a time. Include after the
// vector types.
//
// A search stands at a foot of the wall, with the normal and the shape operator S there. With d the
// distance of the query point along the normal and t its part along the wall, the nearest point is
// (I + d S)^-1 t away, to second order.

// Three numbers of eight searches.
struct V8 {
  F8 x, y, z;
};
inline V8 operator+(const V8& a, const V8& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline V8 operator-(const V8& a, const V8& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline V8 operator*(F8 s, const V8& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline F8 dot(const V8& a, const V8& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline V8 select(M8 m, const V8& a, const V8& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
inline F8 absolute(F8 a) {
  return max(a, set1(0.0f) - a);
}
inline M8 both(M8 a, M8 b) {
  const F8 zero = set1(0.0f);
  return less(zero, select(a, select(b, set1(1.0f), zero), zero));
}

constexpr float kOffWall = 0.1f;       // share of the radius: go to the wall first
constexpr float kLongestStep = 0.5f;   // share of the radius
constexpr float kFlat = 0.02f;         // least eigenvalue that a step is divided by
constexpr float kCurved = 0.2f;        // least eigenvalue of a step by elimination
constexpr float kDoubted = 0.2f;       // eigenvalue that the wall, not one model, may have
constexpr float kLeaveMaximum = 0.1f;  // share of the radius: step off a farthest point
constexpr float kSlow = 0.6f;          // of the step before: its shape of the wall misleads
constexpr float kMostSlow = 1.0f;      // steps; then the shape is found anew
constexpr float kLeastShare = 0.1f;    // of a step
constexpr float kShorten = 0.4f;       // of a step after which the wall is farther
constexpr float kMisjudged = 1.0f;     // of (off / R)^2: error of a distance this far off the wall
constexpr float kUsualTolerance = 1e-5f;  // share of the radius
constexpr float kNoLength = 1e-6f;        // share of the radius
constexpr float kNotReached = 3e38f;

// Numbers of the searches of a batch. Lengths are in mm, places relative to the search's origin.
struct Searches {
  enum Row : std::size_t {
    Place = 0,     // where f is evaluated next
    Query = 3,     // the query point
    Foot = 6,      // of the best place so far, and the normal there
    Normal = 9,    //
    Shape = 12,    // S as xx, yy, zz, xy, xz, yz
    Step = 18,     // along the wall from the foot
    Sag = 21,      // how far the wall bends away from the tangent there
    Length = 22,   // of the step
    Share = 23,    // of the step that is taken
    Reached = 24,  // distance of the foot from the query point, with its error
    Off = 25,      // distance of the place from its foot
    Radius = 26,   // of the node
    State = 27,    // of the shape
    Slow = 28,     // slow steps since the shape was found
    Rounds = 29,   // evaluations
    kRows = 30
  };
  // States of a shape: to be found; found at the foot; bent by the turns of later normals.
  static constexpr float kUnknown = 0, kFresh = 1, kBent = 2;

  float row[kRows][kMostRefined];
  float wall[4][kMostRefined];  // distance and normal at the place
  float value[kMostRefined];    // f there

  [[nodiscard]] F8 get(std::size_t r, std::size_t first) const { return load(&row[r][first]); }
  void set(std::size_t r, std::size_t first, F8 v) { store(&row[r][first], v); }
  [[nodiscard]] V8 vector(std::size_t r, std::size_t first) const {
    return {get(r, first), get(r + 1, first), get(r + 2, first)};
  }
  void setVector(std::size_t r, std::size_t first, const V8& v) {
    set(r, first, v.x);
    set(r + 1, first, v.y);
    set(r + 2, first, v.z);
  }
  // Writes a number of a search that begins. The first of eight writes those of all, which a vector
  // load waits less for.
  void begin(std::size_t r, std::size_t i, float v) {
    if (i % kLanes == 0)
      set(r, i, set1(v));
    else
      row[r][i] = v;
  }
  void move(std::size_t from, std::size_t to) {
    for (auto& r : row) r[to] = r[from];
  }
  void moveAnswer(std::size_t from, std::size_t to) {
    for (auto& r : wall) r[to] = r[from];
    value[to] = value[from];
  }
};

struct Shape8 {
  F8 xx, yy, zz, xy, xz, yz;
};

inline V8 operator*(const Shape8& s, const V8& a) {
  return {(s.xx * a.x + s.xy * a.y) + s.xz * a.z, (s.xy * a.x + s.yy * a.y) + s.yz * a.z,
          (s.xz * a.x + s.yz * a.y) + s.zz * a.z};
}

inline Shape8 shapeOf(const Searches& s, std::size_t first) {
  constexpr auto kShape = Searches::Shape;
  return {s.get(kShape, first),     s.get(kShape + 1, first), s.get(kShape + 2, first),
          s.get(kShape + 3, first), s.get(kShape + 4, first), s.get(kShape + 5, first)};
}

// Corrects a shape by what a move along the wall has turned the normal, where it is bent: the least
// change of a symmetric matrix that explains the turn (M. Powell, A new algorithm for unconstrained
// optimization, 1970).
inline void bend(Shape8& s, M8 isBent, const V8& move, const V8& turn) {
  const F8 zero = set1(0.0f), square = dot(move, move), inverse = set1(1.0f) / square;
  const V8 missing = turn - s * move;
  const F8 half = (set1(0.5f) * inverse) * dot(missing, move);
  const M8 isMoved = both(isBent, less(zero, square));
  const V8 r = select(isMoved, inverse * (missing - half * move), V8{zero, zero, zero});
  const F8 two = set1(2.0f);
  s.xx = s.xx + two * (r.x * move.x);
  s.yy = s.yy + two * (r.y * move.y);
  s.zz = s.zz + two * (r.z * move.z);
  s.xy = s.xy + (r.x * move.y + move.x * r.y);
  s.xz = s.xz + (r.x * move.z + move.x * r.z);
  s.yz = s.yz + (r.y * move.z + move.y * r.z);
}

// The wall in the plane of two unit vectors along it: S, I + d S, and the query point.
struct Plane8 {
  V8 e1, e2;
  F8 s11, s12, s22, a, b, c, t1, t2;
};

// T. Duff et al., Building an orthonormal basis, revisited, 2017.
inline Plane8 planeAt(const V8& n, const Shape8& shape, const V8& toQuery) {
  const F8 zero = set1(0.0f), one = set1(1.0f);
  const F8 sign = select(less(n.z, zero), zero - one, one);
  const F8 u = (zero - one) / (sign + n.z), v = (n.x * n.y) * u;
  Plane8 p;
  p.e1 = {one + sign * ((n.x * n.x) * u), sign * v, zero - sign * n.x};
  p.e2 = {v, sign + (n.y * n.y) * u, zero - n.y};
  const V8 h1 = shape * p.e1, h2 = shape * p.e2;
  p.s11 = dot(p.e1, h1);
  p.s12 = dot(p.e1, h2);
  p.s22 = dot(p.e2, h2);
  const F8 distance = dot(toQuery, n);
  p.a = one + distance * p.s11;
  p.b = distance * p.s12;
  p.c = one + distance * p.s22;
  p.t1 = dot(p.e1, toQuery);
  p.t2 = dot(p.e2, toQuery);
  return p;
}

inline F8 alongAxis(F8 part, F8 eigenvalue, F8 radius) {
  const F8 plain = part / max(absolute(eigenvalue), set1(kFlat));
  const M8 isFarthest =
      both(less(eigenvalue, set1(-kFlat)), less(absolute(part), set1(kUsualTolerance) * radius));
  return select(isFarthest, set1(kLeaveMaximum) * radius, plain);
}

// A step that is downhill wherever the foot is: directions in which it is a farthest point are
// followed away from there.
LUMEN_NOINLINE void stepDownhill(const Plane8& p, F8 radius, F8& x, F8& y) {
  const F8 zero = set1(0.0f), half = set1(0.5f), one = set1(1.0f);
  const F8 mean = half * (p.a + p.c), apart = half * (p.a - p.c);
  const F8 root = sqrt(apart * apart + p.b * p.b);
  // cosine and sine of half the angle whose cosine is apart / root and whose sine has b's sign
  const F8 share = select(less(zero, root), apart / root, one);
  const F8 cosine = sqrt(max(half * (one + share), zero));
  const F8 size = sqrt(max(half * (one - share), zero));
  const F8 sine = select(less(p.b, zero), zero - size, size);
  const F8 m1 = alongAxis(cosine * p.t1 + sine * p.t2, mean + root, radius);
  const F8 m2 = alongAxis(cosine * p.t2 - sine * p.t1, mean - root, radius);
  x = cosine * m1 - sine * m2;
  y = sine * m1 + cosine * m2;
}

// Solves for the step, by elimination well within the valley of a nearest point.
inline void solve(const Plane8& p, F8 radius, F8& x, F8& y) {
  const F8 curved = set1(kCurved), above = p.a - curved;
  const M8 isValley = both(less(set1(0.0f), above), less(p.b * p.b, above * (p.c - curved)));
  const F8 inverse = set1(1.0f) / (p.a * p.c - p.b * p.b);
  x = inverse * (p.c * p.t1 - p.b * p.t2);
  y = inverse * (p.a * p.t2 - p.b * p.t1);
  if (maskBits(isValley) == (1U << kLanes) - 1U) return;
  F8 downX, downY;
  stepDownhill(p, radius, downX, downY);
  x = select(isValley, x, downX);
  y = select(isValley, y, downY);
}

// Bits of searches: the nearest point is found; the last step has been shortened to nothing; no
// more evaluations are made.
struct StepBits {
  unsigned found, stuck, ended;
};
// Where a descent ends: the least share of the radius that a step must give, also the square of the
// share of it that a place may be off the wall; and the number of evaluations.
struct Limits {
  float leastGain, mostRounds;
};

// Goes on after a share of the last step, since that has led away from the query point.
inline M8 goBack(Searches& s, std::size_t first, M8 isLonger) {
  const F8 share = s.get(Searches::Share, first) * set1(kShorten);
  const V8 place =
      (s.vector(Searches::Foot, first) + share * s.vector(Searches::Step, first)) -
      ((share * share) * s.get(Searches::Sag, first)) * s.vector(Searches::Normal, first);
  s.setVector(Searches::Place, first, select(isLonger, place, s.vector(Searches::Place, first)));
  s.set(Searches::Share, first, select(isLonger, share, s.get(Searches::Share, first)));
  return both(isLonger, less(share, set1(kLeastShare)));
}

// Makes a step of each of eight searches, whose places have been evaluated and whose shapes are
// known where the places are accepted.
LUMEN_NOINLINE StepBits stepLanes(Searches& s, std::size_t first, M8 isLonger, Limits limits) {
  const F8 zero = set1(0.0f), one = set1(1.0f);
  const V8 place = s.vector(Searches::Place, first);
  const V8 toQuery = s.vector(Searches::Query, first) - place;
  const V8 normal{load(&s.wall[1][first]), load(&s.wall[2][first]), load(&s.wall[3][first])};
  const F8 off = load(&s.wall[0][first]), radius = s.get(Searches::Radius, first);
  const V8 foot = place - off * normal, way = s.vector(Searches::Query, first) - foot;
  const F8 length = sqrt(dot(way, way)), offSquare = off * off;

  Shape8 shape = shapeOf(s, first);
  const F8 state = s.get(Searches::State, first);
  const M8 isBent = less(set1(Searches::kFresh), state);
  const V8 none{zero, zero, zero};
  bend(shape, isBent, select(isBent, foot - s.vector(Searches::Foot, first), none),
       select(isBent, normal - s.vector(Searches::Normal, first), none));

  const Plane8 p = planeAt(normal, shape, toQuery);
  F8 x, y;
  solve(p, radius, x, y);
  // The place is on a wall parallel to that at its foot, whose radii of curvature are greater.
  F8 alongX = x - off * (p.s11 * x + p.s12 * y), alongY = y - off * (p.s12 * x + p.s22 * y);
  const F8 whole = sqrt(alongX * alongX + alongY * alongY);
  const F8 cut = min((set1(kLongestStep) * radius) / whole, one), stepLength = cut * whole;
  x = cut * x;
  y = cut * y;
  alongX = cut * alongX;
  alongY = cut * alongY;
  const F8 turnX = p.s11 * x + p.s12 * y, turnY = p.s12 * x + p.s22 * y;
  const F8 sag = set1(0.5f) * (alongX * turnX + alongY * turnY);
  const V8 step = alongX * p.e1 + alongY * p.e2;

  // Half the decrease of the squared distance that the step could give.
  const F8 gain =
      max(set1(0.5f) * (x * p.t1 + y * p.t2), set1(0.5f / kDoubted) * (p.t1 * p.t1 + p.t2 * p.t2));
  const F8 least = set1(limits.leastGain) * radius;
  const M8 isSlight = both(less(offSquare, least * radius),
                           less(gain, least * (length + set1(kNoLength) * radius)));
  // a step off a farthest point has no gain, but length
  const M8 isFound = both(isSlight, less(stepLength, set1(0.9f * kLeaveMaximum) * radius));

  const M8 isStuck = goBack(s, first, isLonger);
  const M8 isOff = less(set1(kOffWall) * radius, absolute(off));
  const F8 before = s.get(Searches::Length, first), share = s.get(Searches::Share, first);
  const M8 isSlow =
      both(both(isBent, less(set1(kSlow) * before, stepLength)), less(set1(0.99f), share));
  const F8 slow = s.get(Searches::Slow, first) + select(isSlow, one, zero);
  const M8 isMisled = less(set1(kMostSlow), slow);
  const auto put = [&](std::size_t row, F8 accepted) {
    s.set(row, first, select(isLonger, s.get(row, first), accepted));
  };
  const auto putVector = [&](std::size_t row, const V8& accepted) {
    s.setVector(row, first, select(isLonger, s.vector(row, first), accepted));
  };
  const F8 shapes[6] = {shape.xx, shape.yy, shape.zz, shape.xy, shape.xz, shape.yz};
  for (std::size_t i = 0; i < 6; ++i) put(Searches::Shape + i, shapes[i]);
  putVector(Searches::Place, select(isOff, foot, (foot + step) - sag * normal));
  putVector(Searches::Foot, foot);
  putVector(Searches::Normal, normal);
  putVector(Searches::Step, step);
  put(Searches::Sag, sag);
  put(Searches::Length, stepLength);
  put(Searches::Share, one);
  put(Searches::Off, off);
  put(Searches::Slow, select(isMisled, zero, slow));
  put(Searches::State,
      select(isMisled, set1(Searches::kUnknown), select(isOff, state, set1(Searches::kBent))));
  put(Searches::Reached,
      select(isOff, set1(kNotReached), length + (set1(kMisjudged) * offSquare) / radius));
  const F8 rounds = s.get(Searches::Rounds, first) + one;
  s.set(Searches::Rounds, first, rounds);
  const M8 goesOn =
      both(less(rounds, set1(limits.mostRounds)), less(set1(kVanished), load(&s.value[first])));
  return {maskBits(isFound) & ~maskBits(isLonger), maskBits(isStuck), ~maskBits(goesOn)};
}
