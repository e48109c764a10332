// SPDX-License-Identifier: Apache-2.0
// The search for the nearest points of the wall, for a batch of points. Include after batch.h and
// foot_lanes.h.

constexpr Limits kLimits{1e-6f, 16};        // a share of the radius, and evaluations about the wall
constexpr std::uint32_t kMostRestarts = 1;  // of a stuck search
constexpr float kDeep = 0.5f;               // share of the radius: depth about an axis
constexpr float kAcross = 0.7f;             // share of the radius: step off an axis
constexpr std::size_t kSides = 4;           // steps that are tried
constexpr float kRestartOff = 0.01f;        // share of the radius: such a place is not at the wall

template <class K>
inline void findShape(const blob_model& model, const double* point, std::uint32_t node,
                      Shape& shape) {
  const View view(model);
  const FieldNode& field = view.fieldNode(node);
  const BlobBlock* blocks = view.blocks + field.block;
  const Splats at(relative(view.nodes[node], load3(point)) + load4(field.place));
  const F8 zero = set1(0.0f);
  const float shift =
      kIsShifted<K> && field.blockCount > 0 ? leastExponent(blocks, field.blockCount, at) : 0.0f;
  F8 slope = zero, x = zero, y = zero, z = zero;
  F8 xx = zero, yy = zero, zz = zero, xy = zero, xz = zero, yz = zero;
  for (std::uint32_t b = 0; b < field.blockCount; ++b) {
    Offsets d = computeOffsets(blocks[b], at);
    if constexpr (kIsShifted<K>) d.u = max(d.u - set1(shift), zero);
    const F8 a = load(blocks[b].a), w = load(blocks[b].w), first = K::term(d.u, a, w).slope;
    const F8 second = (set1(4.0f) * w) * (a * a) * K::second(d.u);
    const F8 sx = second * d.x, sy = second * d.y, sz = second * d.z;
    slope = slope + first;
    x = x + first * d.x;
    y = y + first * d.y;
    z = z + first * d.z;
    xx = xx + sx * d.x;
    yy = yy + sy * d.y;
    zz = zz + sz * d.z;
    xy = xy + sx * d.y;
    xz = xz + sx * d.z;
    yz = yz + sy * d.z;
  }
  float sum[12];
  store4(sum, sums(x, y, z, slope));
  store4(sum + 4, sums(xx, yy, zz, xy));
  store4(sum + 8, sums(xz, yz, zero, zero));
  for (int i = 0; i < 3; ++i) {
    shape.gradient[i] = sum[i];
    shape.hessian[i] = sum[4 + i] + sum[3];
    shape.hessian[3 + i] = sum[7 + i];
  }
}

// A place at which a search begins.
struct Start {
  std::size_t id;
  double place[3];
  std::uint32_t node;
};

// The searches of a batch that are not finished, in the first lanes.
struct FootBatch {
  Searches lanes;
  std::size_t count = 0;
  std::uint32_t id[kMostRefined];  // of the query point
  std::uint32_t node[kMostRefined];
  std::uint32_t restarts[kMostRefined];
  bool wantsHessian[kMostRefined];  // the shape is to be that of the blended field
  double origin[kMostRefined][3];   // by id, mm

  void leave(std::size_t i) {
    if (i == --count) return;
    lanes.move(count, i);
    id[i] = id[count];
    node[i] = node[count];
    restarts[i] = restarts[count];
    wantsHessian[i] = wantsHessian[count];
  }
};

// Begins a search at a place about the wall, which is the origin.
inline void enter(const View& view, const FootJob& job, const Start& start, FootBatch& b) {
  const std::size_t i = b.count++, id = start.id;
  const float radius = view.nodes[job.samples[id].node].radius();
  for (std::size_t k = 0; k < 3; ++k) {
    b.origin[id][k] = start.place[k];
    b.lanes.begin(Searches::Place + k, i, 0);
    b.lanes.begin(Searches::Query + k, i, static_cast<float>(job.points[id][k] - start.place[k]));
  }
  b.lanes.begin(Searches::State, i, Searches::kUnknown);
  b.lanes.begin(Searches::Slow, i, 0);
  b.lanes.begin(Searches::Rounds, i, 0);
  b.lanes.begin(Searches::Share, i, 1);
  b.lanes.begin(Searches::Reached, i, kNotReached);
  b.lanes.begin(Searches::Radius, i, radius);
  b.id[i] = static_cast<std::uint32_t>(id);
  b.node[i] = start.node;
  b.restarts[i] = 0;
  b.wantsHessian[i] = false;
}

inline void placeOf(const FootBatch& b, std::size_t i, std::size_t row, double* at) {
  for (std::size_t k = 0; k < 3; ++k)
    at[k] = b.origin[b.id[i]][k] + static_cast<double>(b.lanes.row[row + k][i]);
}

// Evaluates f at points; leaves f and distance and normal in columns. A point out of range gets
// f = 0.
template <class K>
inline void evaluatePoints(const View& view, Parts parts, std::size_t count, Inputs& in,
                           float* value, F8 wall[4]) {
  Group g;
  const unsigned outOfRange = placeTogether(view, parts, count, in, g);
  evaluateGroup<K>(view, count, outOfRange, in, g);
  if (parts.blends) blendGroup<K>(view, count, outOfRange, in, g);
  F8 field[4], at[4];
  fromRows(g.field, field);
  fromRows(g.at, at);
  finishLanes<K>(view, field, at, load(g.shift), wall);
  store(value, field[0]);
  for (std::size_t i = 0; i < count; ++i)
    if ((outOfRange >> i & 1U) != 0) value[i] = 0;
}

// evaluatePoints() for one point, with the same bits.
template <class K>
inline void evaluateAlone(const View& view, Parts parts, const double* at, std::uint32_t& node,
                          float* value, F8 wall[4]) {
  PointAnswer answer;
  const bool inRange = evaluatePoint<K>(view, parts, makePoint(at[0], at[1], at[2]), node, answer);
  if (inRange)
    for (std::size_t k = 0; k < 4; ++k) wall[k] = answer.wall[k];
  else
    for (std::size_t k = 0; k < 4; ++k) wall[k] = set1(0.0f);
  store(value, inRange ? answer.field[0] : set1(0.0f));
}

template <class K>
LUMEN_NOINLINE void evaluateLanes(const View& view, Parts parts, std::size_t first, FootBatch& b) {
  const std::size_t left = b.count - first, count = left < kLanes ? left : std::size_t{kLanes};
  F8 wall[4];
  if (count == 1) {
    double at[3];
    placeOf(b, first, Searches::Place, at);
    evaluateAlone<K>(view, parts, at, b.node[first], &b.lanes.value[first], wall);
  } else {
    Inputs in;
    for (std::size_t i = 0; i < count; ++i) {
      placeOf(b, first + i, Searches::Place, in.point[i]);
      in.point[i][3] = 0;
      in.node[i] = b.node[first + i];
    }
    evaluatePoints<K>(view, parts, count, in, &b.lanes.value[first], wall);
    for (std::size_t i = 0; i < count; ++i) b.node[first + i] = in.node[i];
  }
  for (std::size_t k = 0; k < 4; ++k) store(&b.lanes.wall[k][first], wall[k]);
}

// Whether the normal of a query point leads along the vessel, as about an axis, where grad f is no
// more than the ripple of the blobs, which lie along it.
inline bool isAstray(const FootBatch& b, std::size_t i, const blob_sample& first) {
  const double radius = b.lanes.row[Searches::Radius][i];
  return first.distance < -kDeep * radius && (first.state & BLOB_INSIDE) != 0 &&
         b.lanes.wall[0][i] < 0.5 * first.distance;
}

// The place at the wall across the vessel: beyond that of kSides places about a query point where
// the wall is nearest.
template <class K>
LUMEN_NOINLINE void findAcross(const View& view, Parts parts, const double* point,
                               std::uint32_t node, Start& start) {
  const field::Vec along = alongVessel(view.model, node), first = field::perpendicular(along),
                   second = cross(along, first);
  const double reach = kAcross * static_cast<double>(view.nodes[node].radius());
  const field::Vec side[kSides] = {reach * first, -reach * first, reach * second, -reach * second};
  Inputs in;
  for (std::size_t n = 0; n < kSides; ++n) {
    in.point[n][0] = point[0] + side[n].x;
    in.point[n][1] = point[1] + side[n].y;
    in.point[n][2] = point[2] + side[n].z;
    in.point[n][3] = 0;
    in.node[n] = node;
  }
  F8 columns[4];
  float value[kLanes], wall[4][kLanes];
  evaluatePoints<K>(view, parts, kSides, in, value, columns);
  for (std::size_t k = 0; k < 4; ++k) store(wall[k], columns[k]);
  std::size_t best = 0;
  for (std::size_t n = 1; n < kSides; ++n)
    if (wall[0][n] > wall[0][best]) best = n;
  start.node = in.node[best];
  for (std::size_t k = 0; k < 3; ++k)
    start.place[k] = in.point[best][k] -
                     static_cast<double>(wall[0][best]) * static_cast<double>(wall[1 + k][best]);
}

// The place at the wall along the normal of a query point.
inline Start startAt(const FootJob& job, std::size_t id) {
  const blob_sample& first = job.samples[id];
  Start start;
  start.id = id;
  for (std::size_t k = 0; k < 3; ++k)
    start.place[k] = job.points[id][k] - first.distance * first.normal[k];
  start.node = first.node;
  return start;
}

// Lets those searches leave that begin anew across the vessel; returns how many.
template <class K>
inline std::size_t leaveAstray(const View& view, Parts parts, const FootJob& job, FootBatch& b,
                               Start* starts) {
  std::size_t count = 0;
  for (std::size_t i = b.count; i-- > 0;) {
    const std::size_t id = b.id[i];
    if (!isAstray(b, i, job.samples[id])) continue;
    starts[count] = startAt(job, id);
    findAcross<K>(view, parts, job.points[id], job.samples[id].node, starts[count++]);
    job.feet[id].steps += static_cast<std::uint32_t>(kSides) + 1;
    b.lanes.moveAnswer(b.count - 1, i);
    b.leave(i);
  }
  return count;
}

// Writes the shape of the wall at a place: of the node's model alone or, many times slower, of the
// field.
template <class K>
inline void putShape(const View& view, std::uint32_t flags, std::size_t i, FootBatch& b) {
  double at[3];
  placeOf(b, i, Searches::Place, at);
  Shape shape;
  if (b.wantsHessian[i]) {
    blob_hessian field;
    evaluateHessian(view.model, flags, at, b.node[i], field);
    for (std::size_t k = 0; k < 3; ++k) shape.gradient[k] = static_cast<float>(field.gradient[k]);
    for (std::size_t k = 0; k < 6; ++k) shape.hessian[k] = static_cast<float>(field.hessian[k]);
    b.wantsHessian[i] = false;
  } else {
    findShape<K>(view.model, at, b.node[i], shape);
  }
  const float* g = shape.gradient;
  const float slope = __builtin_sqrtf((g[0] * g[0] + g[1] * g[1]) + g[2] * g[2]);
  const float scale = slope > 0 ? -1.0f / slope : 0.0f;
  for (std::size_t k = 0; k < 6; ++k)
    b.lanes.row[Searches::Shape + k][i] = scale * shape.hessian[k];
  b.lanes.row[Searches::State][i] = Searches::kFresh;
}

// Bits of the searches whose last step has led away from the query point.
inline M8 areLonger(const Searches& s, std::size_t first) {
  const V8 normal{load(&s.wall[1][first]), load(&s.wall[2][first]), load(&s.wall[3][first])};
  const V8 way = (s.vector(Searches::Query, first) - s.vector(Searches::Place, first)) +
                 load(&s.wall[0][first]) * normal;
  return less(s.get(Searches::Reached, first), sqrt(dot(way, way)));
}

// Puts a stuck search to its foot, where f or, once that is at the wall, its second derivatives give
// the shape; false if it has been there before.
inline bool restart(FootBatch& b, std::size_t i) {
  Searches& s = b.lanes;
  float off = s.row[Searches::Off][i];
  off = off < 0 ? -off : off;
  if (!(off > kRestartOff * s.row[Searches::Radius][i])) {
    if (b.restarts[i]++ == kMostRestarts) return false;
    b.wantsHessian[i] = true;
  }
  for (std::size_t k = 0; k < 3; ++k) s.row[Searches::Place + k][i] = s.row[Searches::Foot + k][i];
  s.row[Searches::Reached][i] = kNotReached;
  s.row[Searches::Share][i] = 1;
  s.row[Searches::State][i] = Searches::kUnknown;
  return true;
}

inline void writeFoot(const FootBatch& b, std::size_t i, FootState state, WallFoot& foot) {
  const bool isReached = b.lanes.row[Searches::Reached][i] < kNotReached;
  placeOf(b, i, isReached ? Searches::Foot : Searches::Place, foot.at);
  for (std::size_t k = 0; k < 3; ++k) foot.normal[k] = b.lanes.row[Searches::Normal + k][i];
  foot.node = b.node[i];
  foot.steps += static_cast<std::uint32_t>(b.lanes.row[Searches::Rounds][i]);
  foot.state = state;
}

// Finds the shapes of eight searches that need them, at places that are accepted about the wall.
template <class K>
inline void putShapes(const View& view, std::uint32_t flags, std::size_t first, M8 isLonger,
                      FootBatch& b) {
  const F8 off = absolute(load(&b.lanes.wall[0][first]));
  const F8 reach = set1(kOffWall) * b.lanes.get(Searches::Radius, first);
  const M8 isUnknown = less(b.lanes.get(Searches::State, first), set1(Searches::kFresh));
  unsigned bits = maskBits(both(isUnknown, less(off, reach))) & ~maskBits(isLonger);
  if (b.count - first < kLanes) bits &= (1U << (b.count - first)) - 1U;
  for (; bits != 0; bits &= bits - 1)
    putShape<K>(view, flags, first + static_cast<std::size_t>(__builtin_ctz(bits)), b);
}

// Takes one step of all searches; those that end leave.
template <class K>
inline void stepFeet(const View& view, std::uint32_t flags, const FootJob& job, FootBatch& b) {
  StepBits bits[kMostRefined / kLanes];
  const std::size_t groups = (b.count + kLanes - 1) / kLanes;
  for (std::size_t g = 0; g < groups; ++g) {
    const M8 isLonger = areLonger(b.lanes, g * kLanes);
    putShapes<K>(view, flags, g * kLanes, isLonger, b);
    bits[g] = stepLanes(b.lanes, g * kLanes, isLonger, kLimits);
  }
  // from the last, as the last search moves to the lane of one that leaves
  for (std::size_t g = groups; g-- > 0;) {
    const unsigned left = bits[g].found | bits[g].stuck | bits[g].ended;
    for (int lane = kLanes; lane-- > 0;) {
      const std::size_t i = g * kLanes + static_cast<std::size_t>(lane);
      if ((left >> lane & 1U) == 0 || i >= b.count) continue;
      const bool isFound = (bits[g].found >> lane & 1U) != 0;
      if (!isFound && (bits[g].ended >> lane & 1U) == 0 && restart(b, i)) continue;
      writeFoot(b, i, isFound ? FootState::Found : FootState::Best, job.feet[b.id[i]]);
      b.leave(i);
    }
  }
}

// Finds the nearest points of the wall.
template <class K>
inline void findFeet(const blob_model& model, std::uint32_t flags, const FootJob& job) {
  const View view(model);
  const Parts parts = partsOf(flags);
  FootBatch b;
  for (std::size_t i = 0; i < job.count; ++i) {
    job.feet[i].state = FootState::None;
    job.feet[i].steps = 1;
    if (job.inRange[i] && job.samples[i].value > static_cast<double>(kVanished))
      enter(view, job, startAt(job, i), b);
  }
  Start across[kMostRefined];
  for (bool isFirst = true; b.count > 0; isFirst = false) {
    for (std::size_t i = 0; i < b.count; i += kLanes) evaluateLanes<K>(view, parts, i, b);
    const std::size_t left = isFirst ? leaveAstray<K>(view, parts, job, b, across) : 0;
    stepFeet<K>(view, flags, job, b);
    for (std::size_t n = 0; n < left; ++n) enter(view, job, across[n], b);
  }
}
