// SPDX-License-Identifier: Apache-2.0
#include "converters/app/loss_report.h"

#include <array>
#include <cstdint>

#include "converters/common/error.h"

namespace lumen::app {

namespace {

using formats::Case;

enum Part : unsigned {
  kTree = 1u << 0,
  kRates = 1u << 1,
  kLinks = 1u << 2,
  kPoints = 1u << 3,
  kModels = 1u << 4,
  kNodeArrays = 1u << 5,
  kProvenance = 1u << 6,
  kNote = 1u << 7,
  kOtherChunks = 1u << 8,
  kEverything = (1u << 9) - 1,
};

struct Capacity {
  std::string_view format;
  unsigned parts;
};

/// Formats that are not listed hold nothing but the surface.
constexpr auto kCapacities = std::to_array<Capacity>({
    {"lumen", kEverything},
    {"lumen.json", kEverything},
});

std::string countedIfAny(std::size_t count, const std::string& noun, const std::string& plural) {
  if (count == 0) return "";
  return std::to_string(count) + " " + (count == 1 ? noun : plural);
}

std::string modelsText(const std::optional<formats::BlobbyModels>& models) {
  if (!models) return "";
  return "the models (" + countedIfAny(models->width.size(), "blob", "blobs") + ")";
}

std::string treeText(const formats::CenterlineTree& tree) {
  return "the tree (" + countedIfAny(tree.branches.size(), "branch", "branches") + ", " +
         countedIfAny(tree.nodeCount(), "node", "nodes") + ")";
}

bool hasRates(const formats::CenterlineTree& tree) {
  if (!tree.inlierRate.empty()) return true;
  for (const auto& branch : tree.branches)
    if (branch.meanInlierRate || branch.stopReason != formats::StopReason::Unknown) return true;
  return false;
}

std::string provenanceText(const formats::Metadata& metadata) {
  if (!metadata.source && !metadata.voxelSize && metadata.steps.empty() &&
      metadata.parentSha256.empty())
    return "";
  const std::string steps = countedIfAny(metadata.steps.size(), "step", "steps");
  return "the provenance" + (steps.empty() ? "" : " (" + steps + ")");
}

/// The phrase for one part; empty if the case does not have it.
std::string partText(const Case& value, Part part) {
  switch (part) {
    case kTree:
      return treeText(value.tree);
    case kRates:
      return hasRates(value.tree) ? "inlier rates and stop reasons" : "";
    case kLinks:
      return countedIfAny(value.tree.links.size(), "link", "links");
    case kPoints:
      return value.points ? countedIfAny(value.points->position.size(), "wall point", "wall points")
                          : "";
    case kModels:
      return modelsText(value.models);
    case kNodeArrays:
      return countedIfAny(value.nodeArrays.size(), "node array", "node arrays");
    case kProvenance:
      return provenanceText(value.metadata);
    case kNote:
      return value.metadata.note.empty() ? "" : "the note";
    case kOtherChunks:
      return countedIfAny(value.otherChunks.size(), "chunk of another program",
                          "chunks of other programs");
    case kEverything:
      break;
  }
  return "";
}

unsigned capacityOf(const FileFormat& format) {
  for (const Capacity& capacity : kCapacities)
    if (capacity.format == format.name) return capacity.parts;
  return 0;
}

}  // namespace

std::vector<std::string> lossesOf(const Case& value, const FileFormat& format) {
  const unsigned held = capacityOf(format);
  std::vector<std::string> losses;
  for (unsigned part = 1; part < kEverything; part <<= 1) {
    if ((held & part) != 0) continue;
    std::string text = partText(value, static_cast<Part>(part));
    if (!text.empty()) losses.push_back(std::move(text));
  }
  return losses;
}

void reportLosses(const Case& value, const FileFormat& format, const std::string& file, bool strict,
                  Progress& progress) {
  const auto losses = lossesOf(value, format);
  if (losses.empty()) return;
  std::string text = file + ": " + std::string(format.name) + " does not hold ";
  for (std::size_t i = 0; i < losses.size(); ++i) {
    if (i > 0) text += i + 1 == losses.size() ? " and " : ", ";
    text += losses[i];
  }
  if (strict) throw unsupported(text + "; without --strict they are left out");
  progress.warn(text);
}

}  // namespace lumen::app
