// SPDX-License-Identifier: Apache-2.0
// A model as field::blend() reads it.
#pragma once

#include <cstdint>

#include "formats/field/blend.h"
#include "model.h"

namespace lumen::blob {

/// Interface of a model for field::blend(): the floats of the blocks, in doubles.
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

}  // namespace lumen::blob
