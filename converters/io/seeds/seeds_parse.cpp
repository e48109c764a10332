// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/seeds_parse.h"

#include <optional>
#include <string>

#include "converters/base/option_name.h"

namespace lumen::convert {

double unitInMillimetres(const JsonPlace& unit) {
  const std::string& word = unit.text();
  if (word == "mm") return 1;
  if (word == "m") return 1000;
  unit.refuse("\"mm\" or \"m\"; " + kOption.seedsUnit.shown() + " states another");
}

bool setKind(const std::string& word, SeedBranch& branch) {
  if (word != "vessel" && word != "aneurysm" && word != "root") return false;
  branch.kind = word == "aneurysm" ? formats::BranchKind::Aneurysm : formats::BranchKind::Vessel;
  branch.isRoot = word == "root";
  return true;
}

std::string kindOf(const SeedBranch& branch) {
  if (branch.isRoot) return "root";
  return branch.kind == formats::BranchKind::Aneurysm ? "aneurysm" : "vessel";
}

}  // namespace lumen::convert
