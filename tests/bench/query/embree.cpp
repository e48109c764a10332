// SPDX-License-Identifier: Apache-2.0
// Closest point on the triangle mesh by Embree 3's point query.
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

#include "closest_point.h"
#include "method.h"

namespace lumen::bench {
namespace {

struct Search {
  const Triangles* mesh;
  float best[3];
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  const float p[3] = {arguments->query->x, arguments->query->y, arguments->query->z};
  const auto& face = search.mesh->face[arguments->primID];
  float q[3];
  closestOnTriangle(p, search.mesh->vertex[face[0]].data(), search.mesh->vertex[face[1]].data(),
                    search.mesh->vertex[face[2]].data(), q);
  const float d = std::sqrt(squareOf(p, q));
  if (!(d < arguments->query->radius)) return false;
  arguments->query->radius = d;
  for (int i = 0; i < 3; ++i) search.best[i] = q[i];
  return true;
}

class Embree : public Method {
public:
  ~Embree() override { release(); }
  [[nodiscard]] std::string name() const override { return "Embree 3 closest point"; }

  void prepare(const Surface& surface) override {
    release();
    m_mesh = &surface.mesh;
    m_bytes = 0;
    m_device = rtcNewDevice("threads=1");
    rtcSetDeviceMemoryMonitorFunction(
        m_device,
        [](void* user, ssize_t bytes, bool) {
          *static_cast<double*>(user) += static_cast<double>(bytes);
          return true;
        },
        &m_bytes);
    m_scene = rtcNewScene(m_device);
    rtcSetSceneBuildQuality(m_scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, m_mesh->vertex.size()));
    auto* faces = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m_mesh->face.size()));
    for (const auto& v : m_mesh->vertex)
      for (const float x : v) *vertices++ = x;
    for (const auto& f : m_mesh->face)
      for (const std::uint32_t i : f) *faces++ = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(m_scene);
  }

  void query(const double* points, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      Search search{m_mesh, {}};
      RTCPointQuery query{};
      query.x = static_cast<float>(points[3 * i]);
      query.y = static_cast<float>(points[3 * i + 1]);
      query.z = static_cast<float>(points[3 * i + 2]);
      query.radius = std::numeric_limits<float>::infinity();
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      rtcPointQuery(m_scene, &query, &context, visit, &search);
      distances[i] = static_cast<double>(query.radius);
    }
  }

  [[nodiscard]] double megabytes() const override { return m_bytes * 1e-6; }
  [[nodiscard]] int passes() const override { return 5; }

private:
  void release() {
    if (m_scene != nullptr) rtcReleaseScene(m_scene);
    if (m_device != nullptr) rtcReleaseDevice(m_device);
    m_scene = nullptr;
    m_device = nullptr;
  }

  const Triangles* m_mesh = nullptr;
  RTCDevice m_device = nullptr;
  RTCScene m_scene = nullptr;
  double m_bytes = 0;
};

}  // namespace

void addEmbree(Methods& methods) {
  methods.push_back(std::make_unique<Embree>());
}

}  // namespace lumen::bench
