// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/wall.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "blob.h"
#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "formats/case/case_field.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kFarthest = 4;    // expected radii: a ray that comes so far runs along a vessel
constexpr int kMostSteps = 40;     // of a ray
constexpr double kOnWall = 2e-5;   // expected radii: a point as near is on the wall
constexpr double kCaution = 0.9;   // share of the distance: it is right to first order only
constexpr double kNearWall = 0.3;  // expected radii: Newton's steps from here
constexpr double kLeastRaySlope = 0.35;  // of a ray against the normal, for Newton's steps

/// A ray from the axis to the wall. The wall lies between `inside` and `outside`.
struct Ray {
  Vector3d origin, along;
  double radius = 0, t = 0, inside = 0, outside = 0;
  std::size_t ring = 0, index = 0;
  int steps = 0;
};

/// Columns of points for one call of libblob.
struct Batch {
  std::vector<double> point[3], distance, normal[3];
  std::vector<std::uint32_t> cursor;
  std::vector<std::uint8_t> state;

  void query(const blob_model* model, const std::vector<Ray>& rays) {
    const std::size_t count = rays.size();
    for (int a = 0; a < 3; ++a) point[a].resize(count), normal[a].resize(count);
    distance.resize(count), state.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d p = rays[i].origin + rays[i].t * rays[i].along;
      for (int a = 0; a < 3; ++a) point[a][i] = p[a];
    }
    blob_columns columns = blob_columns_default();
    columns.count = count;
    for (int a = 0; a < 3; ++a) {
      columns.point[a] = point[a].data();
      columns.normal[a] = normal[a].data();
    }
    columns.cursor = cursor.data();
    columns.distance = distance.data();
    columns.state = state.data();
    blob_query_columns(model, BLOB_BLENDED, &columns);
  }
};

/// Moves a ray's end towards the wall. Returns whether it is there, or is given up.
bool step(Ray& ray, double distance, const Vector3d& normal, bool isInside, bool& isFar) {
  if (std::abs(distance) < kOnWall * ray.radius || ++ray.steps > kMostSteps) return true;
  (isInside ? ray.inside : ray.outside) = ray.t;
  const double slope = std::max(normal.dot(ray.along), kLeastRaySlope);
  const bool isNear = std::abs(distance) < kNearWall * ray.radius;
  double next = ray.t - (isNear ? distance / slope : kCaution * distance);
  if (!(next > ray.inside && next < ray.outside)) next = 0.5 * (ray.inside + ray.outside);
  ray.t = next;
  isFar = ray.inside > kFarthest * ray.radius;
  return isFar;
}

std::vector<Ray> raysOf(std::span<const CutPlane> planes) {
  std::vector<Ray> rays;
  rays.reserve(planes.size() * WallRing::kRays);
  for (std::size_t r = 0; r < planes.size(); ++r) {
    const CutPlane& plane = planes[r];
    const auto [u, v] = planeBasis(plane.tangent);
    for (std::size_t i = 0; i < WallRing::kRays; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / WallRing::kRays;
      Ray ray{plane.centre, std::cos(angle) * u + std::sin(angle) * v};
      ray.radius = plane.radius;
      ray.outside = 2 * kFarthest * plane.radius;
      ray.ring = r;
      ray.index = i;
      rays.push_back(ray);
    }
  }
  return rays;
}

}  // namespace

Wall::Wall(const formats::Case& source) {
  if (!source.models || source.tree.nodeCount() == 0)
    throw invalidInput("the case has no models, whose wall could be measured");
  const field::TreeView tree = formats::treeViewOf(source.tree);
  const field::ModelsView models = formats::modelsViewOf(*source.models);
  blob_model_def def = blob_model_def_default();
  def.node_count = tree.nodeCount;
  def.centre = tree.centre;
  def.radius = tree.radius;
  def.parent = tree.parent;
  def.link_count = tree.linkCount;
  def.link = tree.link;
  def.blobs = {static_cast<blob_kernel>(models.kernel),
               models.parameter,
               models.level,
               models.offset,
               models.centre,
               models.width};
  blob_model* opened = nullptr;
  const blob_status status = blob_model_create(&def, &opened);
  if (status != BLOB_OK)
    throw failed(std::string("the case's models: ") + blob_status_text(status));
  m_model = std::shared_ptr<const blob_model>(
      opened, [](const blob_model* model) { blob_model_close(const_cast<blob_model*>(model)); });
}

std::vector<WallRing> Wall::rings(std::span<const CutPlane> planes) const {
  std::vector<WallRing> rings(planes.size());
  std::vector<Ray> rays = raysOf(planes);
  Batch batch;
  for (const Ray& ray : rays) batch.cursor.push_back(planes[ray.ring].node);
  for (WallRing& ring : rings) ring.isInside = ring.isClosed = true;
  while (!rays.empty()) {
    batch.query(m_model.get(), rays);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Ray& ray = rays[i];
      WallRing& ring = rings[ray.ring];
      const Vector3d normal(batch.normal[0][i], batch.normal[1][i], batch.normal[2][i]);
      const bool isInside = (batch.state[i] & BLOB_INSIDE) != 0;
      if (ray.steps == 0 && !isInside) ring.isInside = ring.isClosed = false;
      bool isFar = false;
      if (!ring.isInside || step(ray, batch.distance[i], normal, isInside, isFar)) {
        ring.isClosed = ring.isClosed && !isFar;
        ring.point[ray.index] = ray.origin + ray.t * ray.along;
        ring.normal[ray.index] = normal;
        ring.distance[ray.index] = ray.t;
        ring.node[ray.index] = batch.cursor[i];
        continue;
      }
      batch.cursor[kept] = batch.cursor[i];
      rays[kept++] = ray;
    }
    rays.resize(kept);
    batch.cursor.resize(kept);
  }
  return rings;
}

double Wall::inscribed(const CutPlane& plane, const WallRing& ring) const {
  constexpr int kSearches = 3;
  const auto least = std::min_element(ring.distance.begin(), ring.distance.end());
  double radius = *least;
  Vector3d wall = ring.point[static_cast<std::size_t>(least - ring.distance.begin())];
  for (int i = 0; i < kSearches; ++i) {
    // a point halfway to the wall has one nearest point, unlike the axis
    const Vector3d from = 0.5 * (plane.centre + wall);
    std::uint32_t cursor = plane.node;
    blob_nearest_point nearest{};
    blob_nearest(m_model.get(), BLOB_BLENDED, from.data(), &cursor, 0, 0, &nearest);
    const Vector3d found(nearest.point[0], nearest.point[1], nearest.point[2]);
    const double distance = (found - plane.centre).norm();
    if (!nearest.converged || !(distance < radius)) break;
    const bool isDone = radius - distance < kOnWall * plane.radius;
    radius = distance;
    wall = found;
    if (isDone) break;
  }
  return radius;
}

void Wall::distances(std::span<const Vector3d> points, std::uint32_t node,
                     std::vector<double>& out) const {
  out.resize(points.size());
  std::vector<std::uint32_t> cursors(points.size(), node);
  blob_columns columns = blob_columns_default();
  columns.count = points.size();
  if (points.empty()) return;
  for (int a = 0; a < 3; ++a) columns.point[a] = points[0].data() + a;
  columns.point_stride = static_cast<ptrdiff_t>(sizeof(Vector3d));
  columns.cursor = cursors.data();
  columns.distance = out.data();
  blob_query_columns(m_model.get(), BLOB_BLENDED, &columns);
}

}  // namespace lumen::convert
