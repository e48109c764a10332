// SPDX-License-Identifier: Apache-2.0
// Places at which proposals hang on the open case, and a case with the branches of another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "formats/case/case.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// The node array kJoinedArray (proposals.h), one place for each node. A place outlives edits of the
/// case that renumber its nodes.
class Joints {
public:
  /// No node is joined.
  explicit Joints(std::size_t nodes) : m_at(nodes) {}
  /// The joints that the array of a case states; none if it has no such array of four floats.
  explicit Joints(const formats::Case& proposals);

  void set(std::uint32_t node, const formats::Vec3f& position) { m_at[node] = position; }
  /// Joins nodes of the other branches to nodes of those that go: by their parents and by links.
  void cutOff(const formats::CenterlineTree& tree, const std::vector<bool>& goes);
  /// The node of a case that a node is joined to; empty if there is none, or none any more.
  [[nodiscard]] std::optional<std::uint32_t> nodeAt(std::uint32_t node,
                                                    const formats::CenterlineTree& tree) const;

  /// Replaces the array of a case.
  void write(formats::Case& proposals) const;
  static void remove(formats::Case& value);

private:
  std::vector<std::optional<formats::Vec3f>> m_at;
};

/// A case with the marked branches of `found`, whose parents are marked, behind its own: under names
/// that are not `taken`, joined and linked as `found` and its joints state. New nodes have no models
/// yet. `dropped`: names of node arrays that the result lacks. Throws Error(InvalidInput) if it
/// breaks a rule of the format.
formats::Case withBranches(const formats::Case& known, const formats::Case& found,
                           const std::vector<bool>& chosen, std::set<std::string> taken,
                           std::vector<std::string>& dropped);

}  // namespace lumen::viewer
