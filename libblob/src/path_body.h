// SPDX-License-Identifier: Apache-2.0
// The hot part of all queries, on the eight lanes F8 that the including file has declared in its
// namespace. No operation is contracted or reordered, so every set of instructions gives the same
// bits.

// Kept out of line: each loop gets all registers.
#if defined(__GNUC__)
#define LUMEN_NOINLINE __attribute__((noinline))
#else
#define LUMEN_NOINLINE
#endif

// What a query reads.
struct View {
  View(const blob_model& m, std::uint32_t flags)
      : nodes(m.nodes.data()),
        fans(m.fans.data()),
        blocks(m.field(flags).blocks.data()),
        fields(reinterpret_cast<const char*>(m.usesTwin(flags) ? m.twinNodes.data()
                                                               : &m.nodes[0].field)),
        fieldStride(m.usesTwin(flags) ? sizeof(FieldNode) : sizeof(NodeRecord)),
        nodeCount(m.nodes.size()),
        level(static_cast<float>(m.field(flags).isoLevel)),
        straightLevel(static_cast<float>(m.field(flags).straightLevel)),
        model(m) {}
  [[nodiscard]] const FieldNode& node(std::uint32_t i) const {
    return *reinterpret_cast<const FieldNode*>(fields + i * fieldStride);
  }
  const NodeRecord* nodes;
  const FanBlock* fans;
  const BlobBlock* blocks;
  const char* fields;
  std::size_t fieldStride, nodeCount;
  float level, straightLevel;
  const blob_model& model;
};

// A point relative to a node's centre; the fourth number is of any value.
inline F4 relative(const NodeRecord& node, const D4& point) {
  return differenceOf(point, load4(node.centre));
}

// A row's first three numbers, each in all lanes.
struct Splats {
  explicit Splats(F4 row) : x(splat<0>(row)), y(splat<1>(row)), z(splat<2>(row)) {}
  explicit Splats(const float* row) : x(set1(row[0])), y(set1(row[1])), z(set1(row[2])) {}
  F8 x, y, z;
};

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

// ---------------------------------------------------------------- one model

// What a blob adds: `value` to f, and `slope` times (X - C) to grad f. u is a |X - C|^2; for the
// Gaussian, less the shift.
template <int kernel>
inline void kernelTerms(F8 u, F8 a, F8 w, F8& value, F8& slope) {
  const F8 one = set1(1.0f);
  if constexpr (kernel == BLOB_CAUCHY) {
    const F8 q = one / (one + u);
    value = w * (q * q);
    slope = (set1(-4.0f) * a) * (value * q);
  } else if constexpr (kernel == BLOB_GAUSSIAN) {
    value = w * exponential(max(set1(0.0f) - u, set1(-87.0f)));
    slope = (set1(-2.0f) * a) * value;
  } else {
    const F8 v = max(one - u, set1(0.0f));
    if constexpr (kernel == BLOB_QUARTIC) {
      value = w * (v * v);
      slope = (set1(-4.0f) * a) * (w * v);
    } else {
      value = w * (v * v) * (set1(5.0f) + set1(4.0f) * v) * set1(1.0f / 9.0f);
      slope = (set1(-2.0f / 9.0f) * a) * (w * v) * (set1(10.0f) + set1(12.0f) * v);
    }
  }
}

struct Offsets {
  F8 x, y, z, u;
};

inline Offsets offsetsOf(const BlobBlock& block, const Splats& at) {
  Offsets d;
  d.x = at.x - load(block.x);
  d.y = at.y - load(block.y);
  d.z = at.z - load(block.z);
  d.u = load(block.a) * ((d.x * d.x + d.y * d.y) + d.z * d.z);
  return d;
}

// The least a |X - C|^2 of all blobs; padding counts as far away.
inline float leastExponent(const BlobBlock* blocks, std::uint32_t count, const Splats& at) {
  F8 least = set1(3e38f);
  for (std::uint32_t b = 0; b < count; ++b) {
    const F8 u = offsetsOf(blocks[b], at).u;
    least = min(select(less(set1(0.0f), load(blocks[b].w)), u, set1(3e38f)), least);
  }
  return leastOf(least);
}

// What eight blobs add to f and grad f.
struct Terms {
  F8 f, x, y, z;
};

template <int kernel>
inline Terms termsOf(const BlobBlock& block, const Splats& at, float shift) {
  Offsets d = offsetsOf(block, at);
  if constexpr (kernel == BLOB_GAUSSIAN) d.u = d.u - set1(shift);
  F8 value, slope;
  kernelTerms<kernel>(d.u, load(block.a), load(block.w), value, slope);
  return {value, slope * d.x, slope * d.y, slope * d.z};
}

// f, then grad f.
template <int kernel>
inline F4 sumBlocks(const BlobBlock* blocks, std::uint32_t count, const Splats& at, float shift) {
  if (count == 0) return set4(0.0f);
  Terms sum = termsOf<kernel>(blocks[0], at, shift);
  for (std::uint32_t b = 1; b < count; ++b) {
    const Terms next = termsOf<kernel>(blocks[b], at, shift);
    sum.f = sum.f + next.f;
    sum.x = sum.x + next.x;
    sum.y = sum.y + next.y;
    sum.z = sum.z + next.z;
  }
  return sums(sum.f, sum.x, sum.y, sum.z);
}

// f and grad f of one node's model at x, relative to the node's centre.
template <int kernel>
inline F4 evaluateNode(const View& view, const FieldNode& node, F4 x, float& shift) {
  const BlobBlock* blocks = view.blocks + node.block;
  const Splats at(x + load4(node.place));
  shift = 0;
  if constexpr (kernel == BLOB_GAUSSIAN)
    if (node.blockCount > 0) shift = leastExponent(blocks, node.blockCount, at);
  return sumBlocks<kernel>(blocks, node.blockCount, at, shift);
}

// ---------------------------------------------------------------- the cursor

inline F8 powerDifference(const FanBlock& fan, const Splats& x) {
  return ((load(fan.nx) * x.x + load(fan.ny) * x.y) + load(fan.nz) * x.z) + load(fan.c);
}

// The neighbour of least power, if that is less than the node's own; else the node.
inline std::uint32_t lowerNeighbour(const View& view, std::uint32_t node, const Splats& x) {
  const NodeRecord& record = view.nodes[node];
  std::uint32_t best = node;
  float least = 0;
  for (std::uint32_t b = record.fan; b < record.fan + record.fanCount; ++b) {
    const F8 difference = powerDifference(view.fans[b], x);
    if (maskBits(less(difference, set1(least))) == 0) continue;
    float lanes[kLanes];
    store(lanes, difference);
    for (int i = 0; i < kLanes; ++i)
      if (lanes[i] < least) {
        least = lanes[i];
        best = view.fans[b].node[i];
      }
  }
  return best;
}

// Rounding could let two nodes each see less power in the other: never straight back.
// x is the point relative to the node, before and after.
inline std::uint32_t followFrom(const View& view, const D4& point, std::uint32_t node, F4& x) {
  constexpr int kMaxSteps = 256;
  std::uint32_t before = node;
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::uint32_t next = lowerNeighbour(view, node, Splats(x));
    if (next == node || next == before) break;
    before = node;
    node = next;
    x = relative(view.nodes[node], point);
  }
  return node;
}

// ---------------------------------------------------------------- blending

// Neighbours in a fan that a node does not beat by tau: all others have no weight.
inline unsigned rivalsIn(const FanBlock& fan, F8 difference) {
  return maskBits(less(difference * load(fan.inverseTau), set1(1.0f)));
}

// One factor of a node's weight for each neighbour k in a fan, psi((p_node - p_k) / tau) with
// psi(t) = s^3 (6 s^2 - 15 s + 10), s = (1 - t) / 2 in 0 to 1: their product goes to `product`, and
// the gradient of its logarithm is returned after one unused number.
inline F4 weighAgainst(const FanBlock& fan, F8 difference, float& product) {
  const F8 zero = set1(0.0f), one = set1(1.0f), half = set1(0.5f);
  const F8 inverseTau = load(fan.inverseTau);
  const F8 s = min(max(half + half * (difference * inverseTau), zero), one);
  const F8 p = (set1(6.0f) * s - set1(15.0f)) * s + set1(10.0f), sp = s * p, rest = one - s;
  product = productOf((s * s) * sp);
  // (d psi / d s) / psi * ds / d(p_k - p_node)
  const F8 q = (set1(15.0f) * (rest * rest)) * inverseTau / sp;
  return sums(zero, q * load(fan.nx), q * load(fan.ny), q * load(fan.nz));
}

// The nodes that blend at a point: those of non-zero weight that neighbours of non-zero weight lead
// to. So it does not matter from which of them the search starts, which makes seams disappear.
struct ActiveNodes {
  static constexpr unsigned kMost = 24;
  std::uint32_t node[kMost];
  unsigned count = 0;

  void add(std::uint32_t k) {
    for (unsigned i = 0; i < count; ++i)
      if (node[i] == k) return;
    if (count < kMost) node[count++] = k;
  }
};

// The weight u of a node and its gradient, or zero if u is below kLeastWeight. Neighbours that the
// node does not beat by tau are added: all others have no weight.
inline F4 weigh(const View& view, std::uint32_t node, F4 x, ActiveNodes& active) {
  constexpr float kLeastWeight = 1e-20f;
  const NodeRecord& record = view.nodes[node];
  const Splats splats(x);
  float u = 1;
  F4 logarithmic = set4(0.0f);
  for (std::uint32_t b = record.fan; b < record.fan + record.fanCount; ++b) {
    const FanBlock& fan = view.fans[b];
    const F8 difference = powerDifference(fan, splats);
    unsigned rivals = rivalsIn(fan, difference);
    if (rivals == 0) continue;
    float product;
    const F4 part = weighAgainst(fan, difference, product);
    u *= product;
    if (!(u > kLeastWeight)) return set4(0.0f);
    logarithmic = logarithmic + part;
    for (; rivals != 0; rivals &= rivals - 1) active.add(fan.node[__builtin_ctz(rivals)]);
  }
  return withFirst(u, set4(u) * logarithmic);
}

// Sums over nodes of rows of four: u and its gradient; these times (f - f0), where f0 is the first
// node's value, so that models that agree leave only the rounding of their difference; u times f
// and its gradient.
struct Mixture {
  F4 weight = set4(0.0f), excess = set4(0.0f), field = set4(0.0f);
  float f0 = 0, shift = 0, radius = 0;
  bool empty = true;
};

template <int kernel>
inline void addNode(const View& view, std::uint32_t node, F4 x, F4 weight, Mixture& sum) {
  const float u = firstOf(weight);
  if (!(u > 0)) return;
  float shift;
  const FieldNode& at = view.node(node);
  F4 field = evaluateNode<kernel>(view, at, x, shift);
  if (sum.empty) {
    sum.empty = false;
    sum.f0 = firstOf(field);
    sum.shift = shift;
  } else if constexpr (kernel == BLOB_GAUSSIAN) {
    field = field * set4(exponential(sum.shift - shift));
  }
  sum.weight = sum.weight + weight;
  sum.excess = sum.excess + set4(firstOf(field) - sum.f0) * weight;
  sum.field = sum.field + set4(u) * field;
  sum.radius += u * at.place[3];
}

// What a point has before its distance: f and grad f, both times exp(shift), and the radius.
struct Lane {
  F4 field = set4(0.0f);
  float shift = 0, radius = 0;
};

inline Lane quotient(const Mixture& sum) {
  const float inverse = 1.0f / firstOf(sum.weight), excess = firstOf(sum.excess) * inverse;
  const F4 row = (sum.field + (sum.excess - set4(excess) * sum.weight)) * set4(inverse);
  return {withFirst(sum.f0 + excess, row), sum.shift, sum.radius * inverse};
}

template <int kernel>
inline Lane evaluateLocal(const View& view, std::uint32_t node, F4 x) {
  const FieldNode& at = view.node(node);
  Lane lane;
  lane.field = evaluateNode<kernel>(view, at, x, lane.shift);
  lane.radius = at.place[3];
  return lane;
}

// Any number of nodes that blend.
template <int kernel>
LUMEN_NOINLINE Lane blendAll(const View& view, const D4& point, std::uint32_t node, F4 x) {
  ActiveNodes active;
  active.add(node);
  F4 weight = weigh(view, node, x, active);
  Mixture sum;
  addNode<kernel>(view, node, x, weight, sum);
  for (unsigned i = 1; i < active.count; ++i) {
    const std::uint32_t k = active.node[i];
    const F4 xk = relative(view.nodes[k], point);
    const unsigned before = active.count;
    weight = weigh(view, k, xk, active);
    if (firstOf(weight) > 0)
      addNode<kernel>(view, k, xk, weight, sum);
    else
      active.count = before;
  }
  return sum.empty ? evaluateLocal<kernel>(view, node, x) : quotient(sum);
}

// Two nodes that have no rivals but each other, as along a tube: their weights are psi and 1 - psi,
// with sum 1. False if there are more nodes, or if the first has hardly a weight.
template <int kernel>
inline bool blendPair(const View& view, const D4& point, std::uint32_t node, const FanBlock& fan,
                      const float* difference, unsigned rivals, Lane& lane) {
  const int rival = __builtin_ctz(rivals);
  const float inverseTau = fan.inverseTau[rival], t = difference[rival] * inverseTau;
  const NodeRecord& other = view.nodes[fan.node[rival]];
  if (other.fanCount != 1 || !(t > -0.999f)) return false;
  const F4 x = relative(other, point);
  const FanBlock& back = view.fans[other.fan];
  const unsigned beyond = rivalsIn(back, powerDifference(back, Splats(x)));
  if ((beyond & (beyond - 1)) != 0) return false;
  if (beyond != 0 && back.node[__builtin_ctz(beyond)] != node) return false;

  const FieldNode& where = view.node(fan.node[rival]);
  float shift;
  F4 field = evaluateNode<kernel>(view, where, x, shift);
  if constexpr (kernel == BLOB_GAUSSIAN) field = field * set4(exponential(lane.shift - shift));
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s;
  const float psi = (s * s) * s * ((6.0f * s - 15.0f) * s + 10.0f);
  const float slope = (15.0f * ((s * s) * (rest * rest))) * inverseTau;
  const F4 excess = lane.field - field;
  const F4 normal = rowOf(0.0f, fan.nx[rival], fan.ny[rival], fan.nz[rival]);
  lane.field = (field + set4(psi) * excess) + set4(slope * firstOf(excess)) * normal;
  lane.radius = where.place[3] + psi * (lane.radius - where.place[3]);
  return true;
}

// A node's differences of power where it has one fan; else all bits.
inline unsigned rivalsOf(const View& view, std::uint32_t node, const Splats& x, float* difference) {
  const NodeRecord& record = view.nodes[node];
  if (record.fanCount != 1) return ~0U;
  const FanBlock& fan = view.fans[record.fan];
  const F8 differences = powerDifference(fan, x);
  store(difference, differences);
  return rivalsIn(fan, differences);
}

// Adds to a node's own answer what its rivals say.
template <int kernel>
inline void blendLane(const View& view, const D4& point, std::uint32_t node, F4 x,
                      const float* difference, unsigned rivals, Lane& lane) {
  const bool isPair = (rivals & (rivals - 1)) == 0;
  if (isPair && blendPair<kernel>(view, point, node, view.fans[view.nodes[node].fan], difference,
                                  rivals, lane))
    return;
  lane = blendAll<kernel>(view, point, node, x);
}

template <int kernel>
inline Lane evaluateBlended(const View& view, const D4& point, std::uint32_t node, F4 x) {
  Lane lane = evaluateLocal<kernel>(view, node, x);
  float difference[kLanes];
  const unsigned rivals = rivalsOf(view, node, Splats(x), difference);
  if (rivals != 0) blendLane<kernel>(view, point, node, x, difference, rivals, lane);
  return lane;
}
