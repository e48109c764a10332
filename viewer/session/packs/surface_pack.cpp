// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/packs/surface_pack.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

#include "formats/container/printable.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

namespace {

using convert::Triangle;

constexpr std::size_t kMostMoving = 12000;  // triangles that software draws 15 times a second

/// Key by which triangles are sorted and divided.
struct PartKey {
  std::uint32_t group = 0, branch = 0;
  friend auto operator<=>(const PartKey&, const PartKey&) = default;
};

/// The indices of triangles, ordered by key and otherwise as they are.
std::vector<std::uint32_t> sorted(const std::vector<PartKey>& keys) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

/// The branch of a triangle: that of two of its vertices, or of the first.
std::uint32_t branchOf(const convert::SurfaceMesh& surface, const Triangle& t) {
  const auto &a = surface.branch[t[0]], &b = surface.branch[t[1]], &c = surface.branch[t[2]];
  return b == c ? b : a;
}

/// Triangles in the order of their parts.
struct Parts {
  std::vector<Triangle> triangle;
  std::vector<TriangleRun> run;
  Json list = Json::array();  ///< one object for each run
};

template <class Part>
Parts partsOf(const std::vector<Triangle>& triangles, const std::vector<PartKey>& keys,
              Part&& part) {
  const std::vector<std::uint32_t> order = sorted(keys);
  Parts parts;
  parts.triangle.reserve(order.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && keys[order[end]] == keys[order[begin]])
      parts.triangle.push_back(triangles[order[end++]]);
    Json entry = part(keys[order[begin]]);
    entry["first"] = begin;
    entry["count"] = end - begin;
    parts.list.push_back(std::move(entry));
    parts.run.push_back({begin, end - begin});
    begin = end;
  }
  return parts;
}

void addParts(PackWriter& pack, Parts parts) {
  pack.add("triangle", std::span(std::as_const(parts.triangle)));
  pack.set("parts", std::move(parts.list));
}

/// The triangles of pictures while the scene moves.
void addMoving(PackWriter& pack, Parts& parts, const convert::SurfaceMesh& surface) {
  const MovingSurface moving =
      movingSurface(surface.position, surface.radius, parts.triangle, parts.run, kMostMoving);
  for (std::size_t i = 0; i < moving.run.size(); ++i) {
    parts.list[i]["moving_first"] = moving.run[i].first;
    parts.list[i]["moving_count"] = moving.run[i].count;
  }
  pack.add("moving", std::span(std::as_const(moving.triangle)));
}

/// The node that a joint rides on by its name, or -1 for the joint of all that rests.
std::int32_t nodeOfJoint(const std::string& name) {
  constexpr std::string_view kMoving = "node-";  // of the names that skinOf() gives
  return name.starts_with(kMoving) ? std::stoi(name.substr(kMoving.size())) : -1;
}

void addSkin(PackWriter& pack, const convert::MeshSkin& skin) {
  std::vector<std::int32_t> nodes;
  for (const std::string& name : skin.name) nodes.push_back(nodeOfJoint(name));
  pack.add("joint_node", nodes);
  const convert::MeshSkin::Vertices& vertices = skin.levels.front();
  const auto add = [&pack](const char* name, const std::vector<convert::MeshSkin::Four>& rows) {
    std::vector<std::uint16_t> values;
    for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
    pack.add(name, std::span(std::as_const(values)), {rows.size(), 4});
  };
  add("joint", vertices.joint);
  add("weight", vertices.weight);
}

Json overlapsJson(const convert::SurfaceReport& report) {
  Json list = Json::array();
  for (const convert::Overlap& overlap : report.overlaps)
    list.push_back({{"branch", overlap.branch},
                    {"other", overlap.other},
                    {"depth_mm", overlap.depth},
                    {"position", engine::vectorJson(overlap.place)}});
  return list;
}

constexpr double kMostError = 1.0 / 3;     // share of the mean radius by which a wall may move
constexpr std::size_t kMinTriangles = 16;  // triangles of a run, where it has as many

/// The triangles of one run, between vertices that are numbered as they come.
struct RunMesh {
  std::vector<std::uint32_t> index, vertex;  ///< `vertex`: the number in the surface of each
  std::vector<convert::Float3> position;
  double meanRadius = 0;
};

RunMesh runMesh(std::span<const convert::Float3> position, std::span<const float> radius,
                std::span<const Triangle> triangle) {
  RunMesh mesh;
  for (const Triangle& t : triangle) mesh.vertex.insert(mesh.vertex.end(), t.begin(), t.end());
  std::sort(mesh.vertex.begin(), mesh.vertex.end());
  mesh.vertex.erase(std::unique(mesh.vertex.begin(), mesh.vertex.end()), mesh.vertex.end());
  mesh.index.reserve(3 * triangle.size());
  for (const Triangle& t : triangle)
    for (const std::uint32_t v : t)
      mesh.index.push_back(static_cast<std::uint32_t>(
          std::lower_bound(mesh.vertex.begin(), mesh.vertex.end(), v) - mesh.vertex.begin()));
  for (const std::uint32_t v : mesh.vertex) {
    mesh.position.push_back(position[v]);
    mesh.meanRadius += double{radius[v]} / static_cast<double>(mesh.vertex.size());
  }
  return mesh;
}

std::vector<Triangle> simplified(const RunMesh& mesh, double share) {
  const std::size_t count = mesh.index.size() / 3,
                    wanted = std::max(static_cast<std::size_t>(share * static_cast<double>(count)),
                                      std::min(count, kMinTriangles));
  const float* const place = mesh.position.empty() ? nullptr : mesh.position[0].data();
  constexpr std::size_t kStride = sizeof(convert::Float3);
  const double extent{meshopt_simplifyScale(place, mesh.position.size(), kStride)};
  const auto error =
      static_cast<float>(extent > 0 ? std::min(1.0, kMostError * mesh.meanRadius / extent) : 0.0);
  std::vector<std::uint32_t> kept(mesh.index.size());
  kept.resize(meshopt_simplify(kept.data(), mesh.index.data(), mesh.index.size(), place,
                               mesh.position.size(), kStride, 3 * wanted, error));
  if (kept.empty()) kept = mesh.index;
  // neighbours follow one another: a vertex is then transformed once instead of up to six times
  meshopt_optimizeVertexCache(kept.data(), kept.data(), kept.size(), mesh.position.size());
  std::vector<Triangle> triangles(kept.size() / 3);
  for (std::size_t i = 0; i < kept.size(); ++i) triangles[i / 3][i % 3] = mesh.vertex[kept[i]];
  return triangles;
}

}  // namespace

std::string surfacePack(const convert::SurfaceMesh& surface, const SurfaceLevel& level,
                        const convert::SurfaceReport& report, const convert::MeshSkin* skin) {
  PackWriter pack;
  pack.add("position", std::span(surface.position));
  pack.add("node", surface.node);
  pack.add("radius_mm", surface.radius);
  std::vector<PartKey> keys;
  keys.reserve(surface.triangle.size());
  for (std::size_t i = 0; i < surface.triangle.size(); ++i)
    keys.push_back({surface.group[i], branchOf(surface, surface.triangle[i])});
  Parts parts = partsOf(surface.triangle, keys, [&](const PartKey& key) -> Json {
    return {{"name", surface.groups[key.group].name}, {"branch", key.branch}};
  });
  addMoving(pack, parts, surface);
  addParts(pack, std::move(parts));
  if (skin != nullptr) addSkin(pack, *skin);
  pack.set("kind", level.kind);
  pack.set("level", level.level);
  pack.set("levels", level.levels);
  pack.set("overlaps", overlapsJson(report));
  return pack.bytes();
}

std::string meshPack(const convert::MeshFile& mesh) {
  PackWriter pack;
  std::vector<convert::Float3> position;
  position.reserve(mesh.mesh.position.size());
  for (const Eigen::Vector3d& p : mesh.mesh.position)
    position.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  pack.add("position", std::span(std::as_const(position)));
  std::vector<PartKey> keys(mesh.mesh.triangle.size());
  for (std::size_t i = 0; i < mesh.group.size(); ++i) keys[i].group = mesh.group[i];
  addParts(pack, partsOf(mesh.mesh.triangle, keys, [&](const PartKey& key) -> Json {
             return {{"name", mesh.group.empty() ? "" : formats::printable(mesh.groups[key.group])},
                     {"branch", -1}};
           }));
  pack.set("kind", "mesh");
  return pack.bytes();
}

MovingSurface movingSurface(std::span<const convert::Float3> position,
                            std::span<const float> radius, std::span<const Triangle> triangle,
                            std::span<const TriangleRun> run, std::size_t most) {
  const double share =
      std::min(1.0, static_cast<double>(most) /
                        static_cast<double>(std::max<std::size_t>(triangle.size(), 1)));
  std::vector<std::vector<Triangle>> parts(run.size());
  tbb::parallel_for(std::size_t{0}, run.size(), [&](std::size_t i) {
    const auto [first, count] = run[i];
    parts[i] = simplified(runMesh(position, radius, triangle.subspan(first, count)), share);
  });
  MovingSurface moving;
  for (const std::vector<Triangle>& part : parts) {
    moving.run.push_back({moving.triangle.size(), part.size()});
    moving.triangle.insert(moving.triangle.end(), part.begin(), part.end());
  }
  return moving;
}

}  // namespace lumen::viewer
