// SPDX-License-Identifier: Apache-2.0
#include "converters/app/loss_report.h"

#include "converters/app/report.h"
#include "converters/common/error.h"

namespace lumen::app {

namespace {

using formats::Case;

/// Nothing for none.
std::string some(std::size_t count, const std::string& noun, const std::string& plural) {
  return count == 0 ? "" : counted(count, noun, plural);
}

std::string modelsText(const std::optional<formats::BlobbyModels>& models) {
  if (!models) return "";
  return "the models (" + counted(models->width.size(), "blob", "blobs") + ")";
}

std::string treeText(const formats::CenterlineTree& tree) {
  return "the tree (" + counted(tree.branches.size(), "branch", "branches") + ", " +
         counted(tree.nodeCount(), "node", "nodes") + ")";
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
  const std::string steps = some(metadata.steps.size(), "step", "steps");
  return "the provenance" + (steps.empty() ? "" : " (" + steps + ")");
}

/// The phrase for one part; empty if the case does not have it.
std::string partText(const Case& value, CasePart part) {
  switch (part) {
    case kTree:
      return treeText(value.tree);
    case kRates:
      return hasRates(value.tree) ? "inlier rates and stop reasons" : "";
    case kLinks:
      return some(value.tree.links.size(), "link", "links");
    case kPoints:
      return value.points ? some(value.points->position.size(), "wall point", "wall points") : "";
    case kModels:
      return modelsText(value.models);
    case kNodeArrays:
      return some(value.nodeArrays.size(), "node array", "node arrays");
    case kProvenance:
      return provenanceText(value.metadata);
    case kNote:
      return value.metadata.note.empty() ? "" : "the note";
    case kOtherChunks:
      return some(value.otherChunks.size(), "chunk of another program", "chunks of other programs");
    case kEveryPart:
      break;
  }
  return "";
}

}  // namespace

std::vector<std::string> lossesOf(const Case& value, const FileFormat& format) {
  std::vector<std::string> losses;
  for (unsigned part = 1; part < kEveryPart; part <<= 1) {
    if ((format.holds & part) != 0) continue;
    std::string text = partText(value, static_cast<CasePart>(part));
    if (!text.empty()) losses.push_back(std::move(text));
  }
  return losses;
}

void reportLosses(const Case& value, const FileFormat& format, const std::string& file,
                  Progress& progress) {
  const auto losses = lossesOf(value, format);
  if (losses.empty()) return;
  std::string text = file + ": " + std::string(format.name) + " does not hold ";
  for (std::size_t i = 0; i < losses.size(); ++i) {
    if (i > 0) text += i + 1 == losses.size() ? " and " : ", ";
    text += losses[i];
  }
  progress.warn(text);
}

}  // namespace lumen::app
