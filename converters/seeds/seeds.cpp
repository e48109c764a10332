// SPDX-License-Identifier: Apache-2.0
#include "converters/seeds/seeds.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <utility>

#include "converters/common/error.h"
#include "converters/seeds/seeds_json.h"
#include "converters/seeds/seeds_markups.h"
#include "converters/seeds/seeds_parse.h"
#include "formats/case/atomic_file.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 64u << 20;

std::string readText(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) throw invalidInput(file.string() + ": cannot be read (" + error.message() + ")");
  if (size > kMaxBytes)
    throw invalidInput(file.string() + ": has " + std::to_string(size) +
                       " bytes; expected at most 64 MiB of seeds");
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
    throw invalidInput(file.string() + ": cannot be read");
  return text;
}

/// The name of `file` without ".mrk.json" or its extension.
std::string stemOf(const fs::path& file) {
  const fs::path stem = file.stem();
  return (stem.extension() == ".mrk" ? stem.stem() : stem).string();
}

std::string text(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")";
  return out.str();
}

std::string named(const fs::path& file, const SeedBranch& branch) {
  return file.string() + ": branch \"" + branch.label + "\": ";
}

void checkPoints(const SeedBranch& branch, const fs::path& file) {
  if (branch.points.empty())
    throw invalidInput(named(file, branch) + "has no points; expected at least one");
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const SeedPoint& p = branch.points[i];
    const std::string point = "point " + std::to_string(i + 1);
    if (!p.position.allFinite())
      throw invalidInput(named(file, branch) + point + " is " + text(p.position) +
                         "; expected finite coordinates");
    if (p.radius && !(std::isfinite(*p.radius) && *p.radius > 0)) {
      std::ostringstream radius;
      radius << *p.radius;
      throw invalidInput(named(file, branch) + point + " has radius " + radius.str() +
                         " mm; expected a positive number");
    }
    if (!p.radius && branch.kind == formats::BranchKind::Aneurysm)
      throw invalidInput(
          named(file, branch) + point +
          " has no radius; expected the distance to the wall at each point of an aneurysm");
    if (i > 0 && (p.position - branch.points[i - 1].position).norm() < 1e-9)
      throw invalidInput(named(file, branch) + point +
                         " lies where the one before does; expected distinct points");
  }
}

void normaliseDirection(SeedBranch& branch, const fs::path& file) {
  if (!branch.direction) return;
  const double length = branch.direction->norm();
  if (!(std::isfinite(length) && length > 1e-9))
    throw invalidInput(named(file, branch) + "its direction is " + text(*branch.direction) +
                       "; expected a vector that is not zero");
  *branch.direction /= length;
}

/// A label becomes a branch's in the case, so it follows the case's rules.
void checkLabel(const std::string& label, std::size_t number, const fs::path& file) {
  const std::string place = file.string() + ": branch number " + std::to_string(number + 1);
  if (label.empty()) throw invalidInput(place + " has an empty label");
  if (const auto fault = formats::checkText(label, formats::kMaxNameBytes, "its label"))
    throw invalidInput(place + ": " + fault->message + " in its label");
}

using Labels = std::map<std::string, std::size_t>;

/// Index of each label, after the checks that need one branch or a pair of them.
Labels checkBranches(std::vector<SeedBranch>& branches, const fs::path& file) {
  Labels index;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    SeedBranch& branch = branches[i];
    checkLabel(branch.label, i, file);
    if (!index.emplace(branch.label, i).second)
      throw invalidInput(named(file, branch) +
                         "another branch has this label; expected unique ones");
    checkPoints(branch, file);
    normaliseDirection(branch, file);
  }
  for (const auto& branch : branches)
    if (branch.parent && !index.contains(*branch.parent))
      throw invalidInput(named(file, branch) + "its parent \"" + *branch.parent +
                         "\" is unknown; expected the label of another branch");
  return index;
}

[[noreturn]] void refuseCycle(const std::vector<SeedBranch>& branches,
                              const std::vector<std::size_t>& chain, std::size_t again,
                              const fs::path& file) {
  std::string path;
  const auto begin = std::find(chain.begin(), chain.end(), again);
  for (auto i = begin; i != chain.end(); ++i) path += "\"" + branches[*i].label + "\" -> ";
  throw invalidInput(named(file, branches[again]) + "is its own ancestor (" + path + "\"" +
                     branches[again].label + "\"); expected parents without a cycle");
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
      if (!branches[at].parent) break;
      at = index.at(*branches[at].parent);
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

std::vector<SeedBranch> readSeeds(const fs::path& file) {
  const auto json = parseJson(readText(file), file);
  const JsonPlace root(json, file.string());
  std::vector<SeedBranch> branches =
      root.has("markups") ? parseMarkups(root, stemOf(file)) : parseSeeds(root);
  if (branches.empty())
    throw invalidInput(file.string() + ": holds no seeds; expected at least one branch");
  const Labels index = checkBranches(branches, file);
  return parentsFirst(std::move(branches), index, file);
}

void checkSeedsInside(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                      const fs::path& file) {
  Eigen::Vector3d low = geometry.origin, high = geometry.origin;
  for (int corner = 1; corner < 8; ++corner) {
    Eigen::Vector3d index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a & 1) != 0 ? geometry.size[static_cast<std::size_t>(a)] - 1 : 0;
    low = low.cwiseMin(geometry.worldFromIndex(index));
    high = high.cwiseMax(geometry.worldFromIndex(index));
  }
  for (const auto& branch : seeds)
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const Eigen::Vector3d& p = branch.points[i].position;
      if (geometry.containsWorld(p)) continue;
      std::string hint;
      if (geometry.containsWorld({-p.x(), -p.y(), p.z()}))
        hint =
            "; with x and y negated it would lie inside, so the coordinate system may be misstated";
      throw invalidInput(named(file, branch) + "point " + std::to_string(i + 1) + " at " + text(p) +
                         " mm LPS (voxel " + text(geometry.indexFromWorld(p)) +
                         ") lies outside the volume; expected a point between " + text(low) +
                         " and " + text(high) + " mm, within its " +
                         std::to_string(geometry.size[0]) + " x " +
                         std::to_string(geometry.size[1]) + " x " +
                         std::to_string(geometry.size[2]) + " voxels" + hint);
    }
}

void writeSeeds(const std::vector<SeedBranch>& seeds, const fs::path& file) {
  const std::string text = seedsText(seeds);
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
  if (!written) throw failed(file.string() + ": " + written.error().text());
}

}  // namespace lumen::convert
