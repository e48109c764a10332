// SPDX-License-Identifier: Apache-2.0
// A case taken apart into branches of nodes, to be changed and put together again by the rules of
// the format. Every edit is a change of an editable case.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/stages/editing/selection.h"
#include "formats/case/case.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

/// No node of an editable case.
constexpr std::uint32_t kNoNode = UINT32_MAX;

struct EditableNode {
  std::uint32_t before = kNewNode;  ///< its index in the case
  formats::Vec3f centre{}, direction{};
  float radius = 0, height = 0, inlierRate = 0;
  formats::NodeOrigin origin = formats::NodeOrigin::Measured;
  bool isEdited = false;  ///< its wall was changed by hand
  formats::VesselSystem system = formats::VesselSystem::Unknown;
};

struct EditableBranch {
  formats::Branch record;            ///< without its range and its parent
  std::uint32_t parent = kNoNode;    ///< node to which its first node is joined
  std::vector<std::uint32_t> nodes;  ///< at least one
  bool isOther = false;              ///< its nodes have changed, and so has its mean
};

/// Nodes on the straight line from one node to another, without both, half a radius apart. Throws
/// Error(InvalidInput) for a line of more than 20000 nodes.
std::vector<EditableNode> bridge(const EditableNode& from, const EditableNode& to);

/// Nodes are identified by their place in `nodes`, which for those of the case is their index.
/// Nodes without a branch are left out of the finished case, and so are their links.
class EditableCase {
public:
  explicit EditableCase(const formats::Case& value);

  std::vector<EditableNode> nodes;
  std::vector<EditableBranch> branches;
  std::vector<std::array<std::uint32_t, 2>> links;
  // for each wall point of the case; empty: all are there, as they are
  std::vector<bool> isGone;
  std::vector<formats::Vec3f> pointPosition;
  std::vector<std::uint32_t> pointOwner;  ///< the node of the editable case that it belongs to

  /// The branch of a node of the case, before anything was moved.
  [[nodiscard]] std::uint32_t branchOf(std::uint32_t node) const {
    return m_case.tree.branch[node];
  }
  /// Reverses the directions and the order of nodes.
  void reverse(std::vector<std::uint32_t>& chain);
  /// Length along a chain, mm.
  [[nodiscard]] double measureLength(const std::vector<std::uint32_t>& chain) const;
  /// A label that no branch has: `base` followed by the first free number from 2 on.
  [[nodiscard]] std::string freeLabel(const std::string& base) const;
  /// The label of what lies behind a branch called `front` that is cut. With an automatic name it is the
  /// next piece, and the pieces behind it get the numbers after that.
  [[nodiscard]] std::string labelOfRest(const std::string& front);

  /// Replaces `target`, the case that this one was made of, by the edited one, and records
  /// `sentence`. Parents come before their children; the order of branches stays otherwise. Throws
  /// Error(InvalidInput) if a rule of the format is broken, and leaves the case as it was.
  Change finish(formats::Case& target, const std::string& sentence) const;

private:
  struct Layout;
  [[nodiscard]] Layout layOut() const;
  void writeTree(const Layout& layout, formats::Case& out) const;
  void writeLinks(const Layout& layout, formats::Case& out) const;
  /// The wall points of each node of the editable case, in the order of the case.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> pointsByOwner() const;
  void writePoints(const Layout& layout, formats::Case& out) const;
  void writeModels(const Layout& layout, formats::Case& out) const;
  void writeArrays(const Layout& layout, formats::Case& out, Change& change) const;
  /// Keeps the motion of the nodes that stay; a motion goes where a node is new or has another
  /// centre at rest.
  void writeMotion(const Layout& layout, formats::Case& out, Change& change) const;

  const formats::Case& m_case;
};

}  // namespace lumen::convert
