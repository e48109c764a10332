// SPDX-License-Identifier: Apache-2.0
// One node's model, and the cursor's step. Include after the formulas.

// The data that a query reads.
struct View {
  explicit View(const blob_model& m)
      : nodes(m.nodes.data()),
        neighbours(m.neighbours.data()),
        blocks(m.field.blocks.data()),
        nodeCount(m.nodes.size()),
        level(static_cast<float>(m.field.isoLevel)),
        transformedLevel(static_cast<float>(m.field.transformedLevel)),
        model(m) {}
  [[nodiscard]] const FieldNode& fieldNode(std::uint32_t i) const { return nodes[i].field; }
  const NodeRecord* nodes;
  const NeighbourBlock* neighbours;
  const BlobBlock* blocks;
  std::size_t nodeCount;
  float level, transformedLevel;
  const blob_model& model;
};

// A point relative to a node's centre; the fourth number is of any value.
inline F4 relative(const NodeRecord& node, const D4& point) {
  return subtractToFloat(point, load4(node.centre));
}

// A row's first three numbers, each in all lanes.
struct Splats {
  explicit Splats(F4 row) : x(splat<0>(row)), y(splat<1>(row)), z(splat<2>(row)) {}
  explicit Splats(const float* row) : x(set1(row[0])), y(set1(row[1])), z(set1(row[2])) {}
  F8 x, y, z;
};

// ---------------------------------------------------------------- one model

// Whether f of a kernel comes times exp(shift), since it underflows where a distance is still
// wanted.
template <class K>
constexpr bool kIsShifted = K::kTail == KernelTail::Exponential;

struct Offsets {
  F8 x, y, z, u;
};

inline Offsets computeOffsets(const BlobBlock& block, const Splats& at) {
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
    const F8 u = computeOffsets(blocks[b], at).u;
    least = min(select(less(set1(0.0f), load(blocks[b].w)), u, set1(3e38f)), least);
  }
  return leastLane(least);
}

// The parts of eight blobs in f and grad f.
struct Terms {
  F8 f, x, y, z;
};

// Terms of a block. Padding is no nearer than the nearest blob: else its exponential could be
// infinite, and NaN times a width of zero.
template <class K>
inline Terms computeTerms(const BlobBlock& block, const Splats& at, float shift) {
  Offsets d = computeOffsets(block, at);
  if constexpr (kIsShifted<K>) d.u = max(d.u - set1(shift), set1(0.0f));
  const BlobTerm<F8> term = K::term(d.u, load(block.a), load(block.w));
  return {term.value, term.slope * d.x, term.slope * d.y, term.slope * d.z};
}

// f, then grad f.
template <class K>
inline F4 sumBlocks(const BlobBlock* blocks, std::uint32_t count, const Splats& at, float shift) {
  if (count == 0) return set4(0.0f);
  Terms sum = computeTerms<K>(blocks[0], at, shift);
  for (std::uint32_t b = 1; b < count; ++b) {
    const Terms next = computeTerms<K>(blocks[b], at, shift);
    sum.f = sum.f + next.f;
    sum.x = sum.x + next.x;
    sum.y = sum.y + next.y;
    sum.z = sum.z + next.z;
  }
  return sums(sum.f, sum.x, sum.y, sum.z);
}

// f and grad f of one node's model at x, relative to the node's centre.
template <class K>
inline F4 evaluateNode(const View& view, const FieldNode& node, F4 x, float& shift) {
  const BlobBlock* blocks = view.blocks + node.block;
  const Splats at(x + load4(node.place));
  shift = 0;
  if constexpr (kIsShifted<K>)
    if (node.blockCount > 0) shift = leastExponent(blocks, node.blockCount, at);
  return sumBlocks<K>(blocks, node.blockCount, at, shift);
}

// A point before its distance: f and grad f, both times exp(shift), and the radius.
struct Lane {
  F4 field = set4(0.0f);
  float shift = 0, radius = 0;
};

template <class K>
inline Lane evaluateLocal(const View& view, std::uint32_t node, F4 x) {
  const FieldNode& at = view.fieldNode(node);
  Lane lane;
  lane.field = evaluateNode<K>(view, at, x, lane.shift);
  lane.radius = at.place[3];
  return lane;
}

// ---------------------------------------------------------------- the cursor

inline F8 powerDifference(const NeighbourBlock& block, const Splats& x) {
  return ((load(block.nx) * x.x + load(block.ny) * x.y) + load(block.nz) * x.z) + load(block.c);
}

// Number of a node's blocks of neighbours that count at x, relative to it: those of later blocks are
// beaten by tau within the quiet distance.
inline std::uint32_t blocksAt(const NodeRecord& node, F4 x) {
  if (node.neighbourBlocks == 1) return 1;
  float at[4];
  store4(at, x);
  const float square = (at[0] * at[0] + at[1] * at[1]) + at[2] * at[2];
  return static_cast<double>(square) < node.quietSquare() ? 1 : node.neighbourBlocks;
}

// The neighbour of least power, if that is less than the node's own, the first of equals; else the
// node.
inline std::uint32_t lowerNeighbour(const View& view, std::uint32_t node, F4 x) {
  const NodeRecord& record = view.nodes[node];
  const NeighbourBlock* blocks = view.neighbours + record.firstNeighbours;
  const Splats at(x);
  std::uint32_t best = node;
  float least = 0;
  for (std::uint32_t b = 0, count = blocksAt(record, x); b < count; ++b) {
    const F8 difference = powerDifference(blocks[b], at);
    if (maskBits(less(difference, set1(0.0f))) == 0) continue;
    float lanes[kLanes];
    store(lanes, difference);
    for (int i = 0; i < kLanes; ++i)
      if (lanes[i] < least || (lanes[i] == least && best != node && blocks[b].node[i] < best)) {
        least = lanes[i];
        best = blocks[b].node[i];
      }
  }
  return best;
}

// The walk never steps straight back: by rounding, two nodes could each see less power in the
// other.
// x is the point relative to the node, before and after.
inline std::uint32_t followFrom(const View& view, const D4& point, std::uint32_t node, F4& x) {
  constexpr int kMaxSteps = 256;
  std::uint32_t before = node;
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::uint32_t next = lowerNeighbour(view, node, x);
    if (next == node || next == before) break;
    before = node;
    node = next;
    x = relative(view.nodes[node], point);
  }
  return node;
}
