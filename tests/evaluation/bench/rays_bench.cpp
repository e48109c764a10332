// SPDX-License-Identifier: Apache-2.0
// Rays from within a vessel to its wall: TriangleTree against Embree 3, on one thread.
//
//   build/release/tests/evaluation/bench/rays_bench MESH.stl
//
// From the middles of chords of the mesh, 162 rays each, as wall points of a mesh are found.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "converters/geometry/icosphere.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::bench {
namespace {

using convert::TriangleMesh;
using convert::TriangleTree;
using Eigen::Vector3d;

constexpr std::size_t kOrigins = 2000;
constexpr int kSphere = 3;
constexpr double kMiss = std::numeric_limits<double>::infinity();

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Embree as its documentation recommends for watertight answers: "robust".
class Embree {
public:
  explicit Embree(const TriangleMesh& mesh)
      : m_device(rtcNewDevice("threads=1")), m_scene(rtcNewScene(m_device)) {
    rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(m_scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* position = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.position.size()));
    for (const Vector3d& p : mesh.position)
      for (int k = 0; k < 3; ++k) *position++ = static_cast<float>(p[k]);
    auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangle.size()));
    for (const convert::Triangle& t : mesh.triangle)
      for (const std::uint32_t v : t) *index++ = v;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(m_scene);
  }
  ~Embree() {
    rtcReleaseScene(m_scene);
    rtcReleaseDevice(m_device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  [[nodiscard]] double distance(const Vector3d& origin, const Vector3d& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(origin.x());
    query.ray.org_y = static_cast<float>(origin.y());
    query.ray.org_z = static_cast<float>(origin.z());
    query.ray.dir_x = static_cast<float>(direction.x());
    query.ray.dir_y = static_cast<float>(direction.y());
    query.ray.dir_z = static_cast<float>(direction.z());
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(m_scene, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kMiss : double{query.ray.tfar};
  }

private:
  RTCDevice m_device;
  RTCScene m_scene;
};

// Middles of the chords from triangles, evenly taken, to the wall across.
std::vector<Vector3d> origins(const TriangleTree& tree) {
  const TriangleMesh& mesh = tree.mesh();
  std::vector<Vector3d> found;
  const std::size_t step = mesh.triangle.size() / kOrigins + 1;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += step) {
    const auto& [a, b, c] = mesh.triangle[t];
    const Vector3d middle = (mesh.position[a] + mesh.position[b] + mesh.position[c]) / 3;
    const Vector3d inward = -tree.normal(static_cast<std::uint32_t>(t));
    if (const auto hit = tree.firstHit(middle, inward, 1e-6))
      found.push_back(middle + hit->distance / 2 * inward);
  }
  return found;
}

int run(const std::string& file) {
  const TriangleMesh mesh = convert::readMesh(file, convert::MeshFormat::Stl).mesh;
  double ourBuild = 0, theirBuild = 0;
  for (int i = 0; i < 3; ++i) {
    ourBuild += seconds([&] { const TriangleTree once(mesh); }) / 3;
    theirBuild += seconds([&] { const Embree once(mesh); }) / 3;
  }
  const TriangleTree tree(mesh);
  const Embree embree(mesh);
  const std::vector<Vector3d> from = origins(tree), rays = convert::icosphere(kSphere);
  std::vector<double> ours, theirs;
  const auto shoot = [&](std::vector<double>& into, const auto& distance) {
    return seconds([&] {
      into.clear();
      for (const Vector3d& origin : from)
        for (const Vector3d& ray : rays) into.push_back(distance(origin, ray));
    });
  };
  double ourTime = kMiss, theirTime = kMiss;
  for (int i = 0; i < 3; ++i) {
    ourTime = std::min(ourTime, shoot(ours, [&](const Vector3d& o, const Vector3d& d) {
                         const auto hit = tree.firstHit(o, d);
                         return hit ? hit->distance : kMiss;
                       }));
    theirTime = std::min(theirTime, shoot(theirs, [&](const Vector3d& o, const Vector3d& d) {
                           return embree.distance(o, d);
                         }));
  }
  std::size_t different = 0;
  double worst = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double apart = ours[i] == theirs[i] ? 0 : std::abs(ours[i] - theirs[i]);
    if (apart > 1e-3)
      ++different;
    else
      worst = std::max(worst, apart);
  }
  const auto count = static_cast<double>(ours.size());
  std::printf("%zu triangles, %zu rays\n", mesh.triangle.size(), ours.size());
  std::printf("TriangleTree  build %6.0f ms  %6.2f us a ray\n", 1e3 * ourBuild,
              1e6 * ourTime / count);
  std::printf("Embree 3      build %6.0f ms  %6.2f us a ray\n", 1e3 * theirBuild,
              1e6 * theirTime / count);
  std::printf("more than 0.001 mm apart: %zu rays; the others at most %.1e mm\n", different, worst);
  return 0;
}

}  // namespace
}  // namespace lumen::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "Usage: rays_bench MESH.stl\n");
    return 2;
  }
  try {
    return lumen::bench::run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
