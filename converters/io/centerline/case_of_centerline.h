// SPDX-License-Identifier: Apache-2.0
// A case straight from a centerline with radii (docs/method.md, section 2.10).
#pragma once

#include <optional>
#include <string>

#include "converters/io/centerline/centerline_file.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// What a user says of a file's lengths and axes, whatever it says itself.
struct CenterlineReading {
  std::optional<double> unit;  ///< mm
  std::optional<CenterlineAxes> axes;
};

struct CenterlineExtent {
  double length = 0;                       ///< of all ways between points
  double diagonal = 0;                     ///< of the box around all points
  double least = 0, median = 0, most = 0;  ///< radius; 0 if the file has none
};

/// In the file's unit. The file has points.
CenterlineExtent extentOf(const CenterlineFile& file);

/// The unit, mm, in which the lengths of the file are those of vessels: millimetres if they may be,
/// else micrometres or metres.
double plausibleUnit(const CenterlineFile& file);

/// Brings positions and radii to mm in LPS, by `reading`, else as the file says, else by
/// plausibleUnit() and LPS; a remark tells of a unit that was guessed. Returns the unit, mm.
double toPatientSpace(CenterlineFile& file, const CenterlineReading& reading);

/// A tree of nodes whose origin is `given`, with no wall points yet: fit() draws them on the radii.
/// `file` is in mm and LPS. One branch for each chain, labelled as its vessel, else b000, b001 and
/// so on. Points are nodes; a segment longer than 1.25 radii gets nodes on a cubic curve through the
/// points, at most 0.6 radii apart, with radii in proportion; a chain whose points are closer than a
/// fifth of a radius gets nodes every half radius instead. The points of lumen's own files are nodes
/// as they are. A child keeps its own radius up to the point it hangs on. Throws Error(InvalidInput) with `name` for points without radius, and for
/// trees that are too long for their radii.
formats::Case caseOfCenterline(const CenterlineFile& file, const std::string& name);

}  // namespace lumen::convert
