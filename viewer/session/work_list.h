// SPDX-License-Identifier: Apache-2.0
// Places that a check leaves to a person, from everything that check and reachability know: one list to walk
// through. A place may be ignored with a reason, which the case keeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/check/check.h"
#include "converters/judge/facts/reachable.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// In the order in which they are walked through.
enum class WorkKind : std::uint8_t {
  Blocked,   ///< no tool can be pushed through
  Loose,     ///< a tree hangs on nothing
  Doubled,   ///< a vessel runs in another one
  Missing,   ///< a vessel of the volume is not in the case
  EarlyEnd,  ///< the volume shows more of a vessel
  Dark,      ///< the volume is dark in the lumen
  WallOff,   ///< the wall is no edge of the volume
  Thin       ///< a vessel is thinner than a voxel
};

/// A place that needs a decision.
struct WorkItem {
  WorkKind kind = WorkKind::Missing;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  double reach = 0;                                    ///< mm around it that belong to it
  std::string about;                                   ///< a clause for people
  std::optional<std::size_t> missing;  ///< number of the missing vessel to track from there
};

/// The items of a checked case that has models, kind by kind, as `report` and `reach` have them.
std::vector<WorkItem> listWork(const formats::Case& value, const convert::CheckReport& report,
                               const std::optional<convert::Reach>& reach,
                               const convert::VolumeGeometry& geometry);

/// {"items": [{"id", "kind", "position", "node", "branch", "about", "missing"}], "found": their number at the
/// check, "ignored": [{"kind", "position", "reason"}]}. Items are those that the case has not answered since:
/// nothing runs through a missing vessel, and of the others a node is still there (and is an end, or a root, as
/// it was). Those that the case ignores are left out. `node` and `branch` are of the case as it is now. The
/// items' numbers begin with `firstId`.
Json workJson(const std::vector<WorkItem>& items, std::size_t firstId, const formats::Case& value);

/// The document whose case records that an item is ignored, and why. Throws Error(Usage) without a reason.
Document withIgnored(const Document& document, const WorkItem& item, const std::string& reason);

/// The document whose case does not ignore the place of that number among "ignored" any longer. Throws
/// Error(Usage) if there is none.
Document withoutIgnored(const Document& document, std::size_t ignored);

}  // namespace lumen::viewer
