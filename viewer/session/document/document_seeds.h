// SPDX-License-Identifier: Apache-2.0
// Seeds of the document, which its case holds on disk (converters/io/seeds/case_seeds.h).
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "converters/base/progress.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// Whether the case was tracked with the seed; `vessels` are the labels of its vessels.
inline bool isTracked(const convert::SeedBranch& seed, const std::set<std::string_view>& vessels) {
  return seed.isTracked || vessels.contains(seed.label);
}

/// The document's seeds that are tracked, or those that wait.
Seeds trackedSeeds(const Document& document);
Seeds waitingSeeds(const Document& document);

/// `first` and those of `second` whose labels are not in it.
std::shared_ptr<const Seeds> joined(Seeds first, const Seeds& second);

/// The seeds of a case that was read from the file `label`; seeds that cannot be read become a
/// warning, and are none.
Seeds seedsInCase(const formats::Case& value, const std::string& label, Progress& progress);

/// The case as it is written: with all seeds of the document. It is the document's own if that holds
/// these seeds.
std::shared_ptr<const formats::Case> caseWithSeeds(const Document& document);

}  // namespace lumen::viewer
