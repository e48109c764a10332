// SPDX-License-Identifier: Apache-2.0
#include "weights.h"

#include "nodes_in_doubles.h"

namespace lumen::blob {

NodeWeights weighNodes(const blob_model& model, std::uint32_t flags, const double* point,
                       std::uint32_t node) noexcept {
  NodeWeights found;
  double sum = 0;
  if ((flags & BLOB_LOCAL) == 0) {
    const NodesInDoubles nodes(model);
    field::visitActiveNodes(node, [&](std::uint32_t k, field::ActiveNodes& active) {
      const double weight = field::blendWeight<1>(nodes, k, point, active).value;
      if (!(weight > 0)) return false;
      found.node[found.count] = k;
      found.weight[found.count++] = weight;
      sum += weight;
      return true;
    });
  }
  if (found.count == 0) {
    found.count = 1;
    found.node[0] = node;
    found.weight[0] = sum = 1;
  }
  for (unsigned i = 0; i < found.count; ++i) found.weight[i] /= sum;
  return found;
}

field::Vec displacementOf(const blob_pose& pose, const blob_pose& before, std::uint32_t node,
                          const double* point) noexcept {
  const NodePose &now = pose.pose[node], &then = before.pose[node];
  const field::Vec x = field::Vec{point[0], point[1], point[2]} - now.centre;
  // relative to the centres, so that small steps keep their digits
  const field::Vec rest = (1.0 / now.factor) * field::rotatedBack(now.rotation, x);
  const field::Vec was = then.factor * field::rotated(then.rotation, rest);
  return (now.centre - then.centre) + (x - was);
}

}  // namespace lumen::blob
