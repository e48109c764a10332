// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/document_seeds.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/io/seeds/case_seeds.h"

namespace lumen::viewer {

namespace {

Seeds chosen(const Document& document, bool areTracked) {
  const auto vessels = vesselLabels(document.value);
  Seeds out;
  for (const convert::SeedBranch& seed : *document.seeds)
    if (isTracked(seed, vessels) == areTracked) out.push_back(seed);
  return out;
}

}  // namespace

Seeds trackedSeeds(const Document& document) {
  return chosen(document, true);
}

Seeds waitingSeeds(const Document& document) {
  return chosen(document, false);
}

std::shared_ptr<const Seeds> joined(Seeds first, const Seeds& second) {
  std::set<std::string> labels;
  for (const convert::SeedBranch& seed : first) labels.insert(seed.label);
  std::copy_if(second.begin(), second.end(), std::back_inserter(first),
               [&labels](const auto& seed) { return !labels.contains(seed.label); });
  return std::make_shared<const Seeds>(std::move(first));
}

Seeds seedsInCase(const formats::Case& value, const std::string& label, Progress& progress) {
  try {
    return convert::seedsOf(value, label, engine::optionWord());
  } catch (const Error& error) {
    warn(progress, {WarningCode::CaseSeeds,
                    std::string(error.what()) + "; they are left out, and saving drops them"});
    return {};
  }
}

std::shared_ptr<const formats::Case> caseWithSeeds(const Document& document) {
  if (!document.value) return nullptr;
  const auto vessels = vesselLabels(document.value);
  Seeds seeds = *document.seeds;
  for (convert::SeedBranch& seed : seeds) seed.isTracked = isTracked(seed, vessels);
  if (convert::holdsSeeds(*document.value, seeds)) return document.value;
  auto value = std::make_shared<formats::Case>(*document.value);
  convert::setSeeds(*value, seeds);
  return value;
}

}  // namespace lumen::viewer
