// SPDX-License-Identifier: Apache-2.0
#include "formats/field/blended_field.h"

namespace lumen::field {
namespace {

Rival makeRival(const TreeView& tree, std::uint32_t i, std::uint32_t k, double tau) {
  Rival rival{};
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = double{tree.centre[k][axis]} - double{tree.centre[i][axis]};
    rival.n[axis] = -2.0 * offset;
    square += offset * offset;
  }
  const double ri = tree.radius[i], rk = tree.radius[k];
  rival.c = square - rk * rk + ri * ri;
  rival.inverseTau = 1.0 / tau;
  rival.node = k;
  return rival;
}

}  // namespace

BlendedField::BlendedField(const TreeView& tree, const ModelsView& models)
    : m_kernel(models.kernel),
      m_level(models.level),
      m_offset(models.offset, models.offset + tree.nodeCount + 1) {
  const Neighbourhood edges = findEdges(tree);
  const std::vector<std::uint32_t> lender = findLenders(edges, models.offset);
  const std::vector<double> spacing = measureSpacings(tree, edges);
  m_around = findNeighbourhood(tree, edges);
  m_nodes.reserve(tree.nodeCount);
  m_rivals.reserve(m_around.node.size());
  for (std::uint32_t i = 0; i < tree.nodeCount; ++i) {
    const float* c = tree.centre[i];
    m_nodes.push_back({{c[0], c[1], c[2]}, tree.radius[i], lender[i]});
    for (std::uint32_t e = m_around.offset[i]; e < m_around.offset[i + 1]; ++e) {
      const std::uint32_t k = m_around.node[e];
      const double mean = 0.5 * (spacing[i] + spacing[k]);
      m_rivals.push_back(
          makeRival(tree, i, k, blendingWidth(tree, i, k, m_around.isEdge[e], mean)));
    }
  }
  m_blobs.reserve(m_offset.back());
  for (std::uint32_t j = 0; j < m_offset.back(); ++j) {
    const float* c = models.centre[j];
    const double width = models.width[j];
    m_blobs.push_back({{c[0], c[1], c[2]}, blobScale(m_kernel, models.parameter, width), width});
  }
}

std::span<const std::uint32_t> BlendedField::neighbours(std::uint32_t node) const {
  const std::uint32_t begin = m_around.offset[node];
  return std::span(m_around.node).subspan(begin, m_around.offset[node + 1] - begin);
}

std::uint32_t BlendedField::locate(const Vec& point) const {
  std::uint32_t best = kNowhere;
  double least = 0;
  for (std::uint32_t i = 0; i < m_nodes.size(); ++i) {
    const Node& node = m_nodes[i];
    const Vec fromCentre = point - Vec{node.centre[0], node.centre[1], node.centre[2]};
    const double power = dot(fromCentre, fromCentre) - node.radius * node.radius;
    if (best != kNowhere && !(power < least)) continue;
    least = power;
    best = i;
  }
  return best;
}

std::uint32_t BlendedField::follow(const Vec& point, std::uint32_t node) const {
  const double p[3] = {point.x, point.y, point.z};
  return followNodes(*this, p, node);
}

template <int order>
Jet<order> BlendedField::model(std::uint32_t node, const double* point) const {
  Jet<order> f;
  const std::uint32_t from = m_nodes[node].lender;
  if (from == kNowhere) return f;
  withKernel(m_kernel, [&](auto kernel) {
    for (std::uint32_t j = m_offset[from]; j < m_offset[from + 1]; ++j) {
      const StoredBlob& blob = m_blobs[j];
      const double d[3] = {point[0] - blob.centre[0], point[1] - blob.centre[1],
                           point[2] - blob.centre[2]};
      addBlob<decltype(kernel)>(d, blob.a, blob.width, f);
    }
  });
  return f;
}

template Jet<1> BlendedField::model<1>(std::uint32_t, const double*) const;
template Jet<2> BlendedField::model<2>(std::uint32_t, const double*) const;

}  // namespace lumen::field
