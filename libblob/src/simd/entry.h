// SPDX-License-Identifier: Apache-2.0
// The functions of a back end. Include after batch.h.

inline std::uint32_t followCursor(const blob_model& model, const double* point,
                                  std::uint32_t node) {
  const D4 p = load3(point);
  const View view(model);
  F4 x = relative(view.nodes[node], p);
  return followFrom(view, p, node, x);
}

// f of one node, without its gradient.
template <class K>
inline float valueOfNode(const View& view, const FieldNode& node, F4 x) {
  const Splats at(x + load4(node.place));
  F8 f = set1(0.0f);
  for (std::uint32_t b = node.block; b < node.block + node.blockCount; ++b) {
    const BlobBlock& block = view.blocks[b];
    f = f + K::term(computeOffsets(block, at).u, load(block.a), load(block.w)).value;
  }
  return sumLanes(f);
}

template <class K>
inline bool isInside(const blob_model& model, std::uint32_t flags, const double* point,
                     std::uint32_t node) {
  const D4 p = load3(point);
  const View view(model);
  const F4 x = relative(view.nodes[node], p);
  if ((flags & BLOB_LOCAL) != 0) return valueOfNode<K>(view, view.fieldNode(node), x) > view.level;
  const Lane lane = evaluateBlended<K>(view, p, node, x);
  const float scale = kIsShifted<K> ? exponential(0.0f - lane.shift) : 1.0f;
  return firstLane(lane.field) * scale > view.level;
}

// Bounds on a node's f in a ball: every blob's part falls with the distance from its centre, so the
// ends of the ball along the line through the centre bound it.
template <class K>
inline void boundNode(const View& view, const FieldNode& node, F4 x, float radius, float& least,
                      float& greatest) {
  const Splats at(x + load4(node.place));
  F8 low = set1(0.0f), high = low;
  for (std::uint32_t b = node.block; b < node.block + node.blockCount; ++b) {
    const Offsets d = computeOffsets(view.blocks[b], at);
    const F8 a = load(view.blocks[b].a), w = load(view.blocks[b].w);
    const F8 r = sqrt((d.x * d.x + d.y * d.y) + d.z * d.z);
    const F8 far = r + set1(radius), near = max(r - set1(radius), set1(0.0f));
    low = low + K::term(a * (far * far), a, w).value;
    high = high + K::term(a * (near * near), a, w).value;
  }
  constexpr float kRounding = 1e-5f;
  const float lowSum = sumLanes(low) * (1.0f - kRounding),
              highSum = sumLanes(high) * (1.0f + kRounding);
  least = lowSum < least ? lowSum : least;
  greatest = highSum > greatest ? highSum : greatest;
}

// Bounds on f in a ball: a neighbour may take part somewhere in it unless it stays beaten, by tau
// if blended.
template <class K>
inline void boundField(const blob_model& model, std::uint32_t flags, const double* point,
                       std::uint32_t node, float radius, float* least, float* greatest) {
  const D4 p = load3(point);
  const View view(model);
  const float margin = (flags & BLOB_LOCAL) != 0 ? 0.0f : 1.0f;
  const NodeRecord& record = view.nodes[node];
  const F4 x = relative(record, p);
  *least = 3e38f;
  *greatest = 0;
  boundNode<K>(view, view.fieldNode(node), x, radius, *least, *greatest);
  if ((flags & BLOB_HOLD) != 0 && (flags & BLOB_LOCAL) != 0) return;
  for (std::uint32_t b = 0; b < record.neighbourBlocks; ++b) {
    const NeighbourBlock& block = view.neighbours[record.firstNeighbours + b];
    const F8 nx = load(block.nx), ny = load(block.ny), nz = load(block.nz);
    const F8 reach = set1(radius) * sqrt((nx * nx + ny * ny) + nz * nz);
    const F8 lowest = (powerDifference(block, Splats(x)) - reach) * load(block.inverseTau);
    for (unsigned rivals = maskBits(less(lowest, set1(margin))); rivals != 0;
         rivals &= rivals - 1) {
      const std::uint32_t k = block.node[__builtin_ctz(rivals)];
      boundNode<K>(view, view.fieldNode(k), relative(view.nodes[k], p), radius, *least, *greatest);
    }
  }
}

// Answers at one point.
template <class K>
inline bool queryPoint(const blob_model& model, std::uint32_t flags, const double* point,
                       std::uint32_t& node, blob_sample& sample) {
  const View view(model);
  PointAnswer answer;
  if (!evaluatePoint<K>(view, partsOf(flags), load3(point), node, answer)) {
    answerOutOfRange(model, point, node, sample);
    return false;
  }
  storeAsDoubles(&sample.value, kIsShifted<K> ? firstLanes(answer.field) : answer.row);
  storeAsDoubles(&sample.distance, firstLanes(answer.wall));
  sample.node = node;
  sample.state = maskBits(answer.inside) & 1U;
  return true;
}

template <class K>
inline void queryColumns(const blob_model& model, std::uint32_t flags, const Job& job) {
  const View view(model);
  Batch batch;
  constexpr std::size_t kMostPoints = kGroups * kLanes;
  for (std::size_t first = 0; first < job.columns.count; first += kMostPoints) {
    const std::size_t left = job.columns.count - first;
    queryBatch<K>(view, flags, job, first, left < kMostPoints ? left : kMostPoints, batch);
  }
}

template <class K>
constexpr Backend kBackend{&locateLeast,    &followCursor,    &isInside<K>, &boundField<K>,
                           &queryPoint<K>,  &queryColumns<K>, &placeBlobs,  &placeNeighbours,
                           &greatestStrain, &findFeet<K>};

struct ChooseBackend {
  template <class K>
  const Backend* operator()(K) const {
    return &kBackend<K>;
  }
};

inline const Backend* backendOf(blob_kernel kernel) {
  // in brackets: the one of this namespace, not that of field::Kernel's
  return (withKernel)(kernelOf(kernel), ChooseBackend{});
}
