// SPDX-License-Identifier: Apache-2.0
// A narrow-band level set made from the triangle mesh, sampled trilinearly: the value only.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include "method.h"

namespace lumen::bench {
namespace {

class OpenVdb : public Method {
public:
  [[nodiscard]] std::string name() const override { return "OpenVDB level set, " + inMm(m_voxel); }

  void prepare(const Surface& surface) override {
    m_voxel = 0.5 * surface.voxel;
    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const auto& v : surface.mesh.vertex) points.emplace_back(v[0], v[1], v[2]);
    for (const auto& f : surface.mesh.face) triangles.emplace_back(f[0], f[1], f[2]);
    const auto transform = openvdb::math::Transform::createLinearTransform(m_voxel);
    // wide enough for the axis of the widest vessel of the tests; unsigned, as ends may be open
    m_grid = openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(*transform, points,
                                                                             triangles, {}, kBand);
  }

  void query(const double* points, std::size_t count, double* distances) override {
    using Accessor = openvdb::FloatGrid::ConstAccessor;
    const Accessor accessor = m_grid->getConstAccessor();
    const openvdb::tools::GridSampler<Accessor, openvdb::tools::BoxSampler> sampler(
        accessor, m_grid->transform());
    for (std::size_t i = 0; i < count; ++i)
      distances[i] = static_cast<double>(
          sampler.wsSample(openvdb::Vec3d(points[3 * i], points[3 * i + 1], points[3 * i + 2])));
  }

  [[nodiscard]] double megabytes() const override {
    return static_cast<double>(m_grid->memUsage()) * 1e-6;
  }
  [[nodiscard]] int passes() const override { return 50; }

private:
  double m_voxel = 0.1;               // mm: half of a voxel of the volume
  static constexpr float kBand = 12;  // voxels
  openvdb::FloatGrid::Ptr m_grid;
};

}  // namespace

void addOpenVdb(Methods& methods) {
  methods.push_back(std::make_unique<OpenVdb>());
}

}  // namespace lumen::bench
