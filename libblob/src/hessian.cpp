// SPDX-License-Identifier: Apache-2.0
#include "hessian.h"

#include <cmath>
#include <limits>

#include "formats/field/blend.h"
#include "nodes_in_doubles.h"

namespace lumen::blob {
namespace {

field::Jet<2> jetAt(const blob_model& model, std::uint32_t flags, const double* point,
                    std::uint32_t node) {
  const NodesInDoubles nodes(model);
  return (flags & BLOB_LOCAL) != 0 ? nodes.model<2>(node, point)
                                   : field::blend<2>(nodes, node, point);
}

}  // namespace

void evaluateHessian(const blob_model& model, std::uint32_t flags, const double* point,
                     std::uint32_t node, blob_hessian& answer) noexcept {
  const field::Jet<2> f = jetAt(model, flags, point, node);
  const double* g = f.gradient;
  const double* h = f.hessian;
  answer.value = f.value;
  for (int i = 0; i < 3; ++i) answer.gradient[i] = g[i];
  for (int i = 0; i < 6; ++i) answer.hessian[i] = h[i];

  // g^T H g, and g^T adj(H) g; R. Goldman, Curvature formulas for implicit curves and surfaces,
  // 2005
  const double hg[3] = {h[0] * g[0] + h[3] * g[1] + h[4] * g[2],
                        h[3] * g[0] + h[1] * g[1] + h[5] * g[2],
                        h[4] * g[0] + h[5] * g[1] + h[2] * g[2]};
  const double bent = g[0] * hg[0] + g[1] * hg[1] + g[2] * hg[2];
  const double adjoint =
      g[0] * g[0] * (h[1] * h[2] - h[5] * h[5]) + g[1] * g[1] * (h[0] * h[2] - h[4] * h[4]) +
      g[2] * g[2] * (h[0] * h[1] - h[3] * h[3]) + 2.0 * g[0] * g[1] * (h[4] * h[5] - h[3] * h[2]) +
      2.0 * g[0] * g[2] * (h[3] * h[5] - h[4] * h[1]) +
      2.0 * g[1] * g[2] * (h[3] * h[4] - h[5] * h[0]);
  const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  answer.mean_curvature =
      square > 0 ? (bent - square * (h[0] + h[1] + h[2])) / (2.0 * square * std::sqrt(square))
                 : nan;
  answer.gaussian_curvature = square > 0 ? adjoint / (square * square) : nan;
}

}  // namespace lumen::blob
