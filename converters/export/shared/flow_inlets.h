// SPDX-License-Identifier: Apache-2.0
// Ends at which blood comes into a case, and the parts of it that no blood reaches.
#pragma once

#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// An inlet that a person states.
struct StatedInlet {
  std::string label;  ///< of the branch whose first node is a root
  double flow = 0;    ///< m^3/s; 0: the mean flow of blood.h
};

/// The inlets of words as "ICA" or "ICA=4.2", the flow being in ml/s. Throws Error(Usage) for a flow
/// that is no positive number. Messages name the field "inlets".
std::vector<StatedInlet> statedInlets(const std::vector<std::string>& words,
                                      const FieldWord& word = {});

/// A case of which blood reaches all parts.
struct FlowCase {
  formats::Case value;
  std::vector<std::string>
      losses;  ///< a sentence for each part that was left out; labels as they are
};

/// Leaves out the connected parts of a case that no inlet leads to; links connect. Inlets are the
/// stated ones, if there are some. Otherwise every root is one, but those of
///
/// - parts that begin within the source volume, farther than 1.5 radii from its border, unless the
///   part is the longest: a vessel does not begin there;
/// - parts shorter than a tenth of the longest: fragments.
///
/// Ends lose their tapers, and stubs go (trimEnds()), with a sentence each, unless `keepEnds`; models
/// stay as they are. Throws Error(Usage), with the labels that there are, for a stated label that is
/// not of a root.
FlowCase flowCase(const formats::Case& source, const std::vector<StatedInlet>& inlets,
                  const FieldWord& word = {}, bool keepEnds = false);

}  // namespace lumen::convert
