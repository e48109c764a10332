// SPDX-License-Identifier: Apache-2.0
// The field of a case whose nodes have moved, as spec/lumen.md defines it ("The posed case"), in
// doubles: the reference for whatever answers at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/field/blend.h"
#include "formats/field/blended_field.h"
#include "formats/field/pose.h"

namespace lumen::field {

/// A blended field whose local fields ride on the poses of their nodes. The neighbours are those
/// at rest. Immutable: any number of threads may query it. Gives the same bits on every machine.
class PosedField {
public:
  /// One pose for each node. `rest`, the field of `tree`, must outlive this. O(n) for n nodes.
  PosedField(const BlendedField& rest, const TreeView& tree, std::vector<NodePose> poses);

  [[nodiscard]] double level() const { return m_rest.level(); }
  /// mm^2, of a point with respect to a node.
  [[nodiscard]] double power(const Vec& point, std::uint32_t node) const;
  /// The node of least power in the whole tree, the lowest index among equals. O(n).
  [[nodiscard]] std::uint32_t locate(const Vec& point) const;
  /// The node that a cursor at `node` ends at; see BlendedField::follow().
  [[nodiscard]] std::uint32_t follow(const Vec& point, std::uint32_t node) const;

  /// f and its gradient of the node's own model.
  [[nodiscard]] Jet<1> local(const Vec& point, std::uint32_t node) const;
  /// The blended f and its gradient for the cursor at `node`, which has followed the point.
  [[nodiscard]] Jet<1> blended(const Vec& point, std::uint32_t node) const {
    const double p[3] = {point.x, point.y, point.z};
    return blend<1>(*this, node, p);
  }

  // The interface that blend() requires.
  [[nodiscard]] const double* centre(std::uint32_t node) const { return m_nodes[node].centre; }
  template <class Visit>
  bool eachRival(std::uint32_t node, Visit&& visit) const {
    for (std::uint32_t e = m_offset[node]; e < m_offset[node + 1]; ++e)
      if (!visit(m_rivals[e])) return false;
    return true;
  }
  template <int order>
  [[nodiscard]] Jet<order> model(std::uint32_t node, const double* point) const {
    static_assert(order == 1);
    return local({point[0], point[1], point[2]}, node);
  }

private:
  struct Node {
    double centre[3], radius;
  };

  const BlendedField& m_rest;
  std::vector<NodePose> m_poses;
  std::vector<Node> m_nodes;
  std::vector<std::uint32_t> m_offset;  ///< of m_rivals, for each node
  std::vector<Rival> m_rivals;
};

}  // namespace lumen::field
