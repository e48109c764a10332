// SPDX-License-Identifier: Apache-2.0
// Closest point on the triangle mesh by Embree 3's point query.
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

#include "signed_mesh.h"

namespace lumen::bench {
namespace {

struct Search {
  const SignedMesh* mesh;
  float best[3];
  std::uint32_t face = RTC_INVALID_GEOMETRY_ID;
  Feature feature = Feature::Face;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  const float p[3] = {arguments->query->x, arguments->query->y, arguments->query->z};
  float q[3];
  const Feature feature = search.mesh->closest(p, arguments->primID, q);
  const float d = std::sqrt(squareOf(p, q));
  if (!(d < arguments->query->radius)) return false;
  arguments->query->radius = d;
  for (int i = 0; i < 3; ++i) search.best[i] = q[i];
  search.face = arguments->primID;
  search.feature = feature;
  return true;
}

class Embree : public Method {
public:
  explicit Embree(bool coherent) : m_coherent(coherent) {}
  ~Embree() override { release(); }
  [[nodiscard]] std::string name() const override {
    return m_coherent ? "Embree 3 closest point, coherent" : "Embree 3 closest point";
  }

  void prepare(const Vessel& vessel) override {
    release();
    m_signed.prepare(vessel.mesh);
    const Triangles& mesh = vessel.mesh;
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
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertex.size()));
    auto* faces = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.face.size()));
    for (const auto& v : mesh.vertex)
      for (const float x : v) *vertices++ = x;
    for (const auto& f : mesh.face)
      for (const std::uint32_t i : f) *faces++ = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(m_scene);
  }

  void place(const Start& start) override { m_last.assign(m_coherent ? start.count : 0); }

  void query(std::size_t first, const double* points, std::size_t count,
             const Answers& answers) override {
    for (std::size_t i = 0; i < count; ++i) {
      const float p[3] = {static_cast<float>(points[3 * i]), static_cast<float>(points[3 * i + 1]),
                          static_cast<float>(points[3 * i + 2])};
      const float unbounded = std::numeric_limits<float>::infinity();
      Search search = searchWithin(p, m_coherent ? m_last.reach(first + i, p) : unbounded);
      if (search.face == RTC_INVALID_GEOMETRY_ID) search = searchWithin(p, unbounded);
      m_signed.answer(p, search.best, search.face, search.feature, i, answers);
      if (m_coherent) m_last.keep(first + i, p, answers.distance[i]);
    }
  }

  [[nodiscard]] double megabytes() const override { return m_bytes * 1e-6 + m_signed.megabytes(); }
  [[nodiscard]] int passes() const override { return 5; }

private:
  [[nodiscard]] Search searchWithin(const float* p, float radius) const {
    Search search{&m_signed, {}};
    RTCPointQuery query{};
    query.x = p[0];
    query.y = p[1];
    query.z = p[2];
    query.radius = radius;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(m_scene, &query, &context, visit, &search);
    return search;
  }

  void release() {
    if (m_scene != nullptr) rtcReleaseScene(m_scene);
    if (m_device != nullptr) rtcReleaseDevice(m_device);
    m_scene = nullptr;
    m_device = nullptr;
  }

  bool m_coherent;
  SignedMesh m_signed;
  LastStep m_last;
  RTCDevice m_device = nullptr;
  RTCScene m_scene = nullptr;
  double m_bytes = 0;
};

}  // namespace

void addEmbree(Methods& methods, bool coherent) {
  methods.push_back(std::make_unique<Embree>(coherent));
}

}  // namespace lumen::bench
