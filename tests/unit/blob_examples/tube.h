// SPDX-License-Identifier: Apache-2.0
// Straight tubes along x that are exactly round: every node has all blobs of its line.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "blob.h"

namespace lumen::test {

struct CloseModel {
  void operator()(blob_model* model) const { blob_model_close(model); }
};
using Model = std::unique_ptr<blob_model, CloseModel>;

/// Straight tubes of 20 mm along x, each from (0, y, 0). Its blobs of width 0.35 mm sit each half
/// millimetre; their sum falls to 0.1 at 1.4 mm from the middle of the axis.
inline Model makeTubes(const std::vector<float>& offsetsY) {
  constexpr std::size_t kNodes = 41;
  std::vector<std::array<float, 3>> nodes, blobs;
  std::vector<std::int32_t> parent;
  std::vector<std::uint32_t> offset{0};
  for (const float y : offsetsY)
    for (std::size_t i = 0; i < kNodes; ++i) {
      parent.push_back(i == 0 ? -1 : static_cast<std::int32_t>(nodes.size()) - 1);
      nodes.push_back({0.5F * static_cast<float>(i), y, 0});
      for (std::size_t j = 0; j < kNodes; ++j)
        blobs.push_back({0.5F * static_cast<float>(j), y, 0});
      offset.push_back(static_cast<std::uint32_t>(blobs.size()));
    }
  const std::vector<float> radius(nodes.size(), 1.4F), width(blobs.size(), 0.35F);
  blob_model_def def = blob_model_def_default();
  def.node_count = nodes.size();
  def.centre = reinterpret_cast<const float(*)[3]>(nodes.data());
  def.radius = radius.data();
  def.parent = parent.data();
  def.blobs.offset = offset.data();
  def.blobs.centre = reinterpret_cast<const float(*)[3]>(blobs.data());
  def.blobs.width = width.data();
  blob_model* model = nullptr;
  return Model(blob_model_create(&def, &model) == BLOB_OK ? model : nullptr);
}

inline Model makeTube() {
  return makeTubes({0});
}

}  // namespace lumen::test
