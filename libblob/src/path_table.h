// SPDX-License-Identifier: Apache-2.0
// The functions of the table. Include after path_query.h.

inline std::uint32_t tableFollow(const blob_model& model, const double* point, std::uint32_t node) {
  const D4 p = load3(point);
  const View view(model, 0);
  F4 x = relative(view.nodes[node], p);
  return followFrom(view, p, node, x);
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
  const D4 p = load3(point);
  const View view(model, flags);
  const F4 x = relative(view.nodes[node], p);
  if ((flags & BLOB_LOCAL) != 0) return valueOfNode<kernel>(view, view.node(node), x) > view.level;
  const Lane lane = evaluateBlended<kernel>(view, p, node, x);
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
  const D4 p = load3(point);
  const View view(model, flags);
  const float margin = (flags & BLOB_LOCAL) != 0 ? 0.0f : 1.0f;
  const NodeRecord& record = view.nodes[node];
  const F4 x = relative(record, p);
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
      boundNode<kernel>(view, view.node(k), relative(view.nodes[k], p), radius, *least, *greatest);
    }
  }
}

// One point, without the rows of a group: its numbers are in all lanes.
template <int kernel>
inline void tableQueryOne(const blob_model& model, std::uint32_t flags, const double* point,
                          std::uint32_t& node, blob_sample& sample) {
  const D4 p = load3(point);
  const View view(model, flags);
  F4 x;
  if (!enterNode(view, p, node, x)) {
    answerRemote(model, point, node, sample);
    return;
  }
  if ((flags & BLOB_HOLD) == 0) node = followFrom(view, p, node, x);
  const Lane lane = (flags & BLOB_LOCAL) != 0 ? evaluateLocal<kernel>(view, node, x)
                                              : evaluateBlended<kernel>(view, p, node, x);
  F8 field[4] = {splat<0>(lane.field), splat<1>(lane.field), splat<2>(lane.field),
                 splat<3>(lane.field)};
  const F8 at[4] = {splat<0>(x), splat<1>(x), splat<2>(x), set1(lane.radius)};
  F8 wall[4];
  const M8 inside = finishLanes<kernel>(view, field, at, set1(lane.shift), wall);
  const bool isShifted = kernel == BLOB_GAUSSIAN;
  storeAsDoubles(&sample.value, isShifted ? firstLanes(field) : lane.field);
  storeAsDoubles(&sample.distance, firstLanes(wall));
  sample.node = node;
  sample.state = maskBits(inside) & 1U;
  if ((flags & BLOB_DISTANCE_EXACT) != 0) refineSample(model, flags, point, sample);
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
constexpr PathTable kTable{&locateLeast,         &tableFollow,           &tableInside<kernel>,
                           &tableBounds<kernel>, &tableQueryOne<kernel>, &tableQuery<kernel>};

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
