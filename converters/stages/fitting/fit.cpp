// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/fit.h"

#include "converters/stages/fitting/node_models.h"
#include "converters/stages/fitting/open_edges.h"

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

}  // namespace lumen::convert
