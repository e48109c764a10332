// SPDX-License-Identifier: Apache-2.0
// Session: seeds, and tracking from them.
#include <algorithm>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/stages.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/enum_names.h"
#include "formats/container/utf8.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kMostSeeds = 10000;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::Usage, what);
}

bool isTaken(const Document& document, const std::string& label) {
  const auto has = [&label](const auto& item) { return item.label == label; };
  return std::any_of(document.seeds->begin(), document.seeds->end(), has) ||
         (document.value && std::any_of(document.value->tree.branches.begin(),
                                        document.value->tree.branches.end(), has));
}

std::string freeLabel(const Document& document, const std::string& stem) {
  for (std::size_t i = 1;; ++i)
    if (std::string label = stem + "-" + std::to_string(i); !isTaken(document, label)) return label;
}

convert::SeedBranch& seedOf(Seeds& seeds, const std::string& label) {
  const auto found = std::find_if(seeds.begin(), seeds.end(),
                                  [&label](const auto& seed) { return seed.label == label; });
  if (found == seeds.end()) refuse("there is no seed \"" + label + "\"");
  return *found;
}

std::string addSeed(Seeds& seeds, const Document& document, const Arguments& request) {
  if (seeds.size() >= kMostSeeds) refuse("there are as many seeds as there may be");
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

}  // namespace

Json Session::seedOperation(const std::string& op, const Arguments& request, const Moment& from) {
  auto seeds = std::make_shared<Seeds>(*from.document.seeds);
  std::string label, name;
  if (op == "seedAdd") {
    label = addSeed(*seeds, from.document, request);
    name = "place seed " + label;
  } else if (op == "seedMove") {
    label = request.text("label");
    convert::SeedBranch& seed = seedOf(*seeds, label);
    convert::SeedPoint& point = seed.points[request.index("point", seed.points.size())];
    point.position = request.position("position");
    if (request.has("radius")) point.radius = request.number("radius");
    if (point.radius && !(*point.radius > 0)) refuse("\"radius\" must be above 0");
    name = "move seed " + label;
  } else if (op == "seedDelete") {
    label = request.text("label");
    seedOf(*seeds, label);
    std::erase_if(*seeds, [&label](const auto& seed) { return seed.label == label; });
    for (convert::SeedBranch& seed : *seeds)
      if (seed.parent == label) seed.parent.reset();
    name = "delete seed " + label;
  } else {
    refuse("there is no operation \"" + op + "\"");
  }
  Document document = from.document;
  document.seeds = std::move(seeds);
  commit(name, from, std::move(document));
  return {{"revision", m_history.now().revision}, {"label", label}};
}

}  // namespace lumen::viewer
