// SPDX-License-Identifier: Apache-2.0
// The field of a case as spec/lumen.md defines it, in doubles: the source of meshes and
// measurements, and the reference for libblob, which computes it in floats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/field/blend.h"
#include "formats/field/neighbourhood.h"
#include "formats/field/tree_view.h"
#include "formats/field/vector.h"

namespace lumen::field {

/// The local field of every node and their blend. Points are in mm, LPS; f is in mm. Immutable
/// after construction: any number of threads may query it. Gives the same bits on every machine.
class BlendedField {
public:
  /// Copies the nodes and models. O(n) for n nodes.
  BlendedField(const TreeView& tree, const ModelsView& models);

  [[nodiscard]] std::size_t nodeCount() const { return m_nodes.size(); }
  /// T: the lumen is f > T, mm.
  [[nodiscard]] double level() const { return m_level; }
  [[nodiscard]] Kernel kernel() const { return m_kernel; }

  /// The nodes that a cursor at `node` may step to, and whose models may blend with its own;
  /// ascending.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t node) const;

  /// The node whose blobs answer for `node`: itself, or the nearest along the tree that has some;
  /// kNowhere if its connected component has none, so that f = 0.
  [[nodiscard]] std::uint32_t lender(std::uint32_t node) const { return m_nodes[node].lender; }

  /// The node of least power in the whole tree, the lowest index among equals. O(n).
  [[nodiscard]] std::uint32_t locate(const Vec& point) const;

  /// The node that a cursor at `node` ends at: steps to the neighbour of least power while that is
  /// less, at most 256 times.
  [[nodiscard]] std::uint32_t follow(const Vec& point, std::uint32_t node) const;

  /// f and its derivatives to the given order, 1 or 2, of the node's own model.
  template <int order = 1>
  [[nodiscard]] Jet<order> local(const Vec& point, std::uint32_t node) const {
    const double p[3] = {point.x, point.y, point.z};
    return model<order>(node, p);
  }

  /// The blended f and its derivatives to the given order, 1 or 2, for the cursor at `node`, which
  /// has followed the point.
  template <int order = 1>
  [[nodiscard]] Jet<order> blended(const Vec& point, std::uint32_t node) const {
    const double p[3] = {point.x, point.y, point.z};
    return blend<order>(*this, node, p);
  }

  // The interface that blend() requires.
  [[nodiscard]] const double* centre(std::uint32_t node) const { return m_nodes[node].centre; }
  template <class Visit>
  bool eachRival(std::uint32_t node, Visit&& visit) const {
    for (std::uint32_t e = m_around.offset[node]; e < m_around.offset[node + 1]; ++e)
      if (!visit(m_rivals[e])) return false;
    return true;
  }
  template <int order>
  [[nodiscard]] Jet<order> model(std::uint32_t node, const double* point) const;

private:
  struct Node {
    double centre[3], radius;
    std::uint32_t lender;
  };
  struct StoredBlob {
    double centre[3];
    double a, width;  ///< u = a |X - C|^2
  };

  Kernel m_kernel;
  double m_level;
  std::vector<Node> m_nodes;
  Neighbourhood m_around;
  std::vector<Rival> m_rivals;  ///< one for each entry of m_around.node
  std::vector<std::uint32_t> m_offset;
  std::vector<StoredBlob> m_blobs;
};

}  // namespace lumen::field
