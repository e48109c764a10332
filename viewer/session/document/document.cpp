// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/document.h"

#include <array>
#include <set>
#include <variant>

#include <sys/stat.h>

namespace lumen::viewer {

namespace {

template <class T>
std::size_t sizeOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

std::size_t sizeOf(const formats::Case& value) {
  const formats::CenterlineTree& tree = value.tree;
  std::size_t sum = sizeof(value) + sizeOf(tree.centre) + sizeOf(tree.direction) +
                    sizeOf(tree.radius) + sizeOf(tree.height) + sizeOf(tree.parent) +
                    sizeOf(tree.branch) + sizeOf(tree.inlierRate) + sizeOf(tree.branches) +
                    sizeOf(tree.links);
  if (value.points) sum += sizeOf(value.points->offset) + sizeOf(value.points->position);
  if (value.models)
    sum +=
        sizeOf(value.models->offset) + sizeOf(value.models->centre) + sizeOf(value.models->width);
  if (value.motion)
    sum += sizeOf(value.motion->time) + sizeOf(value.motion->node) + sizeOf(value.motion->pose);
  for (const formats::NodeArray& array : value.nodeArrays)
    std::visit([&sum](const auto& values) { sum += sizeOf(values); }, array.values);
  for (const formats::OtherChunk& chunk : value.otherChunks) sum += sizeOf(chunk.bytes);
  return sum;
}

std::size_t sizeOf(const convert::Volume& volume) {
  return std::visit([](const auto& voxels) { return sizeOf(voxels); }, volume.voxels);
}

std::size_t sizeOf(const convert::MeshFile& mesh) {
  return sizeOf(mesh.mesh.position) + sizeOf(mesh.mesh.triangle) + sizeOf(mesh.group);
}

std::size_t sizeOf(const Seeds& seeds) {
  std::size_t sum = seeds.capacity() * sizeof(convert::SeedBranch);
  for (const convert::SeedBranch& seed : seeds) sum += sizeOf(seed.points);
  return sum;
}

}  // namespace

std::string roleName(FileRole role) {
  constexpr std::array kNames = {"volume", "second", "labels", "case", "truth", "seeds", "mesh"};
  return kNames[static_cast<std::size_t>(role)];
}

FileStamp readFileStamp(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  return {std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec,
          static_cast<std::uintmax_t>(status.st_size), static_cast<std::uintmax_t>(status.st_ino)};
}

const OpenFile* Document::fileOf(FileRole role) const {
  for (const OpenFile& file : files)
    if (file.role == role) return &file;
  return nullptr;
}

std::string Document::labelOf(FileRole role) const {
  const OpenFile* file = fileOf(role);
  return file != nullptr ? file->label : std::string();
}

std::set<std::string_view> vesselLabels(const std::shared_ptr<const formats::Case>& value) {
  std::set<std::string_view> labels;
  if (value)
    for (const formats::Branch& branch : value->tree.branches) labels.insert(branch.label);
  return labels;
}

std::set<std::string> takenLabels(const Document& document) {
  const std::set<std::string_view> vessels = vesselLabels(document.value);
  std::set<std::string> labels(vessels.begin(), vessels.end());
  for (const convert::SeedBranch& seed : *document.seeds) labels.insert(seed.label);
  return labels;
}

std::string numberedLabel(const std::string& stem, const std::set<std::string>& taken) {
  for (std::size_t i = 1;; ++i)
    if (std::string label = stem + "-" + std::to_string(i); !taken.contains(label)) return label;
}

std::size_t countBytes(const std::vector<const Document*>& documents) {
  std::set<const void*> seen;
  std::size_t sum = 0;
  const auto add = [&](const auto& part) {
    if (part && seen.insert(part.get()).second) sum += sizeOf(*part);
  };
  for (const Document* document : documents) {
    add(document->volume);
    add(document->second);
    if (document->labels) add(document->labels->voxels);
    add(document->value);
    add(document->truth);
    add(document->seeds);
    add(document->proposals);
    for (const OpenMesh& mesh : document->meshes) add(mesh.mesh);
  }
  return sum;
}

}  // namespace lumen::viewer
