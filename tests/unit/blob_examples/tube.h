// SPDX-License-Identifier: Apache-2.0
// Tubes that are exactly round where they are straight: every node has all blobs of its line.
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

/// Tubes with their nodes half a millimetre apart on each line. Blobs of width 0.35 mm sit in all nodes
/// of a line; their sum falls to 0.1 at 1.4 mm from the middle of a straight axis.
inline Model makeTubesAlong(const std::vector<std::vector<std::array<float, 3>>>& lines) {
  std::vector<std::array<float, 3>> nodes, blobs;
  std::vector<std::int32_t> parent;
  std::vector<std::uint32_t> offset{0};
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) {
      parent.push_back(i == 0 ? -1 : static_cast<std::int32_t>(nodes.size()) - 1);
      nodes.push_back(line[i]);
      blobs.insert(blobs.end(), line.begin(), line.end());
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

/// Straight tubes along x, each from (0, y, 0), of 20 mm if they have 41 nodes.
inline Model makeTubes(const std::vector<float>& offsetsY, std::size_t nodes = 41) {
  std::vector<std::vector<std::array<float, 3>>> lines;
  for (const float y : offsetsY) {
    auto& line = lines.emplace_back();
    for (std::size_t i = 0; i < nodes; ++i) line.push_back({0.5F * static_cast<float>(i), y, 0});
  }
  return makeTubesAlong(lines);
}

inline Model makeTube() {
  return makeTubes({0});
}

}  // namespace lumen::test
