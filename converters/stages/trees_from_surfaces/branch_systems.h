// SPDX-License-Identifier: Apache-2.0
// The systems of the branches of a case, and cases of unlike systems in one (docs/method.md, section
// 10, *Systems*).
#pragma once

#include <span>

#include "converters/io/labels/label_role.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Gives each branch of a case the system of the label with the greatest length along it. A branch
/// on no label with a system keeps its own.
void takeSystems(const LabelMask& mask, std::span<const LabelRole> roles, formats::Case& value);

/// Gives branches whose system is unknown that of the vessel that they hang on, or else that of a
/// vessel that hangs on them, unless they are wider: a tree is of one system, but what is wider than
/// a vessel and no label's may be a chamber that vessels of several systems meet in. Beyond a true
/// lumen lie arteries.
void spreadSystems(formats::Case& value);

/// Appends the trees of a case without models to another one. Labels that are taken get a number.
void appendTrees(const formats::Case& from, formats::Case& target);

}  // namespace lumen::convert
