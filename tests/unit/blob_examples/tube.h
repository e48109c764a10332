// SPDX-License-Identifier: Apache-2.0
// A straight tube along x that is exactly round: every node has all blobs of the line.
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

/// Blobs of width 0.35 mm each half millimetre from x = 0 to 20; the radius is where halfway along
/// their sum falls to 0.1: 1.4 mm.
inline Model makeTube() {
  constexpr std::size_t kNodes = 41;
  std::vector<std::array<float, 3>> nodes, blobs;
  std::vector<float> radius(kNodes, 1.4F), width(kNodes * kNodes, 0.35F);
  std::vector<std::int32_t> parent;
  std::vector<std::uint32_t> offset{0};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes.push_back({0.5F * static_cast<float>(i), 0, 0});
    parent.push_back(static_cast<std::int32_t>(i) - 1);
    offset.push_back(static_cast<std::uint32_t>((i + 1) * kNodes));
    for (std::size_t j = 0; j < kNodes; ++j) blobs.push_back({0.5F * static_cast<float>(j), 0, 0});
  }
  blob_model_def def = blob_model_def_default();
  def.node_count = kNodes;
  def.centre = reinterpret_cast<const float(*)[3]>(nodes.data());
  def.radius = radius.data();
  def.parent = parent.data();
  def.blobs.offset = offset.data();
  def.blobs.centre = reinterpret_cast<const float(*)[3]>(blobs.data());
  def.blobs.width = width.data();
  blob_model* model = nullptr;
  return Model(blob_model_create(&def, &model) == BLOB_OK ? model : nullptr);
}

}  // namespace lumen::test
