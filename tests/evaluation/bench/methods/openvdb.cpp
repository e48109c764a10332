// SPDX-License-Identifier: Apache-2.0
// A narrow-band level set made from the triangle mesh, sampled trilinearly: the value, or the value and
// its gradient from the same eight samples.
#include <cmath>

#include <openvdb/math/Stencils.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include "method.h"

namespace lumen::bench {
namespace {

class OpenVdb : public Method {
public:
  [[nodiscard]] std::string name() const override { return "OpenVDB level set, " + inMm(m_voxel); }

  void prepare(const Vessel& vessel) override {
    m_voxel = 0.5 * vessel.voxel;
    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const auto& v : vessel.mesh.vertex) points.emplace_back(v[0], v[1], v[2]);
    for (const auto& f : vessel.mesh.face) triangles.emplace_back(f[0], f[1], f[2]);
    const auto transform = openvdb::math::Transform::createLinearTransform(m_voxel);
    using openvdb::FloatGrid;
    if (vessel.mesh.closed)
      m_grid = openvdb::tools::meshToLevelSet<FloatGrid>(*transform, points, triangles, {}, kBand);
    else
      m_grid = openvdb::tools::meshToUnsignedDistanceField<FloatGrid>(*transform, points, triangles,
                                                                      {}, kWideBand);
  }

  void query(std::size_t, const double* points, std::size_t count,
             const Answers& answers) override {
    if (answers.normal[0] != nullptr) return queryNormals(points, count, answers);
    using Accessor = openvdb::FloatGrid::ConstAccessor;
    const Accessor accessor = m_grid->getConstAccessor();
    const openvdb::tools::GridSampler<Accessor, openvdb::tools::BoxSampler> sampler(
        accessor, m_grid->transform());
    for (std::size_t i = 0; i < count; ++i)
      answers.distance[i] = static_cast<double>(
          sampler.wsSample(openvdb::Vec3d(points[3 * i], points[3 * i + 1], points[3 * i + 2])));
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(m_grid->memUsage()) * 1e-6;
  }
  [[nodiscard]] int passes() const override { return 50; }

private:
  void queryNormals(const double* points, std::size_t count, const Answers& answers) const {
    openvdb::math::BoxStencil<openvdb::FloatGrid> stencil(*m_grid);
    const float scale = 1.0f / static_cast<float>(m_voxel);
    for (std::size_t i = 0; i < count; ++i) {
      const openvdb::Vec3d at(points[3 * i] / m_voxel, points[3 * i + 1] / m_voxel,
                              points[3 * i + 2] / m_voxel);
      stencil.moveTo(at);
      const openvdb::math::Vec3<float> x(at);
      answers.distance[i] = static_cast<double>(stencil.interpolation(x));
      const openvdb::math::Vec3<float> g = stencil.gradient(x) * scale;
      const float length = std::sqrt(g.dot(g));
      for (int k = 0; k < 3; ++k)
        answers.normal[k][i] = static_cast<double>(length > 0 ? g[k] / length : 0.0f);
    }
  }

  double m_voxel = 0.1;              // mm: half of a voxel of the volume
  static constexpr float kBand = 3;  // voxels to either side, as is usual
  // of an unsigned field, as ends may be open: as far as the axis of the widest vessel of the tests
  static constexpr float kWideBand = 12;
  openvdb::FloatGrid::Ptr m_grid;
};

}  // namespace

void addOpenVdb(Methods& methods) {
  methods.push_back(std::make_unique<OpenVdb>());
}

}  // namespace lumen::bench
