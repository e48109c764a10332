// SPDX-License-Identifier: Apache-2.0
// Ends of vessels that are too thin or too short to be of use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "converters/stages/editing/selection.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct TrimLimits {
  double minRadius = 0;  ///< mm; 0: no end is too thin
  double minLength = 0;  ///< mm; 0: no end is too short
  /// Share of an end's calibre() below which its tip is a taper, as where a track runs out; 0: none.
  double taper = 0;
  /// Diameters of its calibre() below which an end is a stub, unless it leaves the volume; 0: none.
  double stub = 0;
  friend bool operator==(const TrimLimits&, const TrimLimits&) = default;
};

/// The radius of a vessel by its end, which the taper of a tip does not change: the median by length
/// over the last ten of its radii. `radius` is that of nodes from the tip on, `step` the length from
/// each to the next one; mm.
double calibre(std::span<const double> radius, std::span<const double> step);

/// Whether a node lies within one and a half of its radii of the border of a volume, or outside: there
/// a vessel goes on, and the volume does not.
bool isAtBorder(const formats::SourceVolume& volume, const formats::CenterlineTree& tree,
                std::uint32_t node);

/// The part of a branch that was removed.
struct TrimmedEnd {
  std::string label;
  bool isWhole = false;   ///< the whole branch is gone
  std::size_t nodes = 0;  ///< number of nodes that are gone
  double length = 0;      ///< mm, of what is gone
  double radius = 0;      ///< mm, the least of what is gone
};

struct TrimResult {
  Change change;                 ///< without a sentence if nothing was removed
  std::vector<TrimmedEnd> ends;  ///< in the order of the branches before
};

/// Removes the ends of vessels that are thinner than `minRadius` or shorter than `minLength`, tapers
/// and stubs, until no such end is left. An end is the part of a vessel behind the last node at which
/// another branch or a link begins. It is removed from its tip up to the first node that is wide
/// enough; and as a whole if what is left is too short, measured from the wall of its parent, or
/// lies within its parent. A tree keeps its root, unless it is one vessel that is removed as a
/// whole. Aneurysms stay. Throws Error(InvalidInput) if nothing would be left; the case is then as it
/// was. Costs O(n) for each branch that another one leads to an end.
TrimResult trimEnds(formats::Case& target, const TrimLimits& limits);

/// "b3: 12 mm of its end, down to a radius of 0.2 mm": the part that is gone, for people.
std::string trimmedText(const TrimmedEnd& end);

}  // namespace lumen::convert
