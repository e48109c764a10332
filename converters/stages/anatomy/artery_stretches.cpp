// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/artery_stretches.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lumen::convert {
namespace {

void extend(ArteryStretch& run, std::uint32_t end, double plausible) {
  run.end = end;
  run.plausibility = std::min(run.plausibility, plausible);
}

void absorbSingle(std::vector<ArteryStretch>& runs) {
  const auto isNode = [](const ArteryStretch& run) { return run.end - run.first == 1; };
  const auto count = [&](std::size_t i) { return runs[i].end - runs[i].first; };
  for (auto run = std::find_if(runs.begin(), runs.end(), isNode);
       run != runs.end() && runs.size() > 1; run = std::find_if(runs.begin(), runs.end(), isNode)) {
    const auto k = static_cast<std::size_t>(run - runs.begin());
    const bool isBefore = k + 1 == runs.size() || (k > 0 && count(k - 1) > count(k + 1));
    ArteryStretch& other = runs[isBefore ? k - 1 : k + 1];
    other.first = std::min(other.first, run->first);
    other.end = std::max(other.end, run->end);
    runs.erase(run);
    // those beside it may have one name now
    for (std::size_t i = 1; i < runs.size(); ++i)
      if (runs[i].name == runs[i - 1].name) {
        extend(runs[i - 1], runs[i].end, runs[i].plausibility);
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i--));
      }
  }
}

}  // namespace

std::vector<ArteryStretch> stretchesOf(const formats::CenterlineTree& tree,
                                       std::span<const std::string> name,
                                       std::span<const double> plausible) {
  std::vector<ArteryStretch> out;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    std::vector<ArteryStretch> runs;
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
      const std::string known = plausible[n] < kLeastPlausibility ? std::string{} : name[n];
      if (runs.empty() || runs.back().name != known)
        runs.push_back({b, n, n + 1, known, plausible[n]});
      else
        extend(runs.back(), n + 1, plausible[n]);
    }
    absorbSingle(runs);
    for (ArteryStretch& run : runs)
      if (!run.name.empty()) out.push_back(std::move(run));
  }
  return out;
}

}  // namespace lumen::convert
