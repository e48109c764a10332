// SPDX-License-Identifier: Apache-2.0
// Names of the arteries of the circle of Willis, by geometry and topology (docs/method.md, section 13).
#pragma once

#include <vector>

#include "converters/stages/anatomy/artery_stretches.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The arteries of the circle of Willis in a tree in mm, LPS, whose inlets are roots: R and L for ICA, MCA, ACA, Pcom and PCA,
/// and Acom and BA, as TopCoW has them (K. Yang et al., "Benchmarking the CoW with the TopCoW challenge",
/// arXiv:2312.17670, 2023), in the order of the nodes. Empty where no pair of carotid arteries with a first
/// segment of an anterior cerebral artery is found; a part whose name is not plausible has none.
std::vector<ArteryStretch> nameCircleOfWillis(const formats::CenterlineTree& tree);

}  // namespace lumen::convert
