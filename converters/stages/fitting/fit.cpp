// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/fit.h"

#include <algorithm>
#include <string>

#include "converters/base/options/edit_steps.h"
#include "converters/stages/fitting/node_models.h"
#include "converters/stages/fitting/open_edges.h"
#include "formats/case/enum_names.h"

namespace lumen::convert {

void fit(formats::Case& target, const FitOptions& options, Progress& progress) {
  if (!target.points) {
    throw invalidInput("fit: the case has no wall points; expected a tracked case with its points");
  }
  const FitOptions full = options.resolved(target.metadata.voxelSize.value_or(0.0));
  fitting::NodeModels models(target, full);
  const auto passes = static_cast<std::size_t>(1 + full.seamSweeps);
  progress.begin("fit", passes * target.tree.nodeCount());
  models.fit(progress);
  for (int sweep = 0; sweep < full.seamSweeps; ++sweep) models.refine(progress);
  progress.end();
  target.models = models.assemble();
  openEdges(target);
  target.metadata.steps.push_back({"fit", "lumen " LUMEN_VERSION, full.parameters()});
}

namespace {

constexpr int kMostWhole = 1000;  ///< bound for an option that counts; a file may have any value

FitOptions readOptions(const formats::Step& step) {
  FitOptions options;
  OptionTable table;
  options.addRows(table);
  table.takeRecorded(step);
  for (auto* value : {&options.accuracy, &options.maxDistance, &options.minWidth, &options.isoLevel,
                      &options.kernelParameter})
    if (*value && !(**value > 0)) value->reset();  // no fit has such, but a file may
  for (auto* count : {&options.maxSubdivisions, &options.neighbourhood, &options.seamSweeps})
    *count = std::min(*count, kMostWhole);
  return options;
}

/// Voxels: the assumed iso-level of a case that states neither a voxel nor options.
constexpr double kVoxelsOfLevel = 0.5;

double voxelOf(const formats::Case& value, const FitOptions& options) {
  return value.metadata.voxelSize.value_or(options.isoLevel.value_or(0) / kVoxelsOfLevel);
}

void takeFunction(FitOptions& options, const formats::BlobbyModels& models) {
  options.kernel = models.kernel;
  options.kernelParameter = models.kernelParameter;
  if (!field::hasParameter(models.kernel)) options.kernelParameter.reset();
  options.isoLevel = models.isoLevel;
}

std::vector<std::uint32_t> checkedNodes(const formats::Case& target,
                                        std::span<const std::uint32_t> nodes) {
  if (!target.models)
    throw invalidInput("refit: the case has no models; expected one that was fitted as a whole");
  if (!target.points)
    throw invalidInput("refit: the case has no wall points; expected the ones it was fitted to");
  std::vector<std::uint32_t> out(nodes.begin(), nodes.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (!out.empty() && out.back() >= target.tree.nodeCount())
    throw invalidInput("refit: found node " + std::to_string(out.back()) +
                       ", expected one from 0 to " + std::to_string(target.tree.nodeCount() - 1));
  return out;
}

/// Opens edges that touch one of some nodes or a neighbour of one.
void openNear(formats::Case& target, std::span<const std::uint32_t> nodes) {
  const formats::Neighbours neighbours(target.tree);
  std::vector<bool> isNear(target.tree.nodeCount(), false);
  for (const std::uint32_t node : nodes) {
    isNear[node] = true;
    for (const std::uint32_t near : neighbours.of(node)) isNear[near] = true;
  }
  openEdges(target, [&](std::uint32_t node) {
    const std::int32_t parent = target.tree.parent[node];
    return isNear[node] ||
           (parent != formats::kNoParent && isNear[static_cast<std::size_t>(parent)]);
  });
}

}  // namespace

FitOptions recordedFitOptions(const formats::Case& value) {
  FitOptions options;
  if (const formats::Step* step = lastStep(value.metadata, "fit")) options = readOptions(*step);
  if (value.models) takeFunction(options, *value.models);
  try {
    (void)options.resolved(voxelOf(value, options));
  } catch (const Error&) {
    options = {};
    if (value.models) takeFunction(options, *value.models);
  }
  return options;
}

void refit(formats::Case& target, std::span<const std::uint32_t> nodes, const FitOptions& options,
           Progress& progress) {
  const std::vector<std::uint32_t> due = checkedNodes(target, nodes);
  if (due.empty()) return;
  FitOptions full = options;
  takeFunction(full, *target.models);
  full = full.resolved(voxelOf(target, full));
  fitting::NodeModels models(target, full, due);
  progress.begin("fit", static_cast<std::size_t>(1 + full.seamSweeps) * due.size());
  models.fit(progress);
  for (int sweep = 0; sweep < full.seamSweeps; ++sweep) models.refine(progress);
  progress.end();
  target.models = models.assemble();
  openNear(target, due);
}

}  // namespace lumen::convert
