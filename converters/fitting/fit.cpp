// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/fit.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/fitting/local_model.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using fitting::Blob;
using formats::Vec3d;
using formats::Vec3f;

/// From case coordinates (mm, LPS) to the frame of a node's fit: x' = (x - centre) * scale.
struct Frame {
  Vec3d centre;
  double scale;

  [[nodiscard]] Vec3d toLocal(const Vec3f& p) const {
    return {(p.x - centre.x) * scale, (p.y - centre.y) * scale, (p.z - centre.z) * scale};
  }
  [[nodiscard]] Vec3f toCase(const Blob& b) const {
    return {static_cast<float>(centre.x + b.x / scale), static_cast<float>(centre.y + b.y / scale),
            static_cast<float>(centre.z + b.z / scale)};
  }
};

/// The unit in which the voxel measures fitting::kReferenceVoxel; without a voxel size, the
/// iso-level stands for half a voxel.
double frameScale(const formats::Case& value, const FitOptions& options) {
  const double voxel = value.metadata.voxelSize.value_or(0.0);
  return fitting::kReferenceVoxel / (voxel > 0 ? voxel : 2.0 * *options.isoLevel);
}

fitting::LocalModelOptions localOptions(const FitOptions& o, double scale) {
  fitting::LocalModelOptions local;
  local.energy = {o.kernel,         *o.kernelParameter, *o.isoLevel * scale,
                  o.cohesionWeight, o.curvatureWeight,  o.cohesionScale};
  local.maxSubdivisions = o.maxSubdivisions;
  local.accuracy = *o.accuracy * scale;
  local.maxDistance = *o.maxDistance * scale;
  local.minWidth = *o.minWidth * scale;
  return local;
}

struct Worker {
  fitting::LocalModel model;
  std::vector<Vec3d> points;
};

void gatherPoints(const formats::PointSets& points, const std::vector<std::uint32_t>& nodes,
                  const Frame& frame, std::vector<Vec3d>& out) {
  out.clear();
  for (const std::uint32_t node : nodes) {
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k) {
      out.push_back(frame.toLocal(points.position[k]));
    }
  }
}

formats::BlobbyModels assemble(const formats::Case& value, const FitOptions& options, double scale,
                               const std::vector<std::vector<Blob>>& perNode) {
  formats::BlobbyModels models;
  models.kernel = options.kernel;
  models.kernelParameter = *options.kernelParameter;
  models.isoLevel = *options.isoLevel;
  models.offset.reserve(perNode.size() + 1);
  models.offset.push_back(0);
  for (std::size_t i = 0; i < perNode.size(); ++i) {
    const Vec3f& c = value.tree.centre[i];
    const Frame frame{{c.x, c.y, c.z}, scale};
    for (const Blob& blob : perNode[i]) {
      models.centre.push_back(frame.toCase(blob));
      models.width.push_back(static_cast<float>(blob.width / scale));
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  return models;
}

}  // namespace

void fit(formats::Case& target, const FitOptions& options, Progress& progress) {
  if (!target.points) {
    throw invalidInput("fit: the case has no wall points; expected a tracked case with its points");
  }
  const FitOptions full = options.resolved(target.metadata.voxelSize.value_or(0.0));
  const double scale = frameScale(target, full);
  const fitting::LocalModelOptions local = localOptions(full, scale);
  const formats::CenterlineTree& tree = target.tree;
  const formats::Neighbours neighbours(tree);
  std::vector<std::vector<Blob>> perNode(tree.nodeCount());
  tbb::enumerable_thread_specific<Worker> workers([&local] {
    return Worker{fitting::LocalModel(local), {}};
  });

  progress.begin("fit", tree.nodeCount());
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t i) {
    progress.check();
    Worker& worker = workers.local();
    const Vec3f &c = tree.centre[i], &d = tree.direction[i];
    const Frame frame{{c.x, c.y, c.z}, scale};
    gatherPoints(*target.points,
                 neighbours.within(static_cast<std::uint32_t>(i), full.neighbourhood), frame,
                 worker.points);
    const auto blobs =
        worker.model.fit(worker.points, tree.radius[i] * scale, {d.x, d.y, d.z}, progress);
    perNode[i].assign(blobs.begin(), blobs.end());
    progress.advance();
  });
  progress.end();

  target.models = assemble(target, full, scale, perNode);
  target.metadata.steps.push_back({"fit", "lumen " LUMEN_VERSION, full.parameters()});
}

}  // namespace lumen::convert
