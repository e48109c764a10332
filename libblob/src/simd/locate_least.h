// SPDX-License-Identifier: Apache-2.0
// The search for the node of least power, in plain loops that compilers turn into vectors. Include
// inside a namespace.

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Best {
  double power = kInfinity;
  std::uint32_t node = BLOB_NOWHERE;
};

inline void visitLeaf(const LocateLeaf& leaf, const double* p, Best& best) {
  double power[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const double x = p[0] - leaf.centre[0][i], y = p[1] - leaf.centre[1][i],
                 z = p[2] - leaf.centre[2][i];
    power[i] = ((x * x + y * y) + z * z) - leaf.radius2[i];
  }
  for (int i = 0; i < kLanes; ++i)
    if (power[i] < best.power || (power[i] == best.power && leaf.node[i] < best.node))
      best = {power[i], leaf.node[i]};
}

// Lower bounds on the power of the nodes in each child.
inline void boundChildren(const LocateBlock& block, const double* p, double* bound) {
  double square[kLanes] = {};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < kLanes; ++i) {
      const double below = block.low[axis][i] - p[axis], above = p[axis] - block.high[axis][i];
      const double d = below > above ? below : above, outside = d > 0.0 ? d : 0.0;
      square[i] += outside * outside;
    }
  for (int i = 0; i < kLanes; ++i)
    bound[i] = square[i] * (1.0 - kLoose) - block.radius2[i] * (1.0 + kLoose);
}

struct Pending {
  double bound;
  std::uint32_t level, block;  // level 0: a leaf
};

// The node of least power, the lowest index among equals. The point is finite.
inline std::uint32_t locateLeast(const blob_model& model, const double* point) {
  // 2^24 nodes make 8 levels, each of which leaves at most 7 blocks pending.
  constexpr int kMaxPending = 80;
  const LocateTree& tree = model.locate;
  Pending stack[kMaxPending];
  int size = 0;
  stack[size++] = {-kInfinity, static_cast<std::uint32_t>(tree.levels.size()), 0};
  Best best;
  while (size > 0) {
    const Pending next = stack[--size];
    if (next.bound > best.power) continue;
    if (next.level == 0) {
      visitLeaf(tree.leaves[next.block], point, best);
      continue;
    }
    double bound[kLanes];
    boundChildren(tree.levels[next.level - 1][next.block], point, bound);
    // the nearest child goes on top
    const int first = size;
    for (int i = 0; i < kLanes; ++i) {
      if (!(bound[i] <= best.power) || bound[i] == kInfinity) continue;
      int place = size++;
      for (; place > first && stack[place - 1].bound < bound[i]; --place)
        stack[place] = stack[place - 1];
      stack[place] = {bound[i], next.level - 1,
                      next.block * kLanes + static_cast<std::uint32_t>(i)};
    }
  }
  // a point so far away that every square overflows
  return best.node == BLOB_NOWHERE ? 0 : best.node;
}
