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

// Finds the node of a point; false for a point out of range.
inline bool placeLane(const View& view, bool hold, const D4& point, std::uint32_t& node, Group& g,
                      std::size_t i) {
  F4 x;
  if (!enterNode(view, point, node, x)) return false;
  if (!hold) node = followFrom(view, point, node, x);
  store4(g.at[i], x);
  return true;
}

inline void keep(const Lane& lane, Group& g, std::size_t i) {
  store4(g.field[i], lane.field);
  g.at[i][3] = lane.radius;
  g.shift[i] = lane.shift;
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

struct alignas(32) Inputs {
  double point[kLanes][4];  ///< the fourth is not used
  std::uint32_t node[kLanes];
};

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
LUMEN_NOINLINE unsigned placeGroup(const View& view, bool hold, std::size_t count, Inputs& in,
                                   Group& g) {
  unsigned outOfRange = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (!placeLane(view, hold, load4(in.point[i]), in.node[i], g, i)) outOfRange |= 1U << i;
  return outOfRange;
}

// Number of points processed side by side, so that one's chain of operations fills the pauses of
// another's: the processor does not look far enough ahead to find the next point by itself.
constexpr std::size_t kTogether = 4;

// Bits of the points whose cursors may move, or all if a node does not have exactly one block of
// neighbours; the other points are placed.
inline unsigned stayTogether(const View& view, bool hold, const Inputs& in, Group& g,
                             std::size_t first) {
  constexpr unsigned kAll = (1U << kTogether) - 1U;
  const NodeRecord* node[kTogether];
  unsigned others = 0;
  for (std::size_t k = 0; k < kTogether; ++k) {
    const std::uint32_t index = in.node[first + k];
    if (index >= view.nodeCount) return kAll;
    node[k] = view.nodes + index;
    others |= node[k]->neighbourBlocks ^ 1U;
  }
  if (others != 0) return kAll;
  F4 squares = set4(0.0f);
  for (std::size_t k = 0; k < kTogether; ++k) {
    const F4 x = relative(*node[k], load4(in.point[first + k]));
    store4(g.at[first + k], x);
    squares = squares + x * x;
  }
  if (!isWithin(squares, static_cast<float>(kFarthestMm * kFarthestMm))) return kAll;
  if (hold) return 0;
  unsigned moving = 0;
  for (std::size_t k = 0; k < kTogether; ++k) {
    const F8 difference =
        powerDifference(view.neighbours[node[k]->firstNeighbours], Splats(g.at[first + k]));
    moving |= (maskBits(less(difference, set1(0.0f))) != 0 ? 1U : 0U) << k;
  }
  return moving;
}

template <class K>
inline void evaluateTogether(const View& view, const Inputs& in, Group& g, std::size_t first) {
  Terms terms[kTogether];
  for (std::size_t k = 0; k < kTogether; ++k) {
    const FieldNode& node = view.fieldNode(in.node[first + k]);
    const Splats at(g.at[first + k]);
    const BlobBlock& block = view.blocks[node.block];
    const float shift = kIsShifted<K> ? leastExponent(&block, 1, at) : 0.0f;
    terms[k] = computeTerms<K>(block, at, shift);
    g.shift[first + k] = shift;
    g.at[first + k][3] = node.place[3];
  }
  for (std::size_t k = 0; k < kTogether; ++k)
    store4(g.field[first + k], sums(terms[k].f, terms[k].x, terms[k].y, terms[k].z));
}

// Finds the nodes of a group side by side; returns the bits of the points out of range.
LUMEN_NOINLINE unsigned placeTogether(const View& view, bool hold, std::size_t count, Inputs& in,
                                      Group& g) {
  if (count != kLanes) return placeGroup(view, hold, count, in, g);
  unsigned outOfRange = 0;
  for (std::size_t first = 0; first < kLanes; first += kTogether) {
    unsigned left = stayTogether(view, hold, in, g, first);
    for (; left != 0; left &= left - 1) {
      const std::size_t i = first + static_cast<std::size_t>(__builtin_ctz(left));
      if (!placeLane(view, hold, load4(in.point[i]), in.node[i], g, i)) outOfRange |= 1U << i;
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
      evaluateTogether<K>(view, in, g, first);
    return;
  }
  for (std::size_t i = 0; i < kLanes; ++i)
    if (i >= count || (outOfRange >> i & 1U) != 0)
      leaveEmpty(g, i);
    else
      keep(evaluateLocal<K>(view, in.node[i], load4(g.at[i])), g, i);
}

// Blends a group: finds the points that need it first, then blends them. In one loop the processor
// would often mispredict whether the next point needs that long work.
template <class K>
LUMEN_NOINLINE void blendGroup(const View& view, std::size_t count, unsigned outOfRange,
                               const Inputs& in, Group& g) {
  float difference[kLanes][kLanes];
  unsigned rivals[kLanes], left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if ((outOfRange >> i & 1U) != 0) continue;
    rivals[i] = findRivals(view, in.node[i], Splats(g.at[i]), difference[i]);
    left |= (rivals[i] != 0 ? 1U : 0U) << i;
  }
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(left));
    Lane lane{load4(g.field[i]), g.shift[i], g.at[i][3]};
    blendLane<K>(view, load4(in.point[i]), in.node[i], load4(g.at[i]), difference[i], rivals[i],
                 lane);
    keep(lane, g, i);
  }
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
  const std::size_t groups = (count + kLanes - 1) / kLanes;
  const auto sizeOf = [count](std::size_t g) {
    const std::size_t left = count - g * kLanes;
    return left < kLanes ? left : std::size_t{kLanes};
  };
  for (std::size_t g = 0; g < groups; ++g) {
    readInputs(job.columns, first + g * kLanes, sizeOf(g), batch.in[g]);
    Inputs& in = batch.in[g];
    const bool hold = (flags & BLOB_HOLD) != 0;
    batch.outOfRange[g] = placeTogether(view, hold, sizeOf(g), in, batch.group[g]);
    evaluateGroup<K>(view, sizeOf(g), batch.outOfRange[g], in, batch.group[g]);
    if ((flags & BLOB_LOCAL) == 0)
      blendGroup<K>(view, sizeOf(g), batch.outOfRange[g], in, batch.group[g]);
  }
  for (std::size_t g = 0; g < groups; ++g) finishGroup<K>(view, batch.group[g]);
  for (std::size_t g = 0; g < groups; ++g)
    writeGroup(view, job, first + g * kLanes, sizeOf(g), batch.in[g], batch.group[g],
               batch.outOfRange[g]);
}
