// SPDX-License-Identifier: Apache-2.0
// The blended field in floats. Include after field.h.
//
// This is the counterpart of formats/field/blend.h for floats and rows of four: a weight's psi over
// eight neighbours is one product of lanes, sums keep f and its gradient in one row, and an
// exponential kernel's f comes with a shift. The choice of the nodes that blend and the polynomial
// of psi are shared. tests/unit/field compares the two.

constexpr float kLeastWeight = 1e-20f;  // a node's weight; less counts as none

// Neighbours in a block that a node does not beat by tau: all others have no weight.
inline unsigned rivalsIn(const NeighbourBlock& block, F8 difference) {
  return maskBits(less(difference * load(block.inverseTau), set1(1.0f)));
}

// Whether a neighbour in a block beats the node by tau, so that it has no weight.
inline bool isBeaten(const NeighbourBlock& block, F8 difference) {
  return maskBits(less(difference * load(block.inverseTau), set1(-1.0f))) != 0;
}

// psi against each neighbour k in a block, at s = (1 + (p_k - p_node) / tau) / 2 in 0 to 1: the
// product goes to `product`, and the gradient of its logarithm is returned after one unused number.
inline F4 weighAgainst(const NeighbourBlock& block, F8 difference, float& product) {
  const F8 zero = set1(0.0f), one = set1(1.0f), half = set1(0.5f);
  const F8 inverseTau = load(block.inverseTau);
  const F8 s = min(max(half + half * (difference * inverseTau), zero), one);
  const F8 sp = s * smoothStepOverCube(s), rest = one - s;
  product = multiplyLanes((s * s) * sp);
  // (d psi / d s) / psi * ds / d(p_k - p_node)
  const F8 q = (set1(15.0f) * (rest * rest)) * inverseTau / sp;
  return sums(zero, q * load(block.nx), q * load(block.ny), q * load(block.nz));
}

// Whether k is a neighbour of a node.
inline bool isNeighbour(const View& view, const NodeRecord& node, std::uint32_t k) {
  const NeighbourBlock* blocks = view.neighbours + node.firstNeighbours;
  for (std::uint32_t b = 0; b < node.neighbourBlocks; ++b) {
    std::uint32_t least = ~0U;  // a minimum is a loop that compilers turn into vectors
    for (const std::uint32_t n : blocks[b].node) least = (n ^ k) < least ? n ^ k : least;
    if (least == 0) return true;
  }
  return false;
}

// The weight u of a node and its gradient, or zero if u is below kLeastWeight. Neighbours that the
// node does not beat by tau are added: all others have no weight. Neither have neighbours of `start`,
// the first node, that it beats by tau, and these are left out; it has added its own rivals itself.
inline F4 weigh(const View& view, std::uint32_t start, std::uint32_t node, F4 x,
                ActiveNodes& active) {
  const NodeRecord& record = view.nodes[node];
  const NeighbourBlock* blocks = view.neighbours + record.firstNeighbours;
  const Splats splats(x);
  float u = 1;
  F4 logarithmic = set4(0.0f);
  for (std::uint32_t b = 0, count = blocksAt(record, x); b < count; ++b) {
    const F8 difference = powerDifference(blocks[b], splats);
    unsigned rivals = rivalsIn(blocks[b], difference);
    if (rivals == 0) continue;
    if (isBeaten(blocks[b], difference)) return set4(0.0f);
    float product;
    const F4 part = weighAgainst(blocks[b], difference, product);
    u *= product;
    if (!(u > kLeastWeight)) return set4(0.0f);
    logarithmic = logarithmic + part;
    for (; rivals != 0; rivals &= rivals - 1) {
      const std::uint32_t k = blocks[b].node[__builtin_ctz(rivals)];
      if (node == start || !isNeighbour(view, view.nodes[start], k)) active.add(k);
    }
  }
  return withFirst(u, set4(u) * logarithmic);
}

// The factors that bring two values of an exponential kernel, each with a shift, to one shift,
// which is left in `first`: the first's own, unless the second, raised to it, could leave the range
// of floats; then the first, which is negligible beside the second, is lowered.
struct Factors {
  float first, second;
};

inline Factors shareShift(float& first, float second) {
  constexpr float kMostRaised = 60;  // exp(60) is 1e26
  const float difference = first - second;
  if (difference <= kMostRaised) return {1.0f, exponential(difference)};
  first = second;
  return {exponential(-difference), 1.0f};
}

// Sums over nodes of rows of four: u and its gradient; these times (f - f0), where f0 is the first
// node's value, so that models that agree leave only the rounding of their difference; u times f
// and its gradient.
struct Mixture {
  F4 weight = set4(0.0f), excess = set4(0.0f), field = set4(0.0f);
  float f0 = 0, shift = 0, radius = 0;
  bool empty = true;
};

// Adds a node's own answer, with a weight above zero.
template <class K>
inline void addAnswer(const Lane& own, F4 weight, Mixture& sum) {
  const float u = firstLane(weight);
  F4 field = own.field;
  if (sum.empty) {
    sum.empty = false;
    sum.f0 = firstLane(field);
    sum.shift = own.shift;
  } else if constexpr (kIsShifted<K>) {
    const Factors factors = shareShift(sum.shift, own.shift);
    sum.f0 *= factors.first;
    sum.excess = sum.excess * set4(factors.first);
    sum.field = sum.field * set4(factors.first);
    field = field * set4(factors.second);
  }
  sum.weight = sum.weight + weight;
  sum.excess = sum.excess + set4(firstLane(field) - sum.f0) * weight;
  sum.field = sum.field + set4(u) * field;
  sum.radius += u * own.radius;
}

inline Lane quotient(const Mixture& sum) {
  const float inverse = 1.0f / firstLane(sum.weight), excess = firstLane(sum.excess) * inverse;
  const F4 row = (sum.field + (sum.excess - set4(excess) * sum.weight)) * set4(inverse);
  return {withFirst(sum.f0 + excess, row), sum.shift, sum.radius * inverse};
}

// Visitor for visitActiveNodes(): adds each node's model to the sum.
template <class K>
struct AddActiveNode {
  const View& view;
  const D4& point;
  std::uint32_t start;
  const Lane& own;  // the answer of `start` alone
  Mixture& sum;

  bool operator()(std::uint32_t k, ActiveNodes& active) const {
    const F4 x = relative(view.nodes[k], point);
    const F4 weight = weigh(view, start, k, x, active);
    if (!(firstLane(weight) > 0)) return false;
    addAnswer<K>(k == start ? own : evaluateLocal<K>(view, k, x), weight, sum);
    return true;
  }
};

// Blends any number of nodes into the answer of one alone.
template <class K>
LUMEN_NOINLINE void blendAll(const View& view, const D4& point, std::uint32_t node, Lane& lane) {
  Mixture sum;
  visitActiveNodes(node, AddActiveNode<K>{view, point, node, lane, sum});
  if (!sum.empty) lane = quotient(sum);
}

constexpr unsigned kManyRivals = ~0U;

// Bits of a node's rivals in its first block, whose differences of power are given; kManyRivals if a
// later block has one.
inline unsigned addLaterRivals(const View& view, const NodeRecord& record, F4 x, unsigned rivals) {
  const std::uint32_t count = blocksAt(record, x);
  if (count == 1) return rivals;
  const NeighbourBlock* blocks = view.neighbours + record.firstNeighbours;
  const Splats at(x);
  for (std::uint32_t b = 1; b < count; ++b)
    if (rivalsIn(blocks[b], powerDifference(blocks[b], at)) != 0) return kManyRivals;
  return rivals;
}

// Bits of a node's rivals, and the differences of power in its first block.
inline unsigned findRivals(const View& view, std::uint32_t node, F4 x, float* difference) {
  const NodeRecord& record = view.nodes[node];
  const NeighbourBlock& block = view.neighbours[record.firstNeighbours];
  const F8 differences = powerDifference(block, Splats(x));
  store(difference, differences);
  return addLaterRivals(view, record, x, rivalsIn(block, differences));
}

// Kinds of a node with one rival: the rival has no rivals but the node, as along a tube; its others
// are neighbours of the node, and so have no weight; or more nodes may blend.
enum class PairKind : std::uint8_t { Alone, Two, Several };

// `back`: the rival's first block of neighbours; t: the difference of powers over tau.
inline PairKind kindOfPair(const View& view, std::uint32_t node, const NeighbourBlock& back,
                           unsigned rivals, float t) {
  constexpr float kLeastDifference = -0.999f;
  if (rivals == kManyRivals || !(t > kLeastDifference)) return PairKind::Several;
  if ((rivals & (rivals - 1)) == 0 && (rivals == 0 || back.node[__builtin_ctz(rivals)] == node))
    return PairKind::Alone;
  for (; rivals != 0; rivals &= rivals - 1) {
    const std::uint32_t k = back.node[__builtin_ctz(rivals)];
    if (k != node && !isNeighbour(view, view.nodes[node], k)) return PairKind::Several;
  }
  return PairKind::Two;
}

// Mixes the answers of a node and its rival whose weights are psi and 1 - psi.
template <class K>
inline void mixPair(const NeighbourBlock& block, int rival, float t, const Lane& other,
                    Lane& lane) {
  F4 field = other.field;
  if constexpr (kIsShifted<K>) {
    const Factors factors = shareShift(lane.shift, other.shift);
    lane.field = lane.field * set4(factors.first);
    field = field * set4(factors.second);
  }
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s;
  const float psi = smoothStep(s);
  const float slope = (15.0f * ((s * s) * (rest * rest))) * block.inverseTau[rival];
  const F4 excess = lane.field - field;
  const F4 normal = makeRow(0.0f, block.nx[rival], block.ny[rival], block.nz[rival]);
  // 1 - psi is psi(1 - s); where the node's own model has vanished, f is what is left of the other
  const F4 mean = kIsShifted<K> ? set4(psi) * lane.field + set4(smoothStep(rest)) * field
                                : field + set4(psi) * excess;
  lane.field = mean + set4(slope * firstLane(excess)) * normal;
  lane.radius = other.radius + psi * (lane.radius - other.radius);
}

// Mixes the answers of a node and its rival, which has other rivals, too, at these differences.
template <class K>
inline void mixTwo(const NeighbourBlock& block, int rival, float t, const NeighbourBlock& back,
                   F8 difference, const Lane& other, Lane& lane) {
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s, sp = s * smoothStepOverCube(s);
  const float u = (s * s) * sp, q = (15.0f * (rest * rest)) * block.inverseTau[rival] / sp;
  const F4 normal = makeRow(0.0f, block.nx[rival], block.ny[rival], block.nz[rival]);
  Mixture sum;
  addAnswer<K>(lane, withFirst(u, set4(u) * (set4(q) * normal)), sum);
  float product;
  const F4 part = weighAgainst(back, difference, product);
  if (product > kLeastWeight) addAnswer<K>(other, withFirst(product, set4(product) * part), sum);
  lane = quotient(sum);
}

// Blends the models of a node's rivals into the node's own answer.
template <class K>
inline void blendLane(const View& view, const D4& point, std::uint32_t node,
                      const float* difference, unsigned rivals, Lane& lane) {
  if ((rivals & (rivals - 1)) != 0) return blendAll<K>(view, point, node, lane);
  const NeighbourBlock& block = view.neighbours[view.nodes[node].firstNeighbours];
  const int rival = __builtin_ctz(rivals);
  const float t = difference[rival] * block.inverseTau[rival];
  const std::uint32_t k = block.node[rival];
  const NeighbourBlock& back = view.neighbours[view.nodes[k].firstNeighbours];
  const F4 x = relative(view.nodes[k], point);
  const F8 differences = powerDifference(back, Splats(x));
  const unsigned rivalsOfRival =
      addLaterRivals(view, view.nodes[k], x, rivalsIn(back, differences));
  switch (kindOfPair(view, node, back, rivalsOfRival, t)) {
    case PairKind::Alone:
      return mixPair<K>(block, rival, t, evaluateLocal<K>(view, k, x), lane);
    case PairKind::Two:
      return mixTwo<K>(block, rival, t, back, differences, evaluateLocal<K>(view, k, x), lane);
    case PairKind::Several:
      return blendAll<K>(view, point, node, lane);
  }
}

template <class K>
inline Lane evaluateBlended(const View& view, const D4& point, std::uint32_t node, F4 x) {
  Lane lane = evaluateLocal<K>(view, node, x);
  float difference[kLanes];
  const unsigned rivals = findRivals(view, node, x, difference);
  if (rivals != 0) blendLane<K>(view, point, node, difference, rivals, lane);
  return lane;
}
