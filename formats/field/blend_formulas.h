// SPDX-License-Identifier: Apache-2.0
// The nodes that blend, and the polynomial that weighs them. Text to be included inside a
// namespace,
// as kernel_formulas.h is.

/// S(s) / s^3 of the smooth step S(s) = s^3 (6 s^2 - 15 s + 10), which rises from 0 to 1 between
/// s = 0 and s = 1 with two continuous derivatives.
template <class T>
[[gnu::always_inline]] inline T smoothStepOverCube(T s) {
  return (constant(s, 6.0) * s - constant(s, 15.0)) * s + constant(s, 10.0);
}

/// The weight psi of a node against one neighbour at s = (1 + t) / 2 in 0 to 1, where t is the
/// neighbour's power less the node's, over the pair's width tau.
template <class T>
[[gnu::always_inline]] inline T smoothStep(T s) {
  return s * s * s * smoothStepOverCube(s);
}

/// Nodes that blend at a point, in the order in which they were found. Nodes after the first
/// kMostActive are left out.
struct ActiveNodes {
  static constexpr unsigned kMostActive = 24;
  std::uint32_t node[kMostActive];
  unsigned count = 0;

  void add(std::uint32_t k) {
    for (unsigned i = 0; i < count; ++i)
      if (node[i] == k) return;
    if (count < kMostActive) node[count++] = k;
  }
};

/// Visits the nodes that blend: `start`, and the nodes that others of non-zero weight lead to.
/// visit(k, active) adds the neighbours that k does not beat by tau, all others having no weight
/// beside it, and returns whether k itself has a weight; if not, its neighbours are dropped again.
/// So the result is the same from each of the nodes that blend, which makes seams disappear.
template <class Visit>
inline void visitActiveNodes(std::uint32_t start, Visit&& visit) {
  ActiveNodes active;
  active.add(start);
  for (unsigned i = 0; i < active.count; ++i) {
    const unsigned before = active.count;
    if (!visit(active.node[i], active)) active.count = before;
  }
}
