// SPDX-License-Identifier: Apache-2.0
// Distance between a small sphere and the triangle mesh by FCL's trees of rectangle-swept spheres.
#include <limits>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include "signed_mesh.h"

namespace lumen::bench {
namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

class Fcl : public Method {
public:
  explicit Fcl(bool coherent) : m_coherent(coherent) {}
  [[nodiscard]] std::string name() const override {
    return m_coherent ? "FCL sphere to mesh, coherent" : "FCL sphere to mesh";
  }

  void prepare(const Vessel& vessel) override {
    m_signed.prepare(vessel.mesh);
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> triangles;
    for (const auto& v : vessel.mesh.vertex) vertices.emplace_back(v[0], v[1], v[2]);
    for (const auto& f : vessel.mesh.face) triangles.emplace_back(f[0], f[1], f[2]);
    m_mesh = std::make_shared<Mesh>();
    m_mesh->beginModel();
    m_mesh->addSubModel(vertices, triangles);
    m_mesh->endModel();
  }

  void place(const Start& start) override { m_last.assign(m_coherent ? start.count : 0); }

  void query(std::size_t first, const double* points, std::size_t count,
             const Answers& answers) override {
    constexpr double kUnbounded = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < count; ++i) {
      const double* at = points + 3 * i;
      const float p[3] = {static_cast<float>(at[0]), static_cast<float>(at[1]),
                          static_cast<float>(at[2])};
      const double reach = m_coherent ? m_last.reach(first + i, p) : kUnbounded;
      int face = nearestFace(at, reach < kUnbounded ? reach : kUnbounded);
      if (face < 0) face = nearestFace(at, kUnbounded);
      float q[3];
      const auto index = static_cast<std::uint32_t>(face);
      const Feature feature = m_signed.closest(p, index, q);
      m_signed.answer(p, q, index, feature, i, answers);
      if (m_coherent) m_last.keep(first + i, p, answers.distance[i]);
    }
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(m_mesh->memUsage(false)) * 1e-6 + m_signed.megabytes();
  }
  [[nodiscard]] int passes() const override { return 1; }

private:
  // The triangle nearest to a point, or -1 if none is nearer than `reach`. FCL prunes by the least
  // distance in its result so far, so a bound goes there.
  [[nodiscard]] int nearestFace(const double* point, double reach) const {
    constexpr double kRadius = 1e-3;
    const fcl::Sphered sphere(kRadius);
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.translation() = fcl::Vector3d(point[0], point[1], point[2]);
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result(reach);
    fcl::distance(m_mesh.get(), fcl::Transform3d::Identity(), &sphere, at, request, result);
    return static_cast<int>(result.b1);
  }

  bool m_coherent;
  SignedMesh m_signed;
  LastStep m_last;
  std::shared_ptr<Mesh> m_mesh;
};

}  // namespace

void addFcl(Methods& methods, bool coherent) {
  methods.push_back(std::make_unique<Fcl>(coherent));
}

}  // namespace lumen::bench
