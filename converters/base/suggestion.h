// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?"
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumen {

/// The candidate of which `word` is most likely a misspelling: fewest letters inserted, dropped,
/// replaced or swapped with a neighbour, whatever the case, and at most a third of them; or the
/// only one that begins with it. Empty if there is none.
std::string closest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean --seeds?", or empty.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b or c".
std::string alternatives(const std::vector<std::string>& names);

}  // namespace lumen
