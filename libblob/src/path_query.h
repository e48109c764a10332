// SPDX-License-Identifier: Apache-2.0
// Reading points, finding their nodes, writing answers; and the functions of the table. Include after
// path_distance.h.

template <class T>
inline T* column(T* first, std::size_t index, std::ptrdiff_t stride) {
  using Byte = std::conditional_t<std::is_const_v<T>, const char, char>;
  return reinterpret_cast<T*>(reinterpret_cast<Byte*>(first) +
                              static_cast<std::ptrdiff_t>(index) * stride);
}
template <class T, class V>
inline void put(T* first, std::size_t index, std::ptrdiff_t stride, V value) {
  const T converted = static_cast<T>(value);
  std::memcpy(column(first, index, stride), &converted, sizeof converted);
}

// The point relative to its node, which is located first if unknown; false for a point that is not
// finite or too far away.
inline bool enterNode(const View& view, const double* point, std::uint32_t& node, F4& x) {
  if (node >= view.nodeCount) {
    node = locateAny(view.model, point);
    if (node >= view.nodeCount) return false;
  }
  x = relative(view.nodes[node], point);
  return isWithin(x, static_cast<float>(kFar));
}

// A lane without a point computes something harmless.
inline void leaveEmpty(Group& g, std::size_t i) {
  store4(g.field[i], set4(1.0f));
  store4(g.at[i], set4(1.0f));
  g.shift[i] = 0;
}

// Finds the node of a point; false for a point that needs answerRemote().
inline bool placeLane(const View& view, bool hold, const double* point, std::uint32_t& node,
                      Group& g, std::size_t i) {
  F4 x;
  if (!enterNode(view, point, node, x)) return false;
  if (!hold) node = followFrom(view, point, node, x);
  store4(g.at[i], x);
  return true;
}

template <int kernel, bool local>
inline void evaluateLane(const View& view, const double* point, std::uint32_t node, Group& g,
                         std::size_t i) {
  const F4 x = load4(g.at[i]);
  Lane lane;
  if constexpr (local)
    lane = evaluateLocal<kernel>(view, node, x);
  else
    lane = evaluateBlended<kernel>(view, point, node, x);
  store4(g.field[i], lane.field);
  g.at[i][3] = lane.radius;
  if constexpr (kernel == BLOB_GAUSSIAN) g.shift[i] = lane.shift;
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

inline void putSample(const blob_columns& c, std::size_t i, const blob_sample& sample) {
  if (c.value != nullptr) put(c.value, i, c.answer_stride, sample.value);
  if (c.distance != nullptr) put(c.distance, i, c.answer_stride, sample.distance);
  if (c.normal[0] != nullptr)
    for (int k = 0; k < 3; ++k) put(c.normal[k], i, c.answer_stride, sample.normal[k]);
  if (c.gradient[0] != nullptr)
    for (int k = 0; k < 3; ++k) put(c.gradient[k], i, c.answer_stride, sample.gradient[k]);
  if (c.state != nullptr) put(c.state, i, c.state_stride, sample.state);
}

struct alignas(32) Inputs {
  double point[kLanes][4];  ///< the fourth is not used
  std::uint32_t node[kLanes];
};

// Points side by side can be copied four doubles at a time, but for the last, after which there may
// be nothing.
inline bool arePacked(const blob_columns& c) {
  return c.point_stride == 3 * sizeof(double) && c.point[1] == c.point[0] + 1 &&
         c.point[2] == c.point[0] + 2;
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

inline void writeAnswer(const View& view, std::uint32_t flags, const Inputs& in, const Group& g,
                        std::size_t i, bool remote, blob_sample& sample) {
  if (remote) {
    answerRemote(view.model, in.point[i], in.node[i], sample);
    return;
  }
  fillSample(g, i, in.node[i], sample);
  if ((flags & BLOB_DISTANCE_EXACT) != 0) refineSample(view.model, flags, in.point[i], sample);
}

// Groups are worked on together, so that the long chains of one hide in those of the others.
constexpr std::size_t kGroups = 4;

struct Batch {
  Inputs in[kGroups];
  Group group[kGroups];
  unsigned remote[kGroups];
};

// In two loops, as short ones overlap better in the processor.
LUMEN_NOINLINE unsigned placeGroup(const View& view, bool hold, std::size_t count, Inputs& in,
                                   Group& g) {
  unsigned remote = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (!placeLane(view, hold, in.point[i], in.node[i], g, i)) remote |= 1U << i;
  return remote;
}

template <int kernel, bool local>
LUMEN_NOINLINE void evaluateGroup(const View& view, std::size_t count, unsigned remote,
                                  const Inputs& in, Group& g) {
  if (remote == 0) {
    for (std::size_t i = 0; i < count; ++i)
      evaluateLane<kernel, local>(view, in.point[i], in.node[i], g, i);
  } else {
    for (std::size_t i = 0; i < count; ++i)
      if ((remote >> i & 1U) != 0)
        leaveEmpty(g, i);
      else
        evaluateLane<kernel, local>(view, in.point[i], in.node[i], g, i);
  }
  for (std::size_t i = count; i < kLanes; ++i) leaveEmpty(g, i);
}

inline void writeCursors(const blob_columns& c, std::size_t first, std::size_t count,
                         const Inputs& in) {
  if (c.cursor == nullptr) return;
  if (count == kLanes && c.cursor_stride == sizeof(std::uint32_t))
    std::memcpy(column(c.cursor, first, c.cursor_stride), in.node, sizeof in.node);
  else
    for (std::size_t i = 0; i < count; ++i) put(c.cursor, first + i, c.cursor_stride, in.node[i]);
}

LUMEN_NOINLINE void writeGroup(const View& view, std::uint32_t flags, const Job& job,
                               std::size_t first, std::size_t count, const Inputs& in,
                               const Group& g, unsigned remote) {
  const blob_columns& c = job.columns;
  writeCursors(c, first, count, in);
  if (job.samples != nullptr && remote == 0 && (flags & BLOB_DISTANCE_EXACT) == 0) {
    for (std::size_t i = 0; i < count; ++i) fillSample(g, i, in.node[i], job.samples[first + i]);
    return;
  }
  if (job.samples != nullptr) {
    for (std::size_t i = 0; i < count; ++i)
      writeAnswer(view, flags, in, g, i, (remote >> i & 1U) != 0, job.samples[first + i]);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    blob_sample sample;
    writeAnswer(view, flags, in, g, i, (remote >> i & 1U) != 0, sample);
    putSample(c, first + i, sample);
  }
}

template <int kernel>
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
    const unsigned remote =
        placeGroup(view, (flags & BLOB_HOLD) != 0, sizeOf(g), in, batch.group[g]);
    batch.remote[g] = remote;
    if ((flags & BLOB_LOCAL) != 0)
      evaluateGroup<kernel, true>(view, sizeOf(g), remote, in, batch.group[g]);
    else
      evaluateGroup<kernel, false>(view, sizeOf(g), remote, in, batch.group[g]);
  }
  for (std::size_t g = 0; g < groups; ++g) finishGroup<kernel>(view, batch.group[g]);
  for (std::size_t g = 0; g < groups; ++g)
    writeGroup(view, flags, job, first + g * kLanes, sizeOf(g), batch.in[g], batch.group[g],
               batch.remote[g]);
}

// ---------------------------------------------------------------- the table's functions

// With the fourth, zero coordinate.
struct alignas(32) Point4 {
  explicit Point4(const double* p) : at{p[0], p[1], p[2], 0} {}
  double at[4];
};

inline std::uint32_t tableFollow(const blob_model& model, const double* point, std::uint32_t node) {
  const Point4 p(point);
  const View view(model, 0);
  F4 x = relative(view.nodes[node], p.at);
  return followFrom(view, p.at, node, x);
}

// f of one node, without its gradient.
template <int kernel>
inline float valueOfNode(const View& view, const FieldNode& node, F4 x) {
  const Splats at(x + load4(node.place));
  F8 f = set1(0.0f);
  for (std::uint32_t b = node.block; b < node.block + node.blockCount; ++b) {
    const BlobBlock& block = view.blocks[b];
    F8 value, slope;
    kernelTerms<kernel>(offsetsOf(block, at).u, load(block.a), load(block.w), value, slope);
    f = f + value;
  }
  return sumOf(f);
}

template <int kernel>
inline bool tableInside(const blob_model& model, std::uint32_t flags, const double* point,
                        std::uint32_t node) {
  const Point4 p(point);
  const View view(model, flags);
  const F4 x = relative(view.nodes[node], p.at);
  if ((flags & BLOB_LOCAL) != 0) return valueOfNode<kernel>(view, view.node(node), x) > view.level;
  const Lane lane = evaluateBlended<kernel>(view, p.at, node, x);
  const float scale = kernel == BLOB_GAUSSIAN ? exponential(0.0f - lane.shift) : 1.0f;
  return firstOf(lane.field) * scale > view.level;
}

// Every blob's part falls with the distance from its centre, so the ends of the ball along the line
// through the centre bound it.
template <int kernel>
inline void boundNode(const View& view, const FieldNode& node, F4 x, float radius, float& least,
                      float& greatest) {
  const Splats at(x + load4(node.place));
  F8 low = set1(0.0f), high = low;
  for (std::uint32_t b = node.block; b < node.block + node.blockCount; ++b) {
    const Offsets d = offsetsOf(view.blocks[b], at);
    const F8 a = load(view.blocks[b].a), w = load(view.blocks[b].w);
    const F8 r = sqrt((d.x * d.x + d.y * d.y) + d.z * d.z);
    const F8 far = r + set1(radius), near = max(r - set1(radius), set1(0.0f));
    F8 value, slope;
    kernelTerms<kernel>(a * (far * far), a, w, value, slope);
    low = low + value;
    kernelTerms<kernel>(a * (near * near), a, w, value, slope);
    high = high + value;
  }
  constexpr float kRounding = 1e-5f;
  const float lowSum = sumOf(low) * (1.0f - kRounding), highSum = sumOf(high) * (1.0f + kRounding);
  least = lowSum < least ? lowSum : least;
  greatest = highSum > greatest ? highSum : greatest;
}

// A neighbour may take part somewhere in the ball unless it stays beaten, by tau if blended.
template <int kernel>
inline void tableBounds(const blob_model& model, std::uint32_t flags, const double* point,
                        std::uint32_t node, float radius, float* least, float* greatest) {
  const Point4 p(point);
  const View view(model, flags);
  const float margin = (flags & BLOB_LOCAL) != 0 ? 0.0f : 1.0f;
  const NodeRecord& record = view.nodes[node];
  const F4 x = relative(record, p.at);
  *least = 3e38f;
  *greatest = 0;
  boundNode<kernel>(view, view.node(node), x, radius, *least, *greatest);
  if ((flags & BLOB_HOLD) != 0 && (flags & BLOB_LOCAL) != 0) return;
  for (std::uint32_t b = record.fan; b < record.fan + record.fanCount; ++b) {
    const FanBlock& fan = view.fans[b];
    const F8 nx = load(fan.nx), ny = load(fan.ny), nz = load(fan.nz);
    const F8 reach = set1(radius) * sqrt((nx * nx + ny * ny) + nz * nz);
    const F8 lowest = (powerDifference(fan, Splats(x)) - reach) * load(fan.inverseTau);
    for (unsigned rivals = maskBits(less(lowest, set1(margin))); rivals != 0;
         rivals &= rivals - 1) {
      const std::uint32_t k = fan.node[__builtin_ctz(rivals)];
      boundNode<kernel>(view, view.node(k), relative(view.nodes[k], p.at), radius, *least,
                        *greatest);
    }
  }
}

template <int kernel>
inline void tableQuery(const blob_model& model, std::uint32_t flags, const Job& job) {
  const View view(model, flags);
  Batch batch;
  constexpr std::size_t kMost = kGroups * kLanes;
  for (std::size_t first = 0; first < job.columns.count; first += kMost) {
    const std::size_t left = job.columns.count - first;
    queryBatch<kernel>(view, flags, job, first, left < kMost ? left : kMost, batch);
  }
}

template <int kernel>
constexpr PathTable kTable{&locateLeast, &tableFollow, &tableInside<kernel>, &tableBounds<kernel>,
                           &tableQuery<kernel>};

inline const PathTable* tableOf(blob_kernel kernel) {
  switch (kernel) {
    case BLOB_CAUCHY:
      return &kTable<BLOB_CAUCHY>;
    case BLOB_GAUSSIAN:
      return &kTable<BLOB_GAUSSIAN>;
    case BLOB_QUARTIC:
      return &kTable<BLOB_QUARTIC>;
    case BLOB_SOFT_OBJECT:
      break;
  }
  return &kTable<BLOB_SOFT_OBJECT>;
}
