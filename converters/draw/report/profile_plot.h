// SPDX-License-Identifier: Apache-2.0
// Radius along a vessel as a drawing (SVG).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "converters/base/html.h"
#include "converters/draw/report/tree_profiles.h"
#include "converters/judge/check/check.h"

namespace lumen::convert {

// The axis of a plot.

/// An axis from 0 to `end`; marks are multiples of 1, 2 or 5 times a power of ten.
struct Axis {
  double end = 1;
  std::vector<double> marks;  ///< 0 is the first
  int digits = 0;             ///< behind the decimal point of a mark
};

/// The axis with one mark besides 0 at least, and at most `most`, which is at least 3. An `end`
/// that is not above 0, or is not finite, becomes 1.
Axis axisTo(double end, int most);

/// A plot of 58 by 36 mm: mm along the vessel to the right, radius in mm upwards, both from 0;
/// confidence, if there is one, as an area behind it from 0 to 1; places where branches leave, as
/// marks on the axis below; `agreement` of its nodes with a volume, unless empty, as a strip below
/// that. The plot has classes in place of colours: plotStyle() has these.
Markup profilePlot(const TreeProfile& profile, std::span<const Agreement> agreement);

/// Share of the length for each confidence, as bars.
Markup confidenceBars(const ConfidenceShares& shares);

/// CSS for these plots, and for keys to the colours of agreement: .key.good and so on,
/// .key.missing.
std::string plotStyle();

}  // namespace lumen::convert
