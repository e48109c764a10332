// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/seeds_parse.h"

#include <optional>
#include <string>

#include "converters/base/option_name.h"

namespace lumen::convert {

double scaleOf(const JsonPlace& unit) {
  const std::string& word = unit.text();
  if (word == "mm") return 1;
  if (word == "m") return 1000;
  unit.refuse("\"mm\" or \"m\"; " + kOption.seedsUnit.shown() + " states another");
}

std::optional<formats::BranchKind> branchKind(const std::string& word) {
  if (word == "vessel") return formats::BranchKind::Vessel;
  if (word == "aneurysm") return formats::BranchKind::Aneurysm;
  return std::nullopt;
}

}  // namespace lumen::convert
