// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/thin_walls.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/shown_text.h"
#include "formats/container/printable.h"

namespace lumen::convert {
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
  std::vector<SheetSample> samples(position.size());
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
