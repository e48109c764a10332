// SPDX-License-Identifier: Apache-2.0
// The open ends of a case's vessels, and the case with blood coming in at some of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/operations/context.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// An end of a vessel at which nothing else begins.
struct OpenEnd {
  std::uint32_t branch = 0, node = 0;
  bool isInlet = false;                             ///< the root of a tree
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< mm, LPS
  double radius = 0;                                ///< mm, calibre() of the vessel there
  std::optional<bool> leavesVolume;                 ///< absent if the case states no volume
  std::string why;  ///< reason why blood may come in here; empty for an inlet, and where none is
};

/// The open ends of a valid case, the widest first: roots, and last nodes of vessels to which no
/// branch and no link is joined.
std::vector<OpenEnd> endsOf(const formats::Case& value);

struct RootedCase {
  formats::Case value;
  bool isFitted = false;  ///< its models were made anew
};

/// The case with blood coming in at these ends of endsOf(). Other roots of trees without one of them
/// stay. A tree with several is divided at the narrowest node between them, and a link holds the
/// parts together; models are then fitted anew. Throws Error(InvalidInput) if such a case has models
/// and no wall points, and Error(Cancelled).
RootedCase rootedAt(formats::Case value, std::span<const OpenEnd> inlets, const Context& context);

}  // namespace lumen::operations
