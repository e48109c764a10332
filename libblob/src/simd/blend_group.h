// SPDX-License-Identifier: Apache-2.0
// Blending of up to eight points at once. Include after blend.h and wall_distance.h.
//
// Most points have one rival. Their steps are loops of their own without branches, so that the work
// at one point overlaps with that at the others: in one loop the processor would often mispredict
// which kind of blending comes next.

// Number of points processed side by side, so that one's chain of operations fills the pauses of
// another's: the processor does not look far enough ahead to find the next point by itself.
constexpr std::size_t kTogether = 4;

// Evaluates the models of four nodes of one block each. `at`: the points relative to the nodes, which
// get the nodes' radii as fourth numbers.
template <class K>
inline void evaluateTogether(const View& view, const std::uint32_t* nodes, float (*at)[4],
                             float (*field)[4], float* shift) {
  Terms terms[kTogether];
  for (std::size_t k = 0; k < kTogether; ++k) {
    const FieldNode& node = view.fieldNode(nodes[k]);
    const Splats x(at[k]);
    const BlobBlock& block = view.blocks[node.block];
    shift[k] = kIsShifted<K> ? leastExponent(&block, 1, x) : 0.0f;
    terms[k] = computeTerms<K>(block, x, shift[k]);
    at[k][3] = node.place[3];
  }
  for (std::size_t k = 0; k < kTogether; ++k)
    store4(field[k], sums(terms[k].f, terms[k].x, terms[k].y, terms[k].z));
}

// Points with one rival, and that rival's own answers.
struct alignas(32) Seconds {
  float difference[kLanes][kLanes];  ///< of power at the rival, in its first block
  float at[kLanes][4], field[kLanes][4], shift[kLanes];
  std::uint32_t node[kLanes];
  std::uint32_t lane[kLanes];  ///< of the point
  unsigned rivals[kLanes];     ///< findRivals() of the rival
  float t[kLanes];             ///< difference of powers over tau
  std::size_t count = 0;
};

// Lists the points of a group with one rival, and finds the rivals of those.
inline void placeSeconds(const View& view, const Inputs& in, const Group& g, unsigned single,
                         Seconds& s) {
  for (; single != 0; single &= single - 1)
    s.lane[s.count++] = static_cast<std::uint32_t>(__builtin_ctz(single));
  for (std::size_t n = 0; n < s.count; ++n) {
    const std::uint32_t i = s.lane[n];
    const NeighbourBlock& block = view.neighbours[view.nodes[in.node[i]].firstNeighbours];
    const int rival = __builtin_ctz(g.rivals[i]);
    s.t[n] = g.difference[i][rival] * block.inverseTau[rival];
    s.node[n] = block.node[rival];
    const NodeRecord& other = view.nodes[s.node[n]];
    const F4 x = relative(other, load4(in.point[i]));
    store4(s.at[n], x);
    const NeighbourBlock& back = view.neighbours[other.firstNeighbours];
    const F8 difference = powerDifference(back, Splats(x));
    store(s.difference[n], difference);
    s.rivals[n] = addLaterRivals(view, other, x, rivalsIn(back, difference));
  }
}

template <class K>
inline void evaluateSeconds(const View& view, Seconds& s) {
  std::size_t n = 0;
  unsigned simple = 1;
  for (std::size_t k = 0; k < s.count; ++k) simple &= view.fieldNode(s.node[k]).isSimple;
  if (simple != 0) {
    // the rest of the last four repeats its first
    for (std::size_t k = s.count; k % kTogether != 0; ++k) {
      s.node[k] = s.node[0];
      std::memcpy(s.at[k], s.at[0], sizeof s.at[k]);
    }
    for (; n < s.count; n += kTogether)
      evaluateTogether<K>(view, s.node + n, s.at + n, s.field + n, s.shift + n);
    return;
  }
  for (; n < s.count; ++n) {
    const Lane lane = evaluateLocal<K>(view, s.node[n], load4(s.at[n]));
    store4(s.field[n], lane.field);
    s.shift[n] = lane.shift;
    s.at[n][3] = lane.radius;
  }
}

// Blends the points of a group that have rivals.
template <class K>
LUMEN_NOINLINE void blendGroup(const View& view, std::size_t count, unsigned outOfRange,
                               const Inputs& in, Group& g) {
  unsigned single = 0, several = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned rivals = g.rivals[i], isSeveral = (rivals & (rivals - 1)) != 0 ? 1U : 0U;
    single |= (rivals != 0 ? 1U - isSeveral : 0U) << i;
    several |= (rivals != 0 ? isSeveral : 0U) << i;
  }
  single &= ~outOfRange;
  several &= ~outOfRange;
  Seconds s;
  placeSeconds(view, in, g, single, s);
  evaluateSeconds<K>(view, s);
  unsigned pairs = 0, twos = 0;
  for (std::size_t n = 0; n < s.count; ++n) {
    const std::uint32_t i = s.lane[n];
    const NodeRecord& other = view.nodes[s.node[n]];
    const NeighbourBlock& back = view.neighbours[other.firstNeighbours];
    const PairKind kind = kindOfPair(view, in.node[i], back, s.rivals[n], s.t[n]);
    pairs |= (kind == PairKind::Alone ? 1U : 0U) << n;
    twos |= (kind == PairKind::Two ? 1U : 0U) << n;
    several |= (kind == PairKind::Several ? 1U : 0U) << i;
  }
  for (; pairs != 0; pairs &= pairs - 1) {
    const auto n = static_cast<std::size_t>(__builtin_ctz(pairs));
    const std::uint32_t i = s.lane[n];
    Lane lane{load4(g.field[i]), g.shift[i], g.at[i][3]};
    mixPair<K>(view.neighbours[view.nodes[in.node[i]].firstNeighbours], __builtin_ctz(g.rivals[i]),
               s.t[n], {load4(s.field[n]), s.shift[n], s.at[n][3]}, lane);
    keep(lane, g, i);
  }
  for (; twos != 0; twos &= twos - 1) {
    const auto n = static_cast<std::size_t>(__builtin_ctz(twos));
    const std::uint32_t i = s.lane[n];
    Lane lane{load4(g.field[i]), g.shift[i], g.at[i][3]};
    mixTwo<K>(view.neighbours[view.nodes[in.node[i]].firstNeighbours], __builtin_ctz(g.rivals[i]),
              s.t[n], view.neighbours[view.nodes[s.node[n]].firstNeighbours], load(s.difference[n]),
              {load4(s.field[n]), s.shift[n], s.at[n][3]}, lane);
    keep(lane, g, i);
  }
  for (; several != 0; several &= several - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(several));
    Lane lane{load4(g.field[i]), g.shift[i], g.at[i][3]};
    blendAll<K>(view, load4(in.point[i]), in.node[i], lane);
    keep(lane, g, i);
  }
}
