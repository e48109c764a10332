// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/wall_thickness.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/shown_text.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

constexpr std::uint32_t kLumenSide = 0, kOuterSide = 1;  // groups of thickWall()
constexpr double kOffOwn = 1e-3;     // thicknesses: nearer hits are the triangles of the vertex
constexpr double kThinShare = 0.95;  // a wall that was not thinned is thicker, chords included
constexpr std::size_t kMostShared = 5;
constexpr std::size_t kRayBlock = 1024;  // vertices between two looks at the progress

struct Ray {
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  bool isOfLumen = false,
       isOfOther = false;  // whether triangles of the side, and others, meet here
};

// The directions from the lumens into the wall: triangles of that side look into the lumen.
std::vector<Ray> raysOf(const CaseSurface& solid) {
  const TriangleMesh& mesh = solid.mesh;
  std::vector<Ray> rays(mesh.position.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const auto& [a, b, c] = mesh.triangle[t];
    const bool isOfLumen = solid.group[t] == kLumenSide;
    const Eigen::Vector3d area =
        (mesh.position[b] - mesh.position[a]).cross(mesh.position[c] - mesh.position[a]);
    for (const std::uint32_t v : mesh.triangle[t]) {
      (isOfLumen ? rays[v].isOfLumen : rays[v].isOfOther) = true;
      if (isOfLumen) rays[v].outward -= area;
    }
  }
  for (Ray& ray : rays) ray.outward.normalize();
  return rays;
}

struct Thickness {
  double mm = -1;                    // negative: not measured
  std::uint32_t other = UINT32_MAX;  // the node of the lumen behind the wall, if it is shared
};

using BranchPair = std::pair<std::uint32_t, std::uint32_t>;

struct SharedWall {
  double mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

std::vector<std::string> sentencesOf(const std::map<BranchPair, SharedWall>& found,
                                     const formats::CenterlineTree& tree) {
  std::vector<std::pair<BranchPair, SharedWall>> walls(found.begin(), found.end());
  std::stable_sort(walls.begin(), walls.end(),
                   [](const auto& a, const auto& b) { return a.second.mm < b.second.mm; });
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < std::min(kMostShared, walls.size()); ++i) {
    const auto& [pair, wall] = walls[i];
    std::string who = formats::printable(tree.branches[pair.first].label);
    who += pair.first == pair.second
               ? std::string(" shares with itself")
               : " and " + formats::printable(tree.branches[pair.second].label) + " share";
    sentences.push_back("the wall that " + who + " is down to " + shownNumber(wall.mm, 3) +
                        " mm thick at " + placeText(wall.place));
  }
  if (walls.size() > kMostShared)
    sentences.push_back("and so it is at " + std::to_string(walls.size() - kMostShared) +
                        " more pairs of branches that touch");
  return sentences;
}

}  // namespace

WallThickness measureWall(const CaseSurface& solid, const SeparatedField& field,
                          const Length& thickness, Progress& progress) {
  const TriangleMesh& mesh = solid.mesh;
  const std::vector<Ray> rays = raysOf(solid);
  const std::vector<double> radii = vesselRadii(solid, field);
  const TriangleTree tree(mesh);
  std::vector<Thickness> found(mesh.position.size());
  progress.begin("measuring the wall", found.size());
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t v) {
    if (v % kRayBlock == 0) {
      progress.check();
      progress.advance(std::min(kRayBlock, found.size() - v));
    }
    if (!rays[v].isOfLumen || rays[v].isOfOther) return;
    const auto hit =
        tree.firstHit(mesh.position[v], rays[v].outward, kOffOwn * thickness.at(radii[v]));
    if (!hit || solid.group[hit->triangle] > kOuterSide) return;
    found[v].mm = hit->distance;
    if (solid.group[hit->triangle] == kLumenSide)
      found[v].other = solid.node[mesh.triangle[hit->triangle][0]];
  });
  progress.end();
  WallThickness result;
  std::vector<double> all;
  std::map<BranchPair, SharedWall> shared;
  const auto& branch = field.source().tree.branch;
  for (std::size_t v = 0; v < found.size(); ++v) {
    const Thickness& here = found[v];
    if (here.mm < 0) continue;
    if (all.empty() || here.mm < result.least) {
      result.least = here.mm;
      result.place = mesh.position[v];
    }
    all.push_back(here.mm);
    const double share = here.mm / thickness.at(radii[v]);
    const auto bin = static_cast<std::size_t>(share / WallThickness::kStep);
    ++result.histogram[std::min(bin, result.histogram.size() - 1)];
    if (here.other == UINT32_MAX || share >= kThinShare) continue;
    SharedWall& wall = shared[std::minmax(branch[solid.node[v]], branch[here.other])];
    if (here.mm < wall.mm) wall = {here.mm, mesh.position[v]};
  }
  result.measured = all.size();
  if (!all.empty()) {
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    result.median = *middle;
  }
  result.shared = sentencesOf(shared, field.source().tree);
  return result;
}

namespace {

constexpr std::size_t kMostSentences = 5;
constexpr std::size_t kWallBlock = 1024;  // vertices between two reports of progress

struct ThinWall {
  double thickness = 0;
  std::uint32_t branch = 0, other = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

std::string sentenceOf(const ThinWall& wall, const formats::CenterlineTree& tree) {
  std::string between = "the wall of " + formats::printable(tree.branches[wall.branch].label);
  between += " where it touches ";
  between += wall.branch == wall.other ? std::string("itself")
                                       : formats::printable(tree.branches[wall.other].label);
  return between + " is down to " + shownNumber(wall.thickness, 3) + " mm thick at " +
         placeText(wall.place);
}

}  // namespace

std::vector<std::string> thinWalls(const CaseSurface& outer, const OffsetField& field,
                                   Progress& progress) {
  const auto& position = outer.mesh.position;
  std::vector<SeparatedSample> samples(position.size());
  std::vector<double> thickness(position.size(), 0);
  progress.begin("wall thickness", position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kWallBlock == 0) {
      progress.check();
      progress.advance(std::min(kWallBlock, position.size() - v));
    }
    if (!field.mayTouch(outer.node[v])) return;
    samples[v] = field.at(position[v], outer.node[v]);
    if (samples[v].isSeparated) thickness[v] = field.fromLumen(position[v], outer.node[v]);
  });
  progress.end();
  const formats::CenterlineTree& tree = field.source().tree;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ThinWall> found;
  for (std::size_t v = 0; v < position.size(); ++v) {
    if (!samples[v].isSeparated) continue;
    const std::pair<std::uint32_t, std::uint32_t> pair =
        std::minmax(tree.branch[samples[v].node], tree.branch[samples[v].other]);
    const ThinWall here{thickness[v], tree.branch[samples[v].node], tree.branch[samples[v].other],
                        position[v]};
    const auto [entry, isNew] = found.try_emplace(pair, here);
    if (!isNew && here.thickness < entry->second.thickness) entry->second = here;
  }
  std::vector<ThinWall> walls;
  for (const auto& entry : found) walls.push_back(entry.second);
  std::stable_sort(walls.begin(), walls.end(),
                   [](const ThinWall& a, const ThinWall& b) { return a.thickness < b.thickness; });
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < std::min(kMostSentences, walls.size()); ++i)
    sentences.push_back(sentenceOf(walls[i], tree));
  if (walls.size() > kMostSentences)
    sentences.push_back("and so it is at " + std::to_string(walls.size() - kMostSentences) +
                        " more pairs of branches that touch");
  return sentences;
}

}  // namespace lumen::convert
