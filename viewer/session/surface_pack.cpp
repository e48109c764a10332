// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/surface_pack.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/container/printable.h"
#include "viewer/session/moving_surface.h"
#include "viewer/session/pack.h"

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
    parts.list[i]["movingFirst"] = moving.run[i].first;
    parts.list[i]["movingCount"] = moving.run[i].count;
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
  pack.add("jointNode", nodes);
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
                    {"depth", overlap.depth},
                    {"position", {overlap.place.x(), overlap.place.y(), overlap.place.z()}}});
  return list;
}

}  // namespace

std::string surfacePack(const convert::SurfaceMesh& surface, const SurfaceLevel& level,
                        const convert::SurfaceReport& report, const convert::MeshSkin* skin) {
  PackWriter pack;
  pack.add("position", std::span(surface.position));
  pack.add("node", surface.node);
  pack.add("radius", surface.radius);
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

convert::MeshFile inMillimetres(convert::MeshFile mesh) {
  if (mesh.unitMm > 0)
    for (Eigen::Vector3d& p : mesh.mesh.position) p *= mesh.unitMm;
  mesh.unitMm = 1;
  return mesh;
}

}  // namespace lumen::viewer
