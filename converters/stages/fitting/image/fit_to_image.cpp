// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/fit_to_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/base/vectors.h"
#include "converters/stages/fitting/image/image_fit.h"
#include "formats/case/node_origin.h"

namespace lumen::convert {
namespace {

/// The blur of a volume whose slices are as thick as they are apart, in voxels: its own box and a
/// scanner of half a voxel.
constexpr double kUsualBlur = 0.6;

constexpr const char* kImageExtension = "LUMEN_image";
constexpr const char* kDeviationArray = "LUMEN_image.deviation";

/// The section's place and size, as the tree states them.
void moveNode(formats::CenterlineTree& tree, std::uint32_t node,
              const fitting::NodeSection& section) {
  const fitting::Outline& o = section.outline;
  tree.centre[node] = toVec3f(section.origin + o.centre.x() * section.u + o.centre.y() * section.v);
  tree.radius[node] = static_cast<float>(std::sqrt(o.area() / std::numbers::pi));
}

/// Replaces the node array of a case by standard deviations of radii, mm; 0 where none is known.
void setDeviations(formats::Case& value, std::vector<float> deviations) {
  auto& used = value.metadata.extensionsUsed;
  std::erase_if(value.nodeArrays, [](const auto& array) { return array.name == kDeviationArray; });
  std::erase(used, kImageExtension);
  used.emplace_back(kImageExtension);
  value.nodeArrays.push_back({kDeviationArray, 1, "mm", std::move(deviations)});
}

}  // namespace

ImageFitOptions recordedImageFit(const formats::Case& value, const Volume& volume) {
  ImageFitOptions options;
  options.blur = kUsualBlur * volume.geometry.spacing.minCoeff();
  if (const formats::Step* step = lastStep(value.metadata, "track"))
    if (const auto dark = step->parameters.find(kOption.dark.name); dark != step->parameters.end())
      if (const auto* is = std::get_if<bool>(&dark->second)) options.dark = *is;
  return options;
}

ImageFitReport fitToImage(formats::Case& target, const Volume& volume,
                          const ImageFitOptions& options, Progress& progress) {
  if (!target.points)
    throw invalidInput("the case has no wall points; expected a tracked case with its points");
  fitting::ImageFit fit(target, volume, options.dark, options.blur, progress);
  fit.run();
  ImageFitReport report;
  report.blur = fit.blur();
  const formats::PointSets& old = *target.points;
  formats::CenterlineTree tree = target.tree;
  auto origins = formats::readNodeOrigins(target);
  formats::PointSets points;
  points.offset.push_back(0);
  std::vector<float> deviations(tree.nodeCount(), 0.0F);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    std::vector<formats::Vec3f> wall;
    if (fit.isFitted(i)) wall = fit.wallPoints(i);
    if (wall.empty()) {
      wall.assign(old.position.begin() + old.offset[i], old.position.begin() + old.offset[i + 1]);
      ++report.kept;
    } else {
      moveNode(tree, i, fit.section(i));
      origins[i] = formats::NodeOrigin::Measured;
      deviations[i] = static_cast<float>(fit.deviation(i));
      ++report.nodes;
    }
    points.position.insert(points.position.end(), wall.begin(), wall.end());
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  target.tree = std::move(tree);
  if (target.motion)
    progress.warn("the motion is dropped, because its poses are those of the centres before");
  target.motion.reset();
  target.points = std::move(points);
  target.metadata.pointQuantisation.reset();
  formats::setNodeOrigins(target, origins);
  setDeviations(target, std::move(deviations));
  target.metadata.steps.push_back({"fit-image",
                                   "lumen " LUMEN_VERSION,
                                   {{"blur", report.blur}, {kOption.dark.name, options.dark}}});
  return report;
}

}  // namespace lumen::convert
