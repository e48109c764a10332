// SPDX-License-Identifier: Apache-2.0
// Cases of beads: every node's model is one ball of the node's own radius, so that a person sees where
// the lumen is.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case.h"

namespace lumen::formats::test {

/// A case without nodes whose models are of Cauchy's kernel, T being 0.1 mm.
inline Case noBeads() {
  Case value;
  value.models = BlobbyModels{Kernel::Cauchy, 0.2, 0.1, {0}, {}, {}};
  return value;
}

/// Appends a model of one ball.
inline void addBall(BlobbyModels& models, const Vec3f& centre, float radius) {
  models.centre.push_back(centre);
  models.width.push_back(static_cast<float>(
      widthForRadius(models.kernel, models.kernelParameter, double{radius}, models.isoLevel)));
  models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
}

/// Appends a branch with a node at every place, and its ball if the case has models; returns its first
/// node.
inline std::uint32_t addBeads(Case& value, const std::string& label,
                              const std::vector<Vec3f>& places, float radius,
                              std::int32_t parent = kNoParent) {
  CenterlineTree& tree = value.tree;
  const auto first = static_cast<std::uint32_t>(tree.nodeCount());
  Branch branch;
  branch.label = label;
  branch.parentNode = parent;
  branch.firstNode = first;
  branch.nodeCount = static_cast<std::uint32_t>(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3f &from = places[i > 0 ? i - 1 : i], &to = places[i > 0 ? i : i + 1];
    const float x = to.x - from.x, y = to.y - from.y, z = to.z - from.z;
    const float length = std::sqrt(x * x + y * y + z * z);
    tree.direction.push_back({x / length, y / length, z / length});
    tree.centre.push_back(places[i]);
    tree.radius.push_back(radius);
    tree.height.push_back(length);
    tree.parent.push_back(i == 0 ? parent : static_cast<std::int32_t>(first + i - 1));
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    if (value.models) addBall(*value.models, places[i], radius);
  }
  tree.branches.push_back(std::move(branch));
  return first;
}

/// `count` places along x from `x` on, `step` apart.
inline std::vector<Vec3f> alongX(float x, float step, int count, float y = 0) {
  std::vector<Vec3f> places;
  for (int i = 0; i < count; ++i) places.push_back({x + step * static_cast<float>(i), y, 0});
  return places;
}

}  // namespace lumen::formats::test
