// SPDX-License-Identifier: Apache-2.0
// Declared in closed_mesh.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/icosphere.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Least share of a wall's area that is its inner side, unless it is thicker than its lumen is wide.
constexpr double kLeastInner = 0.25;
// Largest share: the outer side is the greater one; beyond this the surface is merely rough.
constexpr double kMostInner = 0.55;
// Share of the rays: a side from which this many meet the wall again is surely an inner one ...
constexpr double kEnclosed = 0.75;
// ... and one from which most do is, if it belongs to a greater region of such ones.
constexpr double kMostly = 0.5;
// Rays of a triangle are those of an icosphere that leave it at more than 20 degrees to its plane.
constexpr int kWallRayOrder = 2;
constexpr double kSteep = 0.34;
constexpr std::size_t kMostTriangles = 4000;  // triangles that show whether there is a wall
constexpr int kVotes = 3;                     // rounds in which a triangle follows those beside it
// Share of the greatest region's area: less is a fold of the outer side.
constexpr double kLeastRegion = 0.05;
constexpr std::size_t kNestedLooks = 20;  // points of a part that show whether it is enclosed

/// The degree to which each triangle of a surface faces that surface from outside.
class Facing {
public:
  Facing(const ClosedMesh& surface, const TriangleTree& tree)
      : m_mesh(surface.mesh), m_tree(tree), m_rays(icosphere(kWallRayOrder)) {}

  [[nodiscard]] double area(std::size_t t) const { return 0.5 * twiceArea(t).norm(); }

  /// The share of rays that meet the surface again.
  [[nodiscard]] double share(std::size_t t) const {
    const Vector3d normal = m_tree.normal(static_cast<std::uint32_t>(t));
    const Triangle& corner = m_mesh.triangle[t];
    const Vector3d middle =
        (m_mesh.position[corner[0]] + m_mesh.position[corner[1]] + m_mesh.position[corner[2]]) / 3;
    const double least = 1e-6 * std::sqrt(area(t));
    double all = 0, met = 0;
    for (const Vector3d& ray : m_rays) {
      if (ray.dot(normal) < kSteep) continue;
      const auto hit = m_tree.firstHit(middle, ray, least);
      ++all;
      met += hit && !hit->leaves ? 1 : 0;
    }
    return all > 0 ? met / all : 0;
  }

private:
  [[nodiscard]] Vector3d twiceArea(std::size_t t) const {
    const Triangle& corner = m_mesh.triangle[t];
    const Vector3d& a = m_mesh.position[corner[0]];
    return (m_mesh.position[corner[1]] - a).cross(m_mesh.position[corner[2]] - a);
  }

  const TriangleMesh& m_mesh;
  const TriangleTree& m_tree;
  std::vector<Vector3d> m_rays;
};

bool isWallWithThickness(const Facing& facing, std::size_t count) {
  const std::size_t stride = std::max<std::size_t>(1, count / kMostTriangles);
  std::vector<double> areas(count / stride + 1, 0), inner(areas.size(), 0);
  tbb::parallel_for(std::size_t{0}, (count + stride - 1) / stride, [&](std::size_t i) {
    areas[i] = facing.area(i * stride);
    if (facing.share(i * stride) >= kEnclosed) inner[i] = areas[i];
  });
  double all = 0, enclosed = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    all += areas[i];
    enclosed += inner[i];
  }
  return enclosed > kLeastInner * all;
}

/// Pairs of triangles that share a side.
std::vector<std::pair<std::uint32_t, std::uint32_t>> findNeighbours(const TriangleMesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle;
    bool operator<(const Side& other) const {
      return low != other.low     ? low < other.low
             : high != other.high ? high < other.high
                                  : triangle < other.triangle;
    }
  };
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangle[t][i], b = mesh.triangle[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].low == sides[i + 1].low && sides[i].high == sides[i + 1].high)
      pairs.emplace_back(sides[i].triangle, sides[i + 1].triangle);
  return pairs;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Adapts triangles to their neighbours: rays miss through a gap here and there.
void vote(std::vector<std::uint8_t>& isInner, const Pairs& pairs) {
  for (int round = 0; round < kVotes; ++round) {
    std::vector<std::uint8_t> votes(isInner.size(), 0);
    for (const auto& [a, b] : pairs) {
      votes[a] = static_cast<std::uint8_t>(votes[a] + isInner[b]);
      votes[b] = static_cast<std::uint8_t>(votes[b] + isInner[a]);
    }
    for (std::size_t t = 0; t < isInner.size(); ++t)
      isInner[t] = votes[t] + isInner[t] >= 2 ? 1 : 0;
  }
}

/// Drops connected regions that are small beside the greatest one.
void keepGreatRegions(std::vector<std::uint8_t>& isInner, const Pairs& pairs,
                      const Facing& facing) {
  DisjointSets regions(isInner.size());
  for (const auto& [a, b] : pairs)
    if (isInner[a] && isInner[b]) regions.join(a, b);
  std::vector<double> area(isInner.size(), 0);
  for (std::uint32_t t = 0; t < isInner.size(); ++t)
    if (isInner[t]) area[regions.find(t)] += facing.area(t);
  const double least = kLeastRegion * *std::max_element(area.begin(), area.end());
  for (std::uint32_t t = 0; t < isInner.size(); ++t)
    isInner[t] = isInner[t] && area[regions.find(t)] >= least ? 1 : 0;
}

/// A connected part of a mesh, with its openings closed.
struct MeshPart {
  TriangleMesh mesh;
  std::vector<std::size_t> source;  // source of each of its triangles
  Vector3d low = Vector3d::Constant(1e300), high = -low;
  double area = 0;
  bool isDropped = false;
};

std::vector<MeshPart> findParts(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.position.size());
  for (const Triangle& t : mesh.triangle) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<MeshPart> parts;
  std::vector<std::size_t> index(mesh.position.size(), 0);  // index in a set's part, plus one
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    std::size_t& of = index[sets.find(mesh.triangle[t][0])];
    if (of == 0) {
      parts.emplace_back();
      of = parts.size();
    }
    MeshPart& part = parts[of - 1];
    part.source.push_back(t);
    for (const std::uint32_t v : mesh.triangle[t]) {
      part.low = part.low.cwiseMin(mesh.position[v]);
      part.high = part.high.cwiseMax(mesh.position[v]);
    }
  }
  return parts;
}

/// With points and triangles of its own.
void fill(MeshPart& part, const TriangleMesh& mesh) {
  if (!part.mesh.triangle.empty()) return;
  std::unordered_map<std::uint32_t, std::uint32_t> to;
  for (const std::size_t t : part.source) {
    Triangle own{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangle[t][i];
      const auto [entry, isNew] =
          to.try_emplace(v, static_cast<std::uint32_t>(part.mesh.position.size()));
      if (isNew) part.mesh.position.push_back(mesh.position[v]);
      own[i] = entry->second;
    }
    part.mesh.triangle.push_back(own);
    part.area += 0.5 * (part.mesh.position[own[1]] - part.mesh.position[own[0]])
                           .cross(part.mesh.position[own[2]] - part.mesh.position[own[0]])
                           .norm();
  }
}

/// Whether most of a few points of `inner` lie inside of `outer`.
bool encloses(const MeshPart& outer, const MeshPart& inner) {
  const ClosedMesh closed = closeMesh(outer.mesh);
  const TriangleTree tree(closed.mesh);
  const std::size_t stride = std::max<std::size_t>(1, inner.mesh.position.size() / kNestedLooks);
  std::size_t all = 0, inside = 0;
  for (std::size_t v = 0; v < inner.mesh.position.size(); v += stride) {
    ++all;
    inside += tree.contains(inner.mesh.position[v]) ? 1 : 0;
  }
  return 2 * inside > all;
}

}  // namespace

UnnestedMesh unnested(TriangleMesh mesh) {
  UnnestedMesh out;
  std::vector<MeshPart> parts = findParts(mesh);
  for (MeshPart& outer : parts)
    for (MeshPart& inner : parts) {
      if (&inner == &outer || inner.isDropped || outer.isDropped) continue;
      if (!((outer.low.array() <= inner.low.array()).all() &&
            (inner.high.array() <= outer.high.array()).all()))
        continue;
      fill(outer, mesh);
      fill(inner, mesh);
      if (!encloses(outer, inner)) continue;
      const bool isWall = inner.area >= kLeastInner * outer.area;
      (isWall ? outer : inner).isDropped = true;
      ++(isWall ? out.outer : out.enclosed);
    }
  if (out.outer + out.enclosed == 0) {
    out.mesh = std::move(mesh);
    return out;
  }
  for (MeshPart& part : parts) {
    if (part.isDropped) continue;
    fill(part, mesh);
    const auto first = static_cast<std::uint32_t>(out.mesh.position.size());
    out.mesh.position.insert(out.mesh.position.end(), part.mesh.position.begin(),
                             part.mesh.position.end());
    for (const Triangle& t : part.mesh.triangle)
      out.mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return out;
}

std::optional<TriangleMesh> innerSide(const ClosedMesh& surface, const TriangleTree& tree,
                                      const Progress& progress) {
  const std::size_t count = surface.mesh.triangle.size();
  const Facing facing(surface, tree);
  if (!isWallWithThickness(facing, count)) return {};
  std::vector<std::uint8_t> isInner(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
    if (t % 256 == 0) progress.check();
    isInner[t] = surface.end[t] == ClosedMesh::kWall && facing.share(t) >= kMostly ? 1 : 0;
  });
  const Pairs pairs = findNeighbours(surface.mesh);
  vote(isInner, pairs);
  keepGreatRegions(isInner, pairs, facing);
  double all = 0, taken = 0;
  for (std::size_t t = 0; t < count; ++t) {
    all += facing.area(t);
    taken += isInner[t] ? facing.area(t) : 0;
  }
  if (taken > kMostInner * all) return {};
  TriangleMesh inner{surface.mesh.position, {}};
  for (std::size_t t = 0; t < count; ++t) {
    const Triangle& corner = surface.mesh.triangle[t];
    if (isInner[t]) inner.triangle.push_back({corner[1], corner[0], corner[2]});
  }
  return inner;
}

}  // namespace lumen::convert
