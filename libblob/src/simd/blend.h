// SPDX-License-Identifier: Apache-2.0
// The blended field in floats. Include after field.h.
//
// This is the counterpart of formats/field/blend.h for floats and rows of four: a weight's psi over
// eight neighbours is one product of lanes, sums keep f and its gradient in one row, and an
// exponential kernel's f comes with a shift. The choice of the nodes that blend and the polynomial
// of psi are shared. tests/unit/field compares the two.

// Neighbours in a block that a node does not beat by tau: all others have no weight.
inline unsigned rivalsIn(const NeighbourBlock& block, F8 difference) {
  return maskBits(less(difference * load(block.inverseTau), set1(1.0f)));
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

// The weight u of a node and its gradient, or zero if u is below kLeastWeight. Neighbours that the
// node does not beat by tau are added: all others have no weight.
inline F4 weigh(const View& view, std::uint32_t node, F4 x, ActiveNodes& active) {
  constexpr float kLeastWeight = 1e-20f;
  const NodeRecord& record = view.nodes[node];
  const NeighbourBlock* blocks = view.neighbours + record.firstNeighbours;
  const Splats splats(x);
  float u = 1;
  F4 logarithmic = set4(0.0f);
  for (std::uint32_t b = 0; b < record.neighbourBlocks; ++b) {
    const F8 difference = powerDifference(blocks[b], splats);
    unsigned rivals = rivalsIn(blocks[b], difference);
    if (rivals == 0) continue;
    float product;
    const F4 part = weighAgainst(blocks[b], difference, product);
    u *= product;
    if (!(u > kLeastWeight)) return set4(0.0f);
    logarithmic = logarithmic + part;
    for (; rivals != 0; rivals &= rivals - 1) active.add(blocks[b].node[__builtin_ctz(rivals)]);
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

template <class K>
inline void addNode(const View& view, std::uint32_t node, F4 x, F4 weight, Mixture& sum) {
  const float u = firstLane(weight);
  if (!(u > 0)) return;
  float shift;
  const FieldNode& at = view.fieldNode(node);
  F4 field = evaluateNode<K>(view, at, x, shift);
  if (sum.empty) {
    sum.empty = false;
    sum.f0 = firstLane(field);
    sum.shift = shift;
  } else if constexpr (kIsShifted<K>) {
    const Factors factors = shareShift(sum.shift, shift);
    sum.f0 *= factors.first;
    sum.excess = sum.excess * set4(factors.first);
    sum.field = sum.field * set4(factors.first);
    field = field * set4(factors.second);
  }
  sum.weight = sum.weight + weight;
  sum.excess = sum.excess + set4(firstLane(field) - sum.f0) * weight;
  sum.field = sum.field + set4(u) * field;
  sum.radius += u * at.place[3];
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
  Mixture& sum;

  bool operator()(std::uint32_t k, ActiveNodes& active) const {
    const F4 x = relative(view.nodes[k], point);
    const F4 weight = weigh(view, k, x, active);
    addNode<K>(view, k, x, weight, sum);
    return firstLane(weight) > 0;
  }
};

// Blends any number of nodes.
template <class K>
LUMEN_NOINLINE Lane blendAll(const View& view, const D4& point, std::uint32_t node, F4 x) {
  Mixture sum;
  visitActiveNodes(node, AddActiveNode<K>{view, point, sum});
  return sum.empty ? evaluateLocal<K>(view, node, x) : quotient(sum);
}

// Blends two nodes that have no rivals but each other, as along a tube: their weights are psi and 1
// - psi,
// with sum 1. False if there are more nodes, or if the first has hardly a weight.
template <class K>
inline bool blendPair(const View& view, const D4& point, std::uint32_t node,
                      const NeighbourBlock& block, const float* difference, unsigned rivals,
                      Lane& lane) {
  constexpr float kLeastDifference = -0.999f;  // difference of powers over tau
  const int rival = __builtin_ctz(rivals);
  const float inverseTau = block.inverseTau[rival], t = difference[rival] * inverseTau;
  const NodeRecord& other = view.nodes[block.node[rival]];
  if (other.neighbourBlocks != 1 || !(t > kLeastDifference)) return false;
  const F4 x = relative(other, point);
  const NeighbourBlock& back = view.neighbours[other.firstNeighbours];
  const unsigned beyond = rivalsIn(back, powerDifference(back, Splats(x)));
  if ((beyond & (beyond - 1)) != 0) return false;
  if (beyond != 0 && back.node[__builtin_ctz(beyond)] != node) return false;

  const FieldNode& where = view.fieldNode(block.node[rival]);
  float shift;
  F4 field = evaluateNode<K>(view, where, x, shift);
  if constexpr (kIsShifted<K>) {
    const Factors factors = shareShift(lane.shift, shift);
    lane.field = lane.field * set4(factors.first);
    field = field * set4(factors.second);
  }
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s;
  const float psi = smoothStep(s);
  const float slope = (15.0f * ((s * s) * (rest * rest))) * inverseTau;
  const F4 excess = lane.field - field;
  const F4 normal = makeRow(0.0f, block.nx[rival], block.ny[rival], block.nz[rival]);
  lane.field = (field + set4(psi) * excess) + set4(slope * firstLane(excess)) * normal;
  lane.radius = where.place[3] + psi * (lane.radius - where.place[3]);
  return true;
}

// Bits of a node's rivals, and its differences of power, if it has one block of neighbours; else
// all bits.
inline unsigned findRivals(const View& view, std::uint32_t node, const Splats& x,
                           float* difference) {
  const NodeRecord& record = view.nodes[node];
  if (record.neighbourBlocks != 1) return ~0U;
  const NeighbourBlock& block = view.neighbours[record.firstNeighbours];
  const F8 differences = powerDifference(block, x);
  store(difference, differences);
  return rivalsIn(block, differences);
}

// Blends the models of a node's rivals into the node's own answer.
template <class K>
inline void blendLane(const View& view, const D4& point, std::uint32_t node, F4 x,
                      const float* difference, unsigned rivals, Lane& lane) {
  const bool isPair = (rivals & (rivals - 1)) == 0;
  if (isPair && blendPair<K>(view, point, node, view.neighbours[view.nodes[node].firstNeighbours],
                             difference, rivals, lane))
    return;
  lane = blendAll<K>(view, point, node, x);
}

template <class K>
inline Lane evaluateBlended(const View& view, const D4& point, std::uint32_t node, F4 x) {
  Lane lane = evaluateLocal<K>(view, node, x);
  float difference[kLanes];
  const unsigned rivals = findRivals(view, node, Splats(x), difference);
  if (rivals != 0) blendLane<K>(view, point, node, x, difference, rivals, lane);
  return lane;
}
