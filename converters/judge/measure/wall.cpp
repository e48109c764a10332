// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <tbb/parallel_for.h>

#include "blob.h"
#include "converters/base/error.h"
#include "converters/base/statistics.h"
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

namespace {

using Eigen::Vector3d;

constexpr std::size_t kRays = WallRing::kRays;
constexpr double kStep = 2 * std::numbers::pi / static_cast<double>(kRays);
// A wall steeper against the plane's rays than this is a fold of the ring: its slope is cut.
constexpr double kLeastSlope = 0.1;

/// The farthest reach of the ring in a direction: the parabola through the farthest point and its
/// neighbours.
double support(const std::array<Vector3d, kRays>& out, const Vector3d& direction) {
  std::array<double, kRays> reach;
  for (std::size_t i = 0; i < kRays; ++i) reach[i] = out[i].dot(direction);
  const auto most = std::max_element(reach.begin(), reach.end());
  const auto i = static_cast<std::size_t>(most - reach.begin());
  const double before = reach[(i + kRays - 1) % kRays], after = reach[(i + 1) % kRays];
  const double bend = 2 * *most - before - after, slope = 0.5 * (after - before);
  return bend > 0 ? *most + 0.5 * slope * slope / bend : *most;
}

void findDiameters(const CutPlane& plane, const WallRing& ring, Section& section) {
  std::array<Vector3d, kRays> out;
  for (std::size_t i = 0; i < kRays; ++i) out[i] = ring.point[i] - plane.centre;
  std::array<double, kRays / 2> width;
  for (std::size_t i = 0; i < kRays / 2; ++i) {
    const Vector3d direction = out[i] / ring.distance[i];
    width[i] = support(out, direction) + support(out, -direction);
  }
  // the extremes between two directions, again by parabolas
  const auto refined = [&](std::size_t i, double sign) {
    const std::size_t n = width.size();
    const double a = width[(i + n - 1) % n], b = width[i], c = width[(i + 1) % n];
    const double bend = sign * (2 * b - a - c), slope = 0.5 * (c - a);
    return bend > 0 ? b + sign * 0.5 * slope * slope / bend : b;
  };
  const auto at = [&](auto found) { return static_cast<std::size_t>(found - width.begin()); };
  section.least = refined(at(std::min_element(width.begin(), width.end())), -1);
  section.greatest = refined(at(std::max_element(width.begin(), width.end())), 1);
}

}  // namespace

Section sectionOf(const CutPlane& plane, const WallRing& ring, const Vector3d& bend) {
  Section section;
  Vector3d moment = Vector3d::Zero();
  double wall = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double rho = ring.distance[i];
    const Vector3d out = ring.point[i] - plane.centre, ray = out / rho;
    const Vector3d around = plane.tangent.cross(ray);
    const Vector3d& n = ring.normal[i];
    const double slope = n.dot(around) / std::max(n.dot(ray), kLeastSlope);
    const double arc = rho * std::sqrt(1 + slope * slope) * kStep;
    section.area += 0.5 * rho * rho * kStep;
    moment += rho * rho / 3 * kStep * out;
    section.perimeter += arc;
    const double across = n.dot(plane.tangent);
    wall += arc * (1 - bend.dot(out)) / std::sqrt(std::max(1 - across * across, 0.01));
  }
  section.centroid = plane.centre + moment / section.area;
  section.volumeRate = section.area - bend.dot(moment);
  section.wallRate = wall;
  section.circularity =
      4 * std::numbers::pi * section.area / (section.perimeter * section.perimeter);
  findDiameters(plane, ring, section);
  return section;
}

namespace {

// Voxels: standard deviation of a wall's mean place after tracking and fitting a blurred image.
constexpr double kSharedVoxels = 0.04;
constexpr double kSigmaOfMedian = 1.4826;  // of a normal distribution's median of absolute values
constexpr double kLeastCount = 3;
constexpr double kSupportRadii = 0.5;  // along the vessel, of the points that a section rests on
constexpr double kOfPlace = 4;         // parts of a ring that bend on their own

double spacingAt(const formats::CenterlineTree& tree, std::uint32_t node) {
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  const std::uint32_t a = node > branch.firstNode ? node - 1 : node;
  const std::uint32_t b = node < last ? node + 1 : node;
  if (a == b) return double{tree.radius[node]};
  return (toEigen(tree.centre[b]) - toEigen(tree.centre[a])).norm() / (b - a);
}

}  // namespace

WallNoise::WallNoise(const formats::Case& source, const Wall& wall) {
  if (!source.points || source.points->position.empty()) return;
  const formats::CenterlineTree& tree = source.tree;
  const std::size_t count = tree.nodeCount();
  const double voxel = source.metadata.voxelSize.value_or(0);
  m_shared = kSharedVoxels * voxel;
  std::vector<double> variance(count, 0), points(count, 0), spacing(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    spacing[n] = spacingAt(tree, node);
    const auto& offset = source.points->offset;
    std::vector<Eigen::Vector3d> own;
    for (std::uint32_t p = offset[n]; p < offset[n + 1]; ++p)
      own.push_back(toEigen(source.points->position[p]));
    if (own.empty()) return;
    std::vector<double> distance;
    wall.distances(own, node, distance);
    for (double& d : distance) d = std::abs(d);
    const double sigma = kSigmaOfMedian * upperMedian(distance);
    variance[n] = sigma * sigma;
    // points in one voxel err alike
    const double wallArea = 2 * std::numbers::pi * double{tree.radius[n]} * spacing[n];
    const double voxels = voxel > 0 ? wallArea / (voxel * voxel) : static_cast<double>(own.size());
    points[n] = std::min(static_cast<double>(own.size()), voxels);
  });
  m_variance.assign(count, 0);
  m_count.assign(count, 0);
  for (std::uint32_t n = 0; n < count; ++n) {
    const formats::Branch& branch = tree.branches[tree.branch[n]];
    const double reach = kSupportRadii * double{tree.radius[n]};
    const auto side =
        static_cast<std::uint32_t>(std::clamp(reach / std::max(spacing[n], 1e-6), 1.0, 50.0));
    const std::uint32_t first = n - std::min(side, n - branch.firstNode);
    const std::uint32_t last = std::min(n + side, branch.firstNode + branch.nodeCount - 1);
    double sum = 0;
    for (std::uint32_t k = first; k <= last; ++k) {
      sum += points[k] * variance[k];
      m_count[n] += points[k];
    }
    m_variance[n] = m_count[n] > 0 ? sum / m_count[n] : 0;
  }
}

double WallNoise::ofMean(std::uint32_t node) const {
  if (!isKnown() || m_count[node] < kLeastCount) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(m_variance[node] / m_count[node] + m_shared * m_shared);
}

double WallNoise::ofPlace(std::uint32_t node) const {
  if (!isKnown() || m_count[node] < kLeastCount) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(kOfPlace * m_variance[node] / m_count[node] + m_shared * m_shared);
}

}  // namespace lumen::convert
