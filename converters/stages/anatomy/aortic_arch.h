// SPDX-License-Identifier: Apache-2.0
// Names of the aortic arch and its branches, by geometry and topology (docs/method.md, section 13).
#pragma once

#include <vector>

#include "converters/stages/anatomy/artery_stretches.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The aorta about its arch and the great vessels that leave it, in a tree in mm, LPS, wherever its
/// roots are: ascending_aorta, aortic_arch, descending_aorta, brachiocephalic_trunk, and _left and
/// _right of common_carotid_artery and subclavian_artery, in the order of the nodes. Empty where no
/// wide vessel rises, turns over backwards and to the left, and descends; a part whose name is not
/// plausible has none.
std::vector<ArteryStretch> nameAorticArch(const formats::CenterlineTree& tree);

}  // namespace lumen::convert
