// SPDX-License-Identifier: Apache-2.0
// Declared in seeds_parse.h.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/seeds/seeds_parse.h"
#include "formats/container/printable.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

double unitInMillimetres(const JsonPlace& unit, const SeedReading& reading) {
  const std::string& word = unit.text();
  if (word == "mm") return 1;
  if (word == "m") return 1000;
  unit.refuse("\"mm\" or \"m\"; " + reading.word("seeds-unit") + " states another");
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

namespace {

namespace fs = std::filesystem;
using formats::printable;

/// mm: points nearer to one another are one point, clicked twice.
constexpr double kSamePlace = 1e-9;

std::string branchOf(const fs::path& file, const SeedBranch& branch) {
  return printable(file.string()) + ": branch " + quotedText(branch.label) + ": ";
}

void checkPoint(const SeedBranch& branch, std::size_t i, const fs::path& file) {
  const SeedPoint& p = branch.points[i];
  const auto refuse = [&](const std::string& what) {
    throw invalidInput(branchOf(file, branch) + "point " + std::to_string(i + 1) + " " + what);
  };
  if (!p.position.allFinite())
    refuse("is " + vectorText(p.position) + "; expected finite coordinates");
  if (p.radius && !(std::isfinite(*p.radius) && *p.radius > 0))
    refuse("has radius " + shownNumber(*p.radius) +
           "; expected a positive number, or no radius where it is not known");
  if (!p.radius && branch.kind == formats::BranchKind::Aneurysm)
    refuse("has no radius; expected the distance to the wall at each point of an aneurysm");
}

/// Merges points that were clicked twice in one place.
void mergeDoubledPoints(std::vector<SeedPoint>& points) {
  std::vector<SeedPoint> kept;
  kept.reserve(points.size());
  for (SeedPoint& point : points) {
    if (kept.empty() || (point.position - kept.back().position).norm() >= kSamePlace)
      kept.push_back(point);
    else if (!kept.back().radius)
      kept.back().radius = point.radius;
  }
  points = std::move(kept);
}

void normaliseDirection(SeedBranch& branch, const fs::path& file) {
  if (!branch.direction) return;
  const double length = branch.direction->norm();
  if (!(std::isfinite(length) && length > 1e-9))
    throw invalidInput(branchOf(file, branch) + "its direction is " +
                       vectorText(*branch.direction) +
                       "; expected a vector that is not zero, or no direction");
  *branch.direction /= length;
}

/// A label becomes a branch's label in the case, so it follows the case's rules.
void checkLabel(const std::string& label, std::size_t number, const fs::path& file) {
  const std::string place = printable(file.string()) + ": branch number " +
                            std::to_string(number + 1) + ": its label " + quotedText(label) + " ";
  if (label.empty()) throw invalidInput(place + "is empty; expected a name");
  if (label.size() > formats::kMaxNameBytes)
    throw invalidInput(place + "has " + std::to_string(label.size()) + " bytes; expected at most " +
                       std::to_string(formats::kMaxNameBytes));
  if (formats::checkText(label, formats::kMaxNameBytes, ""))
    throw invalidInput(place + "has control characters; expected UTF-8 text without them");
}

using Labels = std::unordered_map<std::string, std::size_t>;

/// Index of each label, after the checks that need one branch or a pair of them.
Labels checkBranches(std::vector<SeedBranch>& branches, const fs::path& file,
                     const std::set<std::string>& vessels) {
  Labels index;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    SeedBranch& branch = branches[i];
    checkLabel(branch.label, i, file);
    const auto [other, isNew] = index.emplace(branch.label, i);
    if (!isNew)
      throw invalidInput(branchOf(file, branch) + "branches number " +
                         std::to_string(other->second + 1) + " and " + std::to_string(i + 1) +
                         " both have this label; expected another for one of them");
    if (branch.points.empty())
      throw invalidInput(branchOf(file, branch) + "has no points; expected at least one");
    for (std::size_t p = 0; p < branch.points.size(); ++p) checkPoint(branch, p, file);
    mergeDoubledPoints(branch.points);
    normaliseDirection(branch, file);
  }
  for (const auto& branch : branches)
    if (branch.parent && branch.isRoot)
      throw invalidInput(branchOf(file, branch) + "it is of kind root and has the parent " +
                         quotedText(*branch.parent) + "; expected one of both");
    else if (branch.parent && !index.contains(*branch.parent) && !vessels.contains(*branch.parent))
      throw invalidInput(branchOf(file, branch) + "its parent " + quotedText(*branch.parent) +
                         " is unknown; expected the label of another branch");
  return index;
}

[[noreturn]] void refuseCycle(const std::vector<SeedBranch>& branches,
                              const std::vector<std::size_t>& chain, std::size_t again,
                              const fs::path& file) {
  constexpr std::ptrdiff_t kShown = 8;  // labels of a long cycle
  std::string path;
  const auto begin = std::find(chain.begin(), chain.end(), again);
  const auto shown = std::min(kShown, chain.end() - begin);
  for (auto i = begin; i != begin + shown; ++i) path += quotedText(branches[*i].label) + " -> ";
  if (begin + shown != chain.end()) path += "... -> ";
  throw invalidInput(branchOf(file, branches[again]) + "is its own ancestor (" + path +
                     quotedText(branches[again].label) +
                     "); expected parents without a cycle: the root has none");
}

/// Moves branches behind their parents, otherwise in file order.
std::vector<SeedBranch> parentsFirst(std::vector<SeedBranch> branches, const Labels& index,
                                     const fs::path& file) {
  enum class State : std::uint8_t { Waiting, InChain, Placed };
  std::vector<State> state(branches.size(), State::Waiting);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    std::vector<std::size_t> chain;
    for (std::size_t at = i; state[at] != State::Placed;) {
      if (state[at] == State::InChain) refuseCycle(branches, chain, at, file);
      state[at] = State::InChain;
      chain.push_back(at);
      const auto parent = branches[at].parent ? index.find(*branches[at].parent) : index.end();
      if (parent == index.end()) break;
      at = parent->second;
    }
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      state[*at] = State::Placed;
      order.push_back(*at);
    }
  }
  std::vector<SeedBranch> ordered;
  ordered.reserve(branches.size());
  for (const std::size_t i : order) ordered.push_back(std::move(branches[i]));
  return ordered;
}

}  // namespace

std::vector<SeedBranch> checkedSeeds(std::vector<SeedBranch> branches, const fs::path& file,
                                     const std::set<std::string>& vessels) {
  const std::string name = printable(file.string());
  if (branches.empty())
    throw invalidInput(name + ": holds no seeds; expected at least one branch with a point");
  if (branches.size() > formats::kMaxBranches)
    throw invalidInput(name + ": has " + std::to_string(branches.size()) +
                       " seeds; expected at most " + std::to_string(formats::kMaxBranches) +
                       ", which is what a case can hold; give one for each vessel");
  const Labels index = checkBranches(branches, file, vessels);
  return parentsFirst(std::move(branches), index, file);
}

void applyDescription(const std::string& text, SeedBranch& branch,
                      const std::function<void(const std::string&)>& refuse) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const auto equals = part.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(part.substr(0, equals));
    const std::string value = trimmed(part.substr(equals + 1));
    if (key == "parent") {
      branch.parent = value;
    } else if (key == "kind" && setKind(value, branch)) {
      continue;
    } else if (key == "radius") {
      const auto radius = parsedNumber(value);
      if (!radius) return refuse("a number after \"radius=\"");
      for (auto& point : branch.points)
        if (!point.radius) point.radius = branch.frame.unit * *radius;
    } else {
      return refuse(
          "\"parent=LABEL\", \"kind=vessel\", \"kind=aneurysm\", \"kind=root\" or "
          "\"radius=NUMBER\" "
          "around each \"=\"");
    }
  }
}

}  // namespace lumen::convert
