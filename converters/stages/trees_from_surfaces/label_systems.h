// SPDX-License-Identifier: Apache-2.0
// Labels of unlike systems of vessels, which touch and are never joined (docs/method.md, section
// 10, *Systems*).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/labels/label_role.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::convert {

/// Parts of a mask in which no two labels touch that are apart: 0 or more for each label, in the
/// order of the mask. `roles` has as many. Labels that touch are in one part, unless
/// - their roles are of systems that are never joined, or such labels would be joined through them;
///   those that share the greatest face are joined first;
/// - one is of no known system, and they touch side by side: along more than the section of the
///   thinner one that is cut at 30 degrees (two widths), and nowhere does a ball that fits into it
///   beside the contact fit through the contact.
/// All are 0 if no two labels are apart. Throws Error(Cancelled).
std::vector<std::uint8_t> partsOfLabels(const LabelMask& mask, std::span<const LabelRole> roles,
                                        const Progress& progress);

/// The labels of one part of a mask.
LabelMask partOfMask(const LabelMask& mask, std::span<const std::uint8_t> parts, std::uint8_t part);

}  // namespace lumen::convert
