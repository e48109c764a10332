// SPDX-License-Identifier: Apache-2.0
#include "unit/formats/sample_case.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "formats/container/crc32c.h"

namespace lumen::formats::test {
namespace {

void addNode(CenterlineTree& tree, Vec3f centre, float radius, std::int32_t parent,
             std::uint32_t branch) {
  tree.centre.push_back(centre);
  tree.direction.push_back({0, 0, 1});
  tree.radius.push_back(radius);
  tree.height.push_back(radius / 2);
  tree.parent.push_back(parent);
  tree.branch.push_back(branch);
}

Metadata richMetadata() {
  Metadata metadata;
  metadata.voxelSize = 0.2;
  metadata.source = SourceVolume{{512, 511, 300},
                                 {0.2, 0.25, 1.0},
                                 {-51.2, 1e-7, 3.0},
                                 {1, 0, 0, 0, 0, -1, 0, 1, 0},
                                 std::string(64, 'a')};
  Step track{"track", "lumen 0.1.0", {}};
  track.parameters["dark"] = true;
  track.parameters["seed"] = std::int64_t{9007199254740993};
  track.parameters["step"] = 2.0;
  track.parameters["lowest"] = std::numeric_limits<std::int64_t>::min();
  track.parameters["tiny"] = 5e-324;
  track.parameters["x-odd/name~"] = std::string("caf\xc3\xa9 \"quoted\" \\ end");
  metadata.steps = {track, Step{"fit", "lumen 0.1.0", {{"alpha", 1e-5}}}};
  return metadata;
}

}  // namespace

Case smallestCase() {
  Case value;
  addNode(value.tree, {1, 2, 3}, 1, kNoParent, 0);
  Branch branch;
  branch.label = "a";
  branch.nodeCount = 1;
  value.tree.branches = {branch};
  return value;
}

Case richCase() {
  Case value;
  value.metadata = richMetadata();
  CenterlineTree& tree = value.tree;
  addNode(tree, {0, 0, 0}, 2, -1, 0);
  addNode(tree, {0, 0, 1}, 2, 0, 0);
  addNode(tree, {0, 0, 2.5f}, 1.5f, 1, 0);
  addNode(tree, {0.1f, 3, 1}, 1, 1, 1);
  addNode(tree, {1e-20f, 4, 1}, 1, 3, 1);
  addNode(tree, {-3, 16777216.0f, 1.0f / 3.0f}, 1.75f, 2, 2);
  tree.inlierRate = {0, 0.25f, 0.7f, 1, 0.5f, 0.125f};
  tree.branches = {{"ICA left", BranchKind::Vessel, -1, 0, 3, StopReason::LeftVolume, 0.3f},
                   {"\xce\xb1/2", BranchKind::Vessel, 1, 3, 2, StopReason::MetBranch, {}},
                   {"dome", BranchKind::Aneurysm, 2, 5, 1, StopReason::EndOfSeeds, 0.0f}};
  value.points = PointSets{{0, 2, 2, 3, 3, 3, 4}, {{1, 2, 3}, {-1, 0.5f, 0}, {7, 8, 9}, {0, 0, 1}}};
  value.models = BlobbyModels{Kernel::Cauchy, 0.2, 0.1, {0, 1, 2, 4, 4, 5, 6}, {}, {}};
  for (int j = 0; j < 6; ++j) {
    value.models->centre.push_back({static_cast<float>(j), 0.3f, -2});
    value.models->width.push_back(0.1f * static_cast<float>(j + 1));
  }
  return value;
}

Case fullCase() {
  Case value = richCase();
  value.tree.links = {{0, 4}, {2, 4}, {4, 5}};
  value.metadata.note = "synthetic, \xc2\xb5m";
  value.metadata.parentSha256 = std::string(64, 'b');
  value.metadata.pointQuantisation = PointQuantisation{14, 0.001};
  value.metadata.extensionsUsed = {"ACME_flow", "LAB2_tags"};
  value.nodeArrays = {{"ACME_flow.velocity", 3, "mm/s", std::vector<float>(18, 0.1f)},
                      {"LAB2_tags.kind", 1, "", std::vector<std::int32_t>{-1, 2, 3, 4, 5, 6}}};
  value.otherChunks = {{"aaaa", 7, true, 0, 3, {std::byte{1}, std::byte{2}, std::byte{3}}},
                       {"Z9zz", 1, false, 200, 99, {std::byte{0xff}}}};
  return value;
}

Case movingCase() {
  Case value = richCase();
  Motion& motion = value.motion.emplace();
  motion.time = {0.1, 0.25, 0.7};
  motion.period = 0.9;
  motion.node = {1, 2, 5};
  for (int t = 0; t < 3; ++t)
    for (const std::uint32_t node : motion.node) {
      Pose pose;
      pose.centre = value.tree.centre[node];
      pose.centre.x += 0.25f * static_cast<float>(t);
      if (t == 1) pose.rotation = {0.6f, 0, 0, 0.8f};
      pose.factor = 1.0f + 0.125f * static_cast<float>(t);
      motion.pose.push_back(pose);
    }
  return value;
}

Case longCase(std::size_t nodes, std::size_t pointsPerNode, std::size_t blobsPerNode) {
  Case value;
  value.points.emplace().offset = {0};
  value.models.emplace().offset = {0};
  for (std::size_t i = 0; i < nodes; ++i) {
    const float z = 0.137f * static_cast<float>(i);
    addNode(value.tree, {std::sin(z), std::cos(z), z}, 1, static_cast<std::int32_t>(i) - 1, 0);
    for (std::size_t k = 0; k < pointsPerNode; ++k)
      value.points->position.push_back({z + 1, 0.1f * static_cast<float>(k), std::sin(z)});
    for (std::size_t j = 0; j < blobsPerNode; ++j) {
      value.models->centre.push_back({std::cos(z), z, static_cast<float>(j)});
      value.models->width.push_back(0.5f + 0.01f * static_cast<float>(j));
    }
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
    value.models->offset.push_back(static_cast<std::uint32_t>(value.models->width.size()));
  }
  Branch branch;
  branch.label = "long";
  branch.nodeCount = static_cast<std::uint32_t>(nodes);
  value.tree.branches = {branch};
  return value;
}

std::size_t entryOf(const Bytes& file, const std::string& type) {
  const auto count = loadLittle<std::uint32_t>(file.data() + 24);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = kHeaderSize + i * kTableEntrySize;
    if (chunkName(loadLittle<ChunkType>(file.data() + entry)) == type) return entry;
  }
  ADD_FAILURE() << "no chunk " << type;
  return kHeaderSize;
}

std::size_t dataOf(const Bytes& file, const std::string& type) {
  return static_cast<std::size_t>(loadLittle<std::uint64_t>(&file[entryOf(file, type) + 8]));
}

void resign(Bytes& file) {
  const std::span<const std::byte> all(file);
  const std::size_t count =
      std::min<std::size_t>(loadLittle<std::uint32_t>(&file[24]), file.size() / 64 - 1);
  for (std::size_t i = 0; i < count; ++i) {
    std::byte* entry = &file[kHeaderSize + i * kTableEntrySize];
    const auto offset = loadLittle<std::uint64_t>(entry + 8);
    const auto size = loadLittle<std::uint64_t>(entry + 16);
    if (offset <= file.size() && size <= file.size() - offset)
      storeLittle(entry + 32, crc32c(all.subspan(offset, size)));
  }
  storeLittle(&file[28], crc32c(all.subspan(kHeaderSize, count * kTableEntrySize)));
  storeLittle(&file[60], crc32c(all.first(60)));
}

Bytes tampered(const std::function<void(Bytes&)>& change) {
  Bytes file = encodeBinary(richCase());
  change(file);
  resign(file);
  return file;
}

Bytes tamperedFull(const std::function<void(Bytes&)>& change) {
  Bytes file = encodeBinary(fullCase());
  change(file);
  resign(file);
  return file;
}

}  // namespace lumen::formats::test
