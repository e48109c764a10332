// SPDX-License-Identifier: Apache-2.0
// Distance between a small sphere and the triangle mesh by FCL's trees of rectangle-swept spheres.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include "method.h"

namespace lumen::bench {
namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

class Fcl : public Method {
public:
  [[nodiscard]] std::string name() const override { return "FCL sphere to mesh"; }

  void prepare(const Surface& surface) override {
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> triangles;
    for (const auto& v : surface.mesh.vertex) vertices.emplace_back(v[0], v[1], v[2]);
    for (const auto& f : surface.mesh.face) triangles.emplace_back(f[0], f[1], f[2]);
    m_mesh = std::make_shared<Mesh>();
    m_mesh->beginModel();
    m_mesh->addSubModel(vertices, triangles);
    m_mesh->endModel();
  }

  void query(const double* points, std::size_t count, double* distances) override {
    const fcl::Sphered sphere(kRadius);
    for (std::size_t i = 0; i < count; ++i) {
      fcl::Transform3d at = fcl::Transform3d::Identity();
      at.translation() = fcl::Vector3d(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      fcl::DistanceRequestd request;
      fcl::DistanceResultd result;
      fcl::distance(m_mesh.get(), fcl::Transform3d::Identity(), &sphere, at, request, result);
      distances[i] = result.min_distance + kRadius;
    }
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(m_mesh->memUsage(false)) * 1e-6;
  }
  [[nodiscard]] int passes() const override { return 1; }

private:
  static constexpr double kRadius = 1e-3;
  std::shared_ptr<Mesh> m_mesh;
};

}  // namespace

void addFcl(Methods& methods) {
  methods.push_back(std::make_unique<Fcl>());
}

}  // namespace lumen::bench
