// SPDX-License-Identifier: Apache-2.0
#include "shape_fit.h"

#include <cmath>

#include "formats/case/blobby.h"

namespace lumen::reproduce {
namespace {

using convert::fitting::Blob;

/// Blobs evenly along the skeleton; two in one place would have a radius of 1 mm.
std::vector<Blob> startOf(const ConvolutionShape& shape, const Vector3d& centre,
                          const convert::fitting::EnergyParameters& energy) {
  const double width =
      formats::widthForRadius(energy.kernel, energy.kernelParameter, 1, energy.isoLevel, 2);
  const auto last = static_cast<double>(shape.skeleton.size() - 1);
  std::vector<Blob> blobs;
  for (std::size_t i = 0; i < shape.startBlobs; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(shape.startBlobs);
    const Vector3d p = shape.skeleton[static_cast<std::size_t>(std::lround(share * last))] - centre;
    blobs.push_back({p.x(), p.y(), p.z(), width});
  }
  return blobs;
}

}  // namespace

formats::BlobbyModels fitShape(const ConvolutionShape& shape, const std::vector<Vector3d>& points,
                               const convert::fitting::LocalModelOptions& options) {
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : shape.skeleton) centre += p;
  centre /= static_cast<double>(shape.skeleton.size());
  std::vector<formats::Vec3d> local;
  for (const Vector3d& p : points) {
    const Vector3d q = p - centre;
    local.push_back({q.x(), q.y(), q.z()});
  }
  const std::vector<Blob> start = startOf(shape, centre, options.energy);
  convert::fitting::FitWorkspace workspace;
  const convert::fitting::NodeData node{local, 1, {1, 0, 0}, {}, start};
  formats::BlobbyModels out;
  for (const Blob& b : fitLocalModel(options, node, Progress(), workspace).blobs) {
    const Vector3d c = Vector3d(b.x, b.y, b.z) + centre;
    out.centre.push_back(
        {static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())});
    out.width.push_back(static_cast<float>(b.width));
  }
  out.offset = {0, static_cast<std::uint32_t>(out.width.size())};
  return out;
}

std::vector<Vector3d> withNoise(const ConvolutionShape& shape, std::vector<Vector3d> points,
                                double noise, Random random) {
  for (Vector3d& p : points) {
    p -= noise * random.normal() * shape.surface().at(p).gradient.normalized();
  }
  return points;
}

}  // namespace lumen::reproduce
