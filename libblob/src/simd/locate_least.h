// SPDX-License-Identifier: Apache-2.0
// The search for the node of least power. Include after numbers.h.
//
// Boxes and nodes are compared in floats, with a margin for all roundings; nodes that the margin
// leaves are compared in doubles, so the answer is that of a search in doubles.

struct Best {
  double power;
  std::uint32_t node = BLOB_NOWHERE;

  void add(double other, std::uint32_t k) {
    if (other < power || (other == power && k < node)) {
      power = other;
      node = k;
    }
  }
};

// |X - O|^2 - r^2, mm^2.
inline double powerAt(const double* point, double x, double y, double z, float radius) {
  const double dx = point[0] - x, dy = point[1] - y, dz = point[2] - z;
  return ((dx * dx + dy * dy) + dz * dz) - double{radius} * double{radius};
}

// A point in floats, which are wrong by up to 2^-24 of the greatest coordinate each. A square s of a
// distance is so wrong by less than kRelative s + slack, and a power by no more than that of s + r^2.
struct RoundedPoint {
  explicit RoundedPoint(const double* p)
      : x(set1(static_cast<float>(p[0]))),
        y(set1(static_cast<float>(p[1]))),
        z(set1(static_cast<float>(p[2]))) {
    float greatest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float size = static_cast<float>(p[axis] < 0 ? -p[axis] : p[axis]);
      greatest = size > greatest ? size : greatest;
    }
    const float error = 1.2e-7f * greatest;
    slack = set1(kShare * (error * error) + kLeastSlack);
  }
  static constexpr float kRelative = 8e-6f, kShare = 1e6f;  // 2 e d <= 3e-6 d^2 + e^2 / 3e-6
  static constexpr float kLeastSlack = 1e-30f;              // mm^2, so that equals are not left out
  F8 x, y, z, slack;
};

// Tests the nodes of a leaf that may have least power.
inline void visitLeaf(const LocateLeaf& leaf, const double* p, const RoundedPoint& at, Best& best) {
  const F8 x = at.x - load(leaf.centre[0]), y = at.y - load(leaf.centre[1]),
           z = at.z - load(leaf.centre[2]), radius = load(leaf.radius);
  const F8 square = (x * x + y * y) + z * z, r2 = radius * radius;
  const F8 power = square - r2, margin = set1(at.kRelative) * (square + r2) + at.slack;
  const float least = leastLane(power + margin), known = static_cast<float>(best.power);
  const F8 limit = set1(least < known ? least : known);
  for (unsigned left = maskBits(less(power - margin, limit)); left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    best.add(powerAt(p, double{leaf.centre[0][i]}, double{leaf.centre[1][i]},
                     double{leaf.centre[2][i]}, leaf.radius[i]),
             leaf.node[i]);
  }
}

// Lower bounds on the power of the nodes in each child; greater than all powers without a child.
inline F8 boundChildren(const LocateBlock& block, const RoundedPoint& at) {
  const F8 zero = set1(0.0f), *point[3] = {&at.x, &at.y, &at.z};
  F8 square = zero;
  for (int axis = 0; axis < 3; ++axis) {
    const F8 p = *point[axis];
    const F8 outside = max(max(load(block.low[axis]) - p, p - load(block.high[axis])), zero);
    square = square + outside * outside;
  }
  const F8 radius = load(block.radius);
  return (set1(1.0f - at.kRelative) * square - set1(1.0f + at.kRelative) * (radius * radius)) -
         at.slack;
}

// The node of least power by a look at each.
LUMEN_NOINLINE std::uint32_t locateByScan(const blob_model& model, const double* point) {
  Best best{std::numeric_limits<double>::infinity()};
  for (std::uint32_t i = 0; i < model.nodes.size(); ++i) {
    const NodeRecord& node = model.nodes[i];
    best.add(powerAt(point, node.centre[0], node.centre[1], node.centre[2], node.radius()), i);
  }
  // a point so far away that every square overflows
  return best.node == BLOB_NOWHERE ? 0 : best.node;
}

// The path from a root to a leaf: for each block on it the bounds of its children, and those of
// them that have not been visited.
class LocatePath {
public:
  LocatePath(const LocateTree& tree, const double* point)
      : m_tree(tree),
        m_at(point),
        m_point(point),
        m_top(static_cast<std::uint32_t>(tree.levels.size())),
        m_roots(static_cast<std::uint32_t>(tree.levels.back().size())) {}

  std::uint32_t findNode() {
    std::uint32_t first = m_top;
    float least = kFarAway;
    for (std::uint32_t root = 0; root < m_roots; ++root) {
      const float bound = leastLane(enter(m_top + root, root));
      if (bound < least) first = m_top + root;
      least = bound < least ? bound : least;
    }
    descend(first, leastChild(load(m_step[first].bound)));
    // steps are numbered from the leaf up, the roots last
    for (std::uint32_t step = 1; step < m_top + m_roots;) {
      const F8 limit = set1(static_cast<float>(m_best.power));
      const unsigned open = maskBits(less(load(m_step[step].bound), limit)) & m_step[step].left;
      if (open == 0) {
        ++step;
        continue;
      }
      descend(step, __builtin_ctz(open));
      step = 1;
    }
    return m_best.node;
  }

private:
  static constexpr double kMostPower = 1e30;  // mm^2: above that of nodes, below that of padding
  static constexpr int kMostLevels = 8;       // 2^24 nodes

  struct Step {
    float bound[kLanes];
    std::uint32_t block, left;
  };

  // Bounds of the children of a block, which becomes a step of the path.
  F8 enter(std::uint32_t step, std::uint32_t block) {
    const std::uint32_t level = step < m_top ? step : m_top;
    const F8 bound = boundChildren(m_tree.levels[level - 1][block], m_at);
    store(m_step[step].bound, bound);
    m_step[step].block = block;
    m_step[step].left = (1U << kLanes) - 1U;
    return bound;
  }

  static int leastChild(F8 bound) {
    return __builtin_ctz(~maskBits(less(set1(leastLane(bound)), bound)));
  }

  // Goes to a child, and on to the nearest of each block, to a leaf.
  void descend(std::uint32_t step, int child) {
    for (std::uint32_t level = step < m_top ? step : m_top;;) {
      m_step[step].left &= ~(1U << child);
      const std::uint32_t next = m_step[step].block * kLanes + static_cast<std::uint32_t>(child);
      if (--level == 0) return visitLeaf(m_tree.leaves[next], m_point, m_at, m_best);
      step = level;
      child = leastChild(enter(step, next));
    }
  }

  const LocateTree& m_tree;
  RoundedPoint m_at;
  const double* m_point;
  std::uint32_t m_top, m_roots;
  Best m_best{kMostPower};
  Step m_step[kMostLevels + 1 + LocateTree::kMostRoots];
};

// The node of least power, the lowest index among equals. The point is finite.
inline std::uint32_t locateLeast(const blob_model& model, const double* point) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(point[axis] > -kFarthestMm && point[axis] < kFarthestMm))
      return locateByScan(model, point);
  return LocatePath(model.locate, point).findNode();
}
