// SPDX-License-Identifier: Apache-2.0
// A case straight from a centerline with radii (docs/method.md, section 2.10).
#pragma once

#include <optional>
#include <string>

#include "converters/base/field_word.h"
#include "converters/geometry/unit_guess.h"
#include "converters/io/centerline/centerline_file.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The user's statements about lengths and axes, which override those of the file.
struct CenterlineReading {
  std::optional<double> unit;  ///< mm
  std::optional<CenterlineAxes> axes;
  FieldWord word{};  ///< names the field "unit" in remarks
};

struct CenterlineExtent {
  double length = 0;                       ///< length of all segments between points
  double diagonal = 0;                     ///< diagonal of the box around all points
  double least = 0, median = 0, most = 0;  ///< radius; 0 if the file has none
};

/// Extent in the file's unit. The file has points.
CenterlineExtent measureExtent(const CenterlineFile& file);

/// Brings positions and radii to mm in LPS, by `reading`, else by the file's own statement, else by
/// the size of the vessels (unit_guess.h) and as LPS; remarks report a guessed unit that may be wrong,
/// and axes that are turned. Returns the unit and where it comes from.
ReadFrame toPatientSpace(CenterlineFile& file, const CenterlineReading& reading);

/// A tree of nodes whose origin is `given`, without wall points: fit() creates them from the radii.
/// `file` is in mm and LPS. One branch for each chain, labelled as its vessel, else b000, b001 and
/// so on. Points are nodes; a segment longer than 1.25 radii gets nodes on a cubic curve through
/// the points, at most 0.6 radii apart, with radii in proportion; a chain whose points are closer
/// than a fifth of a radius gets nodes every half radius instead. The points of lumen's own files
/// become nodes unchanged. A child keeps its own radius up to its point of attachment. Throws
/// Error(InvalidInput) with `name` for points without radius, and for trees that are too long for
/// their radii.
formats::Case caseOfCenterline(const CenterlineFile& file, const std::string& name);

}  // namespace lumen::convert
