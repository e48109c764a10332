// SPDX-License-Identifier: Apache-2.0
// Input of points, search for their nodes, and output of answers. Include after wall_distance.h.

// The point relative to its node, which is located first if unknown; false for a point that is not
// finite or too far away.
inline bool enterNode(const View& view, const D4& point, std::uint32_t& node, F4& x) {
  if (node >= view.nodeCount) {
    double p[4];
    std::memcpy(p, &point, sizeof p);
    if (!isFinitePoint(p)) {
      node = BLOB_NOWHERE;
      return false;
    }
    node = locateLeast(view.model, p);
  }
  x = relative(view.nodes[node], point);
  return isWithin(x, static_cast<float>(kFarthestMm));
}

// Fills a lane without a point with harmless numbers.
inline void leaveEmpty(Group& g, std::size_t i) {
  store4(g.field[i], set4(1.0f));
  store4(g.at[i], set4(1.0f));
  g.shift[i] = 0;
}

// Parts of a query that flags leave out.
struct Parts {
  bool follows, blends;
};

inline Parts partsOf(std::uint32_t flags) {
  return {(flags & BLOB_HOLD) == 0, (flags & BLOB_LOCAL) == 0};
}

// The answer at one point, without the rows of a group: its numbers are in all lanes.
struct PointAnswer {
  F8 field[4], wall[4];
  F4 row;  // f and grad f, with the kernel's shift
  M8 inside;
};

// Evaluates f at one point; false if that is out of range.
template <class K>
inline bool evaluatePoint(const View& view, Parts parts, const D4& point, std::uint32_t& node,
                          PointAnswer& answer) {
  F4 x;
  if (!enterNode(view, point, node, x)) return false;
  if (parts.follows) node = followFrom(view, point, node, x);
  const Lane lane =
      parts.blends ? evaluateBlended<K>(view, point, node, x) : evaluateLocal<K>(view, node, x);
  answer.row = lane.field;
  answer.field[0] = splat<0>(lane.field);
  answer.field[1] = splat<1>(lane.field);
  answer.field[2] = splat<2>(lane.field);
  answer.field[3] = splat<3>(lane.field);
  const F8 at[4] = {splat<0>(x), splat<1>(x), splat<2>(x), set1(lane.radius)};
  answer.inside = finishLanes<K>(view, answer.field, at, set1(lane.shift), answer.wall);
  return true;
}

// Finds the node of a point, and its rivals; false for a point out of range.
inline bool placeLane(const View& view, Parts parts, const D4& point, std::uint32_t& node, Group& g,
                      std::size_t i) {
  F4 x;
  if (!enterNode(view, point, node, x)) return false;
  if (parts.follows) node = followFrom(view, point, node, x);
  store4(g.at[i], x);
  if (parts.blends) g.rivals[i] = findRivals(view, node, x, g.difference[i]);
  return true;
}

inline void fillSample(const Group& g, std::size_t i, std::uint32_t node, blob_sample& sample) {
  static_assert(offsetof(blob_sample, distance) == 4 * sizeof(double) &&
                    offsetof(blob_sample, node) == 8 * sizeof(double),
                "a sample starts with two rows of four");
  storeAsDoubles(&sample.value, load4(g.field[i]));
  storeAsDoubles(&sample.distance, load4(g.wall[i]));
  sample.node = node;
  sample.state = g.insideBits >> i & 1U;
}

LUMEN_NOINLINE void readInputs(const blob_columns& c, std::size_t first, std::size_t count,
                               Inputs& in) {
  if (count == kLanes && first + count < c.count && arePacked(c)) {
    const double* from = c.point[0] + 3 * first;
    for (std::size_t i = 0; i < kLanes; ++i)
      std::memcpy(in.point[i], from + 3 * i, sizeof in.point[i]);
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k)
        std::memcpy(&in.point[i][k], column(c.point[k], first + i, c.point_stride), sizeof(double));
      in.point[i][3] = 0;
    }
  }
  if (c.cursor == nullptr) {
    for (std::uint32_t& node : in.node) node = BLOB_NOWHERE;
  } else if (count == kLanes && c.cursor_stride == sizeof(std::uint32_t)) {
    std::memcpy(in.node, column(c.cursor, first, c.cursor_stride), sizeof in.node);
  } else {
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(&in.node[i], column(c.cursor, first + i, c.cursor_stride), sizeof in.node[i]);
  }
}

inline void fillAnswer(const View& view, const Inputs& in, const Group& g, std::size_t i,
                       bool outOfRange, blob_sample& sample) {
  if (outOfRange)
    answerOutOfRange(view.model, in.point[i], in.node[i], sample);
  else
    fillSample(g, i, in.node[i], sample);
}

// Number of groups that are processed together, so that the long chains of operations of one
// overlap with those of the others.
constexpr std::size_t kGroups = 4;

struct Batch {
  Inputs in[kGroups];
  Group group[kGroups];
  unsigned outOfRange[kGroups];
};

// Finds the nodes of a group. Separate from evaluation, as short loops overlap better in the
// processor.
LUMEN_NOINLINE unsigned placeGroup(const View& view, Parts parts, std::size_t count, Inputs& in,
                                   Group& g) {
  unsigned outOfRange = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (!placeLane(view, parts, load4(in.point[i]), in.node[i], g, i)) outOfRange |= 1U << i;
  return outOfRange;
}

// Bits of the points that need a look of their own: their cursors may move, or later blocks of
// neighbours count. The other points are placed, and have their rivals.
inline unsigned placeAtNodes(const View& view, Parts parts, const Inputs& in, Group& g,
                             std::size_t first) {
  constexpr unsigned kAll = (1U << kTogether) - 1U;
  const NodeRecord* node[kTogether];
  for (std::size_t k = 0; k < kTogether; ++k) {
    const std::uint32_t index = in.node[first + k];
    if (index >= view.nodeCount) return kAll;
    node[k] = view.nodes + index;
  }
  F4 squares = set4(0.0f);
  for (std::size_t k = 0; k < kTogether; ++k) {
    const F4 x = relative(*node[k], load4(in.point[first + k]));
    store4(g.at[first + k], x);
    squares = squares + x * x;
  }
  if (!isWithin(squares, static_cast<float>(kFarthestMm * kFarthestMm))) return kAll;
  if (!parts.follows && !parts.blends) return 0;
  unsigned others = 0;
  for (std::size_t k = 0; k < kTogether; ++k) {
    const std::size_t i = first + k;
    const NeighbourBlock& block = view.neighbours[node[k]->firstNeighbours];
    const F8 difference = powerDifference(block, Splats(g.at[i]));
    const bool moves = parts.follows && maskBits(less(difference, set1(0.0f))) != 0;
    others |= (moves || blocksAt(*node[k], load4(g.at[i])) != 1 ? 1U : 0U) << k;
    if (!parts.blends) continue;
    store(g.difference[i], difference);
    g.rivals[i] = rivalsIn(block, difference);
  }
  return others;
}

// Finds the nodes of a group side by side; returns the bits of the points out of range.
LUMEN_NOINLINE unsigned placeTogether(const View& view, Parts parts, std::size_t count, Inputs& in,
                                      Group& g) {
  if (count != kLanes) return placeGroup(view, parts, count, in, g);
  unsigned outOfRange = 0;
  for (std::size_t first = 0; first < kLanes; first += kTogether) {
    unsigned left = placeAtNodes(view, parts, in, g, first);
    for (; left != 0; left &= left - 1) {
      const std::size_t i = first + static_cast<std::size_t>(__builtin_ctz(left));
      if (!placeLane(view, parts, load4(in.point[i]), in.node[i], g, i)) outOfRange |= 1U << i;
    }
  }
  return outOfRange;
}

// Evaluates the model of each point's node alone.
template <class K>
LUMEN_NOINLINE void evaluateGroup(const View& view, std::size_t count, unsigned outOfRange,
                                  const Inputs& in, Group& g) {
  unsigned simple = count == kLanes && outOfRange == 0 ? 1U : 0U;
  if (simple != 0)
    for (const std::uint32_t node : in.node) simple &= view.fieldNode(node).isSimple;
  if (simple != 0) {
    for (std::size_t first = 0; first < kLanes; first += kTogether)
      evaluateTogether<K>(view, in.node + first, g.at + first, g.field + first, g.shift + first);
    return;
  }
  for (std::size_t i = 0; i < kLanes; ++i)
    if (i >= count || (outOfRange >> i & 1U) != 0)
      leaveEmpty(g, i);
    else
      keep(evaluateLocal<K>(view, in.node[i], load4(g.at[i])), g, i);
}

inline void writeCursors(const blob_columns& c, std::size_t first, std::size_t count,
                         const Inputs& in) {
  if (c.cursor == nullptr) return;
  if (count == kLanes && c.cursor_stride == sizeof(std::uint32_t))
    std::memcpy(column(c.cursor, first, c.cursor_stride), in.node, sizeof in.node);
  else
    for (std::size_t i = 0; i < count; ++i) put(c.cursor, first + i, c.cursor_stride, in.node[i]);
}

LUMEN_NOINLINE void writeGroup(const View& view, const Job& job, std::size_t first,
                               std::size_t count, const Inputs& in, const Group& g,
                               unsigned outOfRange) {
  const blob_columns& c = job.columns;
  writeCursors(c, first, count, in);
  if (job.inRange != nullptr)
    for (std::size_t i = 0; i < count; ++i) job.inRange[first + i] = (outOfRange >> i & 1U) == 0;
  if (job.samples != nullptr && outOfRange == 0) {
    for (std::size_t i = 0; i < count; ++i) fillSample(g, i, in.node[i], job.samples[first + i]);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    blob_sample sample;
    fillAnswer(view, in, g, i, (outOfRange >> i & 1U) != 0, sample);
    if (job.samples != nullptr)
      job.samples[first + i] = sample;
    else
      putSample(c, first + i, sample);
  }
}

template <class K>
inline void queryBatch(const View& view, std::uint32_t flags, const Job& job, std::size_t first,
                       std::size_t count, Batch& batch) {
  const Parts parts = partsOf(flags);
  const std::size_t groups = (count + kLanes - 1) / kLanes;
  const auto sizeOf = [count](std::size_t g) {
    const std::size_t left = count - g * kLanes;
    return left < kLanes ? left : std::size_t{kLanes};
  };
  for (std::size_t g = 0; g < groups; ++g) {
    readInputs(job.columns, first + g * kLanes, sizeOf(g), batch.in[g]);
    Inputs& in = batch.in[g];
    batch.outOfRange[g] = placeTogether(view, parts, sizeOf(g), in, batch.group[g]);
    evaluateGroup<K>(view, sizeOf(g), batch.outOfRange[g], in, batch.group[g]);
    if (parts.blends) blendGroup<K>(view, sizeOf(g), batch.outOfRange[g], in, batch.group[g]);
  }
  for (std::size_t g = 0; g < groups; ++g) finishGroup<K>(view, batch.group[g]);
  for (std::size_t g = 0; g < groups; ++g)
    writeGroup(view, job, first + g * kLanes, sizeOf(g), batch.in[g], batch.group[g],
               batch.outOfRange[g]);
}
