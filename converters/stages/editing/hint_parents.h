// SPDX-License-Identifier: Apache-2.0
// Whether vessels hang on the parents that hints state.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "formats/case/case.h"

namespace lumen::convert {

std::optional<std::uint32_t> branchNamed(const formats::CenterlineTree& tree,
                                         const std::string& label);

/// Whether a branch is `above` or hangs on it, at whatever depth.
bool hangsOn(const formats::CenterlineTree& tree, std::uint32_t branch, std::uint32_t above);

/// The label of the branch that a branch hangs on, in quotation marks, or "the root".
std::string aboveText(const formats::CenterlineTree& tree, std::uint32_t branch);

/// "1.3 mm"
std::string millimetres(double length);

/// The vessels with a hint's name that do not hang on the parent which it states, and the reason, once all
/// are tracked; without those of `known`. `holders`: as HintRemarks has them; empty if each seed has
/// the vessel of its name.
std::vector<SeedFailure> unkeptParents(const formats::CenterlineTree& tree,
                                       const std::vector<SeedBranch>& hints,
                                       const std::map<std::string, std::string>& holders,
                                       const std::vector<SeedFailure>& known);

}  // namespace lumen::convert
