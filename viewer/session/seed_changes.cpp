// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/seed_changes.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "converters/base/error.h"
#include "formats/case/enum_names.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kMostSeeds = 10000;

bool isTaken(const Document& document, const std::string& label) {
  const auto has = [&label](const auto& item) { return item.label == label; };
  const auto isBranchOf = [&has](const std::shared_ptr<const formats::Case>& part) {
    return part && std::any_of(part->tree.branches.begin(), part->tree.branches.end(), has);
  };
  return std::any_of(document.seeds->begin(), document.seeds->end(), has) ||
         isBranchOf(document.value) || isBranchOf(document.proposals);
}

std::string freeLabel(const Document& document, const std::string& stem) {
  for (std::size_t i = 1;; ++i)
    if (std::string label = stem + "-" + std::to_string(i); !isTaken(document, label)) return label;
}

convert::SeedBranch& findSeed(Seeds& seeds, const std::string& label) {
  const auto found = std::find_if(seeds.begin(), seeds.end(),
                                  [&label](const auto& seed) { return seed.label == label; });
  if (found == seeds.end()) refuse("there is no seed \"" + label + "\"");
  return *found;
}

std::string addSeed(Seeds& seeds, const Document& document, const Arguments& request) {
  if (seeds.size() >= kMostSeeds)
    refuse("there may be at most " + std::to_string(kMostSeeds) + " seeds");
  convert::SeedBranch seed;
  const auto kind = formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames,
                                                               request.text("kind", "vessel"));
  if (!kind) refuse("\"kind\" must be vessel or aneurysm");
  seed.kind = *kind;
  seed.label = request.text("label", "");
  if (seed.label.empty()) seed.label = freeLabel(document, request.text("kind", "vessel"));
  if (isTaken(document, seed.label)) refuse("\"" + seed.label + "\" is taken");
  if (request.has("parent")) {
    seed.parent = request.text("parent");
    if (!isTaken(document, *seed.parent)) refuse("there is no vessel \"" + *seed.parent + "\"");
  }
  seed.points = request.points("points");
  seeds.push_back(seed);
  return seed.label;
}

std::string moveSeed(Seeds& seeds, const Document&, const Arguments& request) {
  const std::string label = request.text("label");
  convert::SeedBranch& seed = findSeed(seeds, label);
  convert::SeedPoint& point = seed.points[request.index("point", seed.points.size())];
  point.position = request.position("position");
  if (request.has("radius")) point.radius = request.number("radius");
  if (point.radius && !(*point.radius > 0)) refuse("\"radius\" must be above 0");
  return label;
}

std::string deleteSeed(Seeds& seeds, const Document&, const Arguments& request) {
  const std::string label = request.text("label");
  findSeed(seeds, label);
  std::erase_if(seeds, [&label](const auto& seed) { return seed.label == label; });
  for (convert::SeedBranch& seed : seeds)
    if (seed.parent == label) seed.parent.reset();
  return label;
}

struct NamedChange {
  const char *name, *title;
  /// Changes the seeds and returns the label of the seed.
  std::string (*change)(Seeds& seeds, const Document& document, const Arguments& request);
};

constexpr NamedChange kChanges[] = {{"seedAdd", "place seed ", addSeed},
                                    {"seedMove", "move seed ", moveSeed},
                                    {"seedDelete", "delete seed ", deleteSeed}};

}  // namespace

std::optional<SeedChange> changeSeeds(const std::string& op, const Arguments& request,
                                      const Document& document) {
  const auto named = std::find_if(std::begin(kChanges), std::end(kChanges),
                                  [&op](const NamedChange& change) { return change.name == op; });
  if (named == std::end(kChanges)) return std::nullopt;
  auto seeds = std::make_shared<Seeds>(*document.seeds);
  SeedChange change;
  change.label = named->change(*seeds, document, request);
  change.title = named->title + change.label;
  change.document = document;
  change.document.seeds = std::move(seeds);
  return change;
}

}  // namespace lumen::viewer
