// SPDX-License-Identifier: Apache-2.0
#include "hessian.h"

#include <cmath>
#include <limits>

#include "formats/field/blend.h"

namespace lumen::blob {
namespace {

// Interface of a model for field::blend(): the floats of the blocks, in doubles.
class NodesInDoubles {
public:
  explicit NodesInDoubles(const blob_model& model) : m_model(model) {}

  [[nodiscard]] const double* centre(std::uint32_t node) const {
    return m_model.nodes[node].centre;
  }
  template <class Visit>
  bool eachRival(std::uint32_t node, Visit&& visit) const {
    const NodeRecord& record = m_model.nodes[node];
    const NeighbourBlock* blocks = m_model.neighbours.data() + record.firstNeighbours;
    for (std::uint32_t b = 0; b < record.neighbourBlocks; ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        const NeighbourBlock& block = blocks[b];
        if (isPadding(block, lane)) return true;  // the remaining lanes are padding, too
        const field::Rival rival{{block.nx[lane], block.ny[lane], block.nz[lane]},
                                 block.c[lane],
                                 block.inverseTau[lane],
                                 block.node[lane]};
        if (!visit(rival)) return false;
      }
    return true;
  }
  template <int order>
  [[nodiscard]] field::Jet<order> model(std::uint32_t node, const double* point) const {
    const FieldNode& where = m_model.nodes[node].field;
    double at[3];
    for (int i = 0; i < 3; ++i)
      at[i] = (point[i] - m_model.nodes[node].centre[i]) + double{where.place[i]};
    return field::withKernel(kernelOf(m_model.field.kernel), [&](auto kernel) {
      return sumBlobs<decltype(kernel), order>(where, at);
    });
  }

private:
  // Not inlined, so that each loop gets all registers.
  template <class K, int order>
  [[nodiscard, gnu::noinline]] field::Jet<order> sumBlobs(const FieldNode& where,
                                                          const double* at) const {
    field::Jet<order> f;
    const BlobBlock* blocks = m_model.field.blocks.data() + where.block;
    for (std::uint32_t b = 0; b < where.blockCount; ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        const BlobBlock& block = blocks[b];
        if (!(block.w[lane] > 0)) continue;
        const double d[3] = {at[0] - double{block.x[lane]}, at[1] - double{block.y[lane]},
                             at[2] - double{block.z[lane]}};
        field::addBlob<K>(d, block.a[lane], block.w[lane], f);
      }
    return f;
  }

  const blob_model& m_model;
};

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
