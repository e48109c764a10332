// SPDX-License-Identifier: Apache-2.0
// On which side of a closed mesh a point lies, told from what is nearest to it: J. A. Baerentzen and
// H. Aanaes, Signed distance computation using the angle weighted pseudonormal, IEEE TVCG, 2005.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "closest_point.h"
#include "method.h"

namespace lumen::bench {

class SignedMesh {
public:
  using Vector = std::array<float, 3>;

  /// Takes a mesh, which must stay where it is. A mesh that is not closed has no signs.
  void prepare(const Triangles& mesh);

  /// The point of face `face` that is nearest to p goes to q.
  Feature closest(const float* p, std::uint32_t face, float* q) const {
    const auto& corner = m_mesh->face[face];
    return closestOnTriangle(p, m_mesh->vertex[corner[0]].data(), m_mesh->vertex[corner[1]].data(),
                             m_mesh->vertex[corner[2]].data(), q);
  }

  /// Distance and normal of point i, at p, whose nearest point q lies on a feature of a face.
  void answer(const float* p, const float* q, std::uint32_t face, Feature feature, std::size_t i,
              const Answers& answers) const;

  /// The pseudonormal of a closed mesh at a feature of a face.
  [[nodiscard]] const Vector& normalOf(std::uint32_t face, Feature feature) const;

  [[nodiscard]] double megabytes() const;

private:
  const Triangles* m_mesh = nullptr;
  std::vector<Vector> m_vertex, m_edge, m_face;  ///< edges: three of each face, unit length each
};

// State that a search for the nearest triangle may keep from step to step: the wall is no farther than its
// last distance and the path of the point since.
class LastStep {
public:
  void assign(std::size_t count) {
    m_point.assign(count, {});
    m_distance.assign(count, std::numeric_limits<float>::infinity());
  }

  /// A bound on the distance of point i, now at p, mm; infinite in its first step.
  [[nodiscard]] float reach(std::size_t i, const float* p) const {
    constexpr float kRounding = 1e-4f;
    const float moved = std::sqrt(squareOf(p, m_point[i].data()));
    return (m_distance[i] + moved) * (1 + kRounding) + kRounding;
  }

  void keep(std::size_t i, const float* p, double distance) {
    m_point[i] = {p[0], p[1], p[2]};
    m_distance[i] = std::abs(static_cast<float>(distance));
  }

private:
  std::vector<std::array<float, 3>> m_point;
  std::vector<float> m_distance;
};

}  // namespace lumen::bench
