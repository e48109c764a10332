// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/posed_case.h"

#include <cmath>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/motion.h"
#include "formats/case/validate.h"

namespace lumen::convert {
namespace {

using field::NodePose;
using formats::Case;

// Change of a radius below which blobs only move: a thousandth of the roundings of a fit.
constexpr double kSameRadius = 1e-6;

// Moves the blobs, and scales those of nodes whose radius changes, which are returned: they are
// where a fit starts.
std::vector<std::uint32_t> poseModels(const formats::CenterlineTree& rest,
                                      const std::vector<NodePose>& poses,
                                      formats::BlobbyModels& models) {
  std::vector<std::uint32_t> due;
  formats::carryOwned(rest, poses, models.offset, models.centre);
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    if (std::abs(poses[i].factor - 1) <= kSameRadius || models.offset[i] == models.offset[i + 1])
      continue;
    due.push_back(i);
    for (std::uint32_t k = models.offset[i]; k < models.offset[i + 1]; ++k)
      models.width[k] = static_cast<float>(poses[i].factor * models.width[k]);
  }
  return due;
}

void requireLegal(const Case& value) {
  if (const auto valid = formats::validate(value); !valid)
    throw invalidInput("at this time the case breaks a rule of the format: " +
                       valid.error().text());
}

}  // namespace

Case posedCase(const Case& source, double time, Progress& progress) {
  if (!source.motion)
    throw invalidInput("the case has no motion; expected one with poses over time");
  const std::vector<NodePose> poses = formats::posesAt(source.tree, *source.motion, time);
  Case out = source;
  out.motion.reset();
  formats::dropDependentChunks(out);
  formats::carryTree(poses, out.tree);
  if (out.points) {
    formats::carryOwned(source.tree, poses, out.points->offset, out.points->position);
    out.metadata.pointQuantisation.reset();
  }
  std::vector<std::uint32_t> due;
  if (out.models) due = poseModels(source.tree, poses, *out.models);
  out.metadata.steps.push_back({kPoseStep, "lumen " LUMEN_VERSION, {{"time", time}}});
  requireLegal(out);
  if (!due.empty() && !out.points)
    throw invalidInput("the radius of node " + std::to_string(due.front()) +
                       " is another at this time, and the case has no wall points to fit new "
                       "models to");
  if (!due.empty()) refit(out, due, recordedFitOptions(out), progress);
  return out;
}

}  // namespace lumen::convert
