// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/mesh_parts.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lumen::convert {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint32_t branchOf(const SurfaceMesh& surface, const Triangle& t) {
  const std::uint32_t a = surface.branch[t[0]], b = surface.branch[t[1]];
  const std::uint32_t c = surface.branch[t[2]];
  return b == c ? b : a;
}

bool isFlat(FaceKind kind) {
  return kind == FaceKind::Inlet || kind == FaceKind::Outlet;
}

Eigen::Vector3d at(const SurfaceMesh& surface, std::uint32_t vertex) {
  return Eigen::Vector3f(surface.position[vertex].data()).cast<double>();
}

/// The area-weighted mean of the normals of a part's faces at each of its vertices; the surface's
/// normal where there is none.
void takeNormalsOfFaces(const SurfaceMesh& surface, MeshPart& part) {
  std::vector<Eigen::Vector3d> sum(part.vertex.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : part.triangle) {
    const Eigen::Vector3d a = at(surface, part.vertex[t[0]]), b = at(surface, part.vertex[t[1]]);
    const Eigen::Vector3d c = at(surface, part.vertex[t[2]]);
    for (const std::uint32_t v : t) sum[v] += (b - a).cross(c - a);
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    const double length = sum[v].norm();
    if (!(length > 0)) continue;
    const Eigen::Vector3f n = (sum[v] / length).cast<float>();
    part.normal[v] = {n.x(), n.y(), n.z()};
  }
}

/// From vertices of the surface to a part's own. `local` is kNone for all vertices, before and
/// after.
void useOwnVertices(const SurfaceMesh& surface, MeshPart& part, std::vector<std::uint32_t>& local) {
  for (Triangle& t : part.triangle)
    for (std::uint32_t& v : t) {
      if (local[v] == kNone) {
        local[v] = static_cast<std::uint32_t>(part.vertex.size());
        part.vertex.push_back(v);
        part.normal.push_back(surface.normal[v]);
      }
      v = local[v];
    }
  for (const std::uint32_t v : part.vertex) local[v] = kNone;
}

}  // namespace

std::vector<MeshPart> splitMesh(const SurfaceMesh& surface, MeshPer per, bool bySystem) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, formats::VesselSystem>, MeshPart> parts;
  const auto systems = bySystem ? triangleSystems(surface) : std::vector<formats::VesselSystem>();
  for (std::size_t f = 0; f < surface.triangle.size(); ++f) {
    const Triangle& t = surface.triangle[f];
    const std::uint32_t branch = per == MeshPer::Branch ? branchOf(surface, t) : 0;
    const auto system = systems.empty() ? formats::VesselSystem::Unknown : systems[f];
    parts[{branch, surface.group[f], system}].triangle.push_back(t);
  }
  std::vector<MeshPart> result;
  std::vector<std::uint32_t> local(surface.position.size(), kNone);
  for (auto& [key, part] : parts) {
    std::tie(part.branch, part.group, part.system) = key;
    useOwnVertices(surface, part, local);
    part.isFlat = isFlat(surface.groups[part.group].kind);
    if (part.isFlat) takeNormalsOfFaces(surface, part);
    result.push_back(std::move(part));
  }
  return result;
}

std::string systemName(formats::VesselSystem system) {
  return std::string(formats::kVesselSystemNames[static_cast<std::size_t>(system)]);
}

std::vector<formats::VesselSystem> triangleSystems(const SurfaceMesh& surface) {
  std::vector<formats::VesselSystem> systems;
  if (surface.systems.empty()) return systems;
  for (const Triangle& t : surface.triangle)
    systems.push_back(surface.systems[branchOf(surface, t)]);
  return systems;
}

std::optional<formats::VesselSystem> mainSystem(const SurfaceMesh& surface) {
  std::map<formats::VesselSystem, std::size_t> counts;
  for (const formats::VesselSystem system : triangleSystems(surface)) ++counts[system];
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == counts.end()) return std::nullopt;
  return most->first;
}

std::vector<SystemPart> splitBySystem(const SurfaceMesh& surface) {
  std::vector<SystemPart> parts;
  const std::vector<formats::VesselSystem> systems = triangleSystems(surface);
  for (const formats::VesselSystem system :
       std::set<formats::VesselSystem>(systems.begin(), systems.end())) {
    SurfaceMesh part = surface;
    part.triangle.clear();
    part.group.clear();
    for (std::size_t f = 0; f < systems.size(); ++f) {
      if (systems[f] != system) continue;
      part.triangle.push_back(surface.triangle[f]);
      part.group.push_back(surface.group[f]);
    }
    parts.push_back({system, std::move(part)});
  }
  return parts;
}

bool isClosed(const SurfaceMesh& surface) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> forth, back;
  forth.reserve(3 * surface.triangle.size());
  back.reserve(3 * surface.triangle.size());
  for (const Triangle& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      forth.emplace_back(t[i], t[(i + 1) % 3]);
      back.emplace_back(t[(i + 1) % 3], t[i]);
    }
  std::sort(forth.begin(), forth.end());
  std::sort(back.begin(), back.end());
  return forth == back;
}

void extendBox(const Float3& point, Float3& low, Float3& high) {
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], point[a]);
    high[a] = std::max(high[a], point[a]);
  }
}

namespace {

// Readers of STL accept lines of 255 bytes, and some less.
constexpr std::size_t kLongestWord = 100;

bool isAsciiWord(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '-';
}

}  // namespace

std::string oneWord(const std::string& name) {
  std::string word = name.empty() ? "_" : name;
  for (char& c : word)
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  return word;
}

std::string openFoamWord(const std::string& name) {
  std::string word;
  for (const char byte : name) {
    const auto c = static_cast<unsigned char>(byte);
    const bool isContinued = (c & 0xc0U) == 0x80U;  // continuation byte of a UTF-8 character
    if (isContinued || word.size() == kLongestWord) continue;
    word += isAsciiWord(c) ? byte : '_';
  }
  return word.empty() ? "_" : word;
}

std::vector<std::string> distinct(const std::vector<std::string>& names,
                                  std::string (*rule)(const std::string&)) {
  std::set<std::string> taken;
  std::vector<std::string> words;
  for (const std::string& name : names) {
    const std::string stem = rule(name);
    std::string word = stem;
    for (int n = 2; !taken.insert(word).second; ++n) word = stem + "_" + std::to_string(n);
    words.push_back(word);
  }
  return words;
}

std::vector<std::string> systemNames(const SurfaceMesh& surface) {
  std::vector<std::string> names;
  for (const formats::VesselSystem system : surface.systems) names.emplace_back(systemName(system));
  return names;
}

std::vector<std::string> plainGroupNames(const std::vector<FaceGroup>& groups) {
  std::vector<std::string> names;
  names.reserve(groups.size());
  for (const FaceGroup& group : groups) names.push_back(group.name);
  return names;
}

}  // namespace lumen::convert
