// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/packs/case_pack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <meshoptimizer.h>
#include <zlib.h>

#include "converters/base/error.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/judge/facts/branch_end.h"
#include "converters/judge/facts/reachable.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/judge/measure/vessel_length.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "formats/case/enum_names.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"
#include "formats/field/pose.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

namespace {

Json branchesJson(const formats::Case& value, const convert::VesselLengths& lengths) {
  const formats::CenterlineTree& tree = value.tree;
  const std::vector<formats::VesselSystem> systems = formats::readBranchSystems(value);
  const std::vector<std::string> ends = convert::describeEnds(value);
  Json list = Json::array();
  for (const formats::Branch& branch : tree.branches) {
    const auto mean = branch.meanInlierRate;
    list.push_back(
        {{"label", branch.label},
         {"kind", formats::enumName(formats::kBranchKindNames, branch.kind)},
         {"parent_node", branch.parentNode},
         {"first_node", branch.firstNode},
         {"node_count", branch.nodeCount},
         {"end", ends[list.size()]},
         {"stop_reason", formats::enumName(formats::kStopReasonNames, branch.stopReason)},
         {"confidence", mean ? engine::jsonNumber(*mean) : Json(nullptr)},
         {"length_mm", engine::jsonNumber(lengths.branch[list.size()])},
         {"system", formats::kVesselSystemNames[static_cast<std::size_t>(systems[list.size()])]}});
  }
  return list;
}

/// mm along the tree from each node's root; a node's parent has a smaller index.
std::vector<float> rootDistances(const formats::CenterlineTree& tree,
                                 const std::vector<double>& edge) {
  std::vector<double> distance(tree.nodeCount(), 0);
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node)
    if (const std::int32_t parent = tree.parent[node]; parent >= 0)
      distance[node] = distance[static_cast<std::size_t>(parent)] + edge[node];
  return {distance.begin(), distance.end()};
}

Json reachableJson(const formats::Case& value, const Progress& progress) {
  const auto reach = convert::measureReach(value, progress);
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const convert::ClosedPath& path : reach->closed)
    closed.push_back({{"node", path.node},
                      {"position", {path.position.x, path.position.y, path.position.z}},
                      {"beyond_mm", path.beyond}});
  return {{"reached_mm", reach->length},
          {"total_mm", reach->of},
          {"trees", reach->trees},
          {"closed", std::move(closed)}};
}

void addNodes(PackWriter& pack, const formats::CenterlineTree& tree,
              const convert::VesselLengths& lengths) {
  pack.add("centre", std::span(tree.centre));
  pack.add("direction", std::span(tree.direction));
  pack.add("radius_mm", tree.radius);
  pack.add("height_mm", tree.height);
  pack.add("parent", tree.parent);
  pack.add("branch", tree.branch);
  if (!tree.inlierRate.empty()) pack.add("inlier_rate", tree.inlierRate);
  pack.add("root_distance_mm", rootDistances(tree, lengths.edge));
  pack.add("links", std::span(tree.links));
}

void addOrigins(PackWriter& pack, const formats::Case& value) {
  const bool stated = std::any_of(value.nodeArrays.begin(), value.nodeArrays.end(),
                                  [](const auto& a) { return a.name == formats::kOriginArray; });
  if (!stated) return;
  std::vector<std::uint8_t> origins;
  for (const formats::NodeOrigin origin : formats::readNodeOrigins(value))
    origins.push_back(static_cast<std::uint8_t>(origin));
  pack.add("origin", origins);
}

void addEdited(PackWriter& pack, const formats::Case& value) {
  const std::vector<bool> edited = formats::readEditedWalls(value);
  if (std::find(edited.begin(), edited.end(), true) != edited.end())
    pack.add("edited", std::vector<std::uint8_t>(edited.begin(), edited.end()));
}

/// Poses of the moving nodes, time by time; the rotations have the length 1.
void addMotion(PackWriter& pack, const std::optional<formats::Motion>& motion) {
  if (!motion) {
    pack.set("motion", nullptr);
    return;
  }
  std::vector<formats::Vec3f> centre;
  std::vector<float> rotation, factor;
  for (const formats::Pose& pose : motion->pose) {
    const auto& [x, y, z, w] = pose.rotation;
    for (const double part : field::unit({x, y, z, w}))
      rotation.push_back(static_cast<float>(part));
    centre.push_back(pose.centre);
    factor.push_back(pose.factor);
  }
  pack.set("motion", {{"times_s", motion->time},
                      {"period_s", motion->period > 0 ? Json(motion->period) : Json(nullptr)}});
  pack.add("motion_node", motion->node);
  pack.add("motion_centre", std::span(std::as_const(centre)));
  pack.add("motion_rotation", std::span(std::as_const(rotation)), {motion->pose.size(), 4});
  pack.add("motion_factor", factor);
}

}  // namespace

std::string casePack(const formats::Case& value, bool withPoints, Progress& progress) {
  PackWriter pack;
  const convert::VesselLengths lengths = convert::vesselLengths(value.tree);
  addNodes(pack, value.tree, lengths);
  addOrigins(pack, value);
  addEdited(pack, value);
  if (value.points && value.models)
    pack.add("error_mm",
             convert::errorOfFit(value, convert::fittedNeighbourhood(value.metadata), progress));
  if (value.points && withPoints) {
    pack.add("point_offset", value.points->offset);
    pack.add("point", std::span(value.points->position));
  }
  addMotion(pack, value.motion);
  pack.set("branches", branchesJson(value, lengths));
  const auto& voxel = value.metadata.voxelSize;
  pack.set("voxel_size_mm", voxel ? engine::jsonNumber(*voxel) : Json(nullptr));
  const auto least = convert::leastShownRadius(value.metadata);
  pack.set("least_shown_radius_mm", least ? engine::jsonNumber(*least) : Json(nullptr));
  pack.set("has_models", value.models.has_value());
  pack.set("reachable", reachableJson(value, progress));
  pack.set("steps", engine::stepsJson(value.metadata));
  return pack.bytes();
}

namespace {

constexpr std::uint32_t kPositionSteps = 65535;  // steps in a head's 240 mm: under 4 um
constexpr std::uint32_t kRadiusSteps = 4095;     // only colours show it
constexpr std::uint32_t kDistanceSteps = 65535;  // the farthest vertex may be far
constexpr std::uint32_t kNone = 0xffffffff;

/// The arrays of a pack that this program has made.
class PackReader {
public:
  explicit PackReader(std::string_view pack) {
    std::uint32_t size = 0;
    std::memcpy(&size, pack.data(), sizeof size);
    m_members = Json::parse(pack.substr(sizeof size, size));
    m_arrays = pack.substr(sizeof size + size);
  }
  [[nodiscard]] const Json& members() const { return m_members; }
  [[nodiscard]] bool has(const char* name) const { return m_members["arrays"].contains(name); }
  template <class T>
  [[nodiscard]] std::vector<T> get(const char* name) const {
    const Json& place = m_members["arrays"][name];
    std::size_t count = 1;
    for (const Json& n : place["shape"]) count *= n.get<std::size_t>();
    std::vector<T> values(count);
    if (count > 0)
      std::memcpy(values.data(), m_arrays.data() + place["offset"].get<std::size_t>(),
                  count * sizeof(T));
    return values;
  }

private:
  Json m_members;
  std::string_view m_arrays;
};

/// Triangles that follow each other share vertices, part by part, and the vertices are numbered as
/// they come; the greatest of a triangle is its last. Gives the old number of each new vertex.
std::vector<std::uint32_t> order(std::vector<std::uint32_t>& triangle, std::size_t vertices,
                                 const Json& parts) {
  std::vector<std::uint32_t> inPart;
  for (const Json& part : parts) {
    const auto first = 3 * part["first"].get<std::size_t>(),
               count = 3 * part["count"].get<std::size_t>();
    const std::span<std::uint32_t> place(triangle.data() + first, count);
    inPart.assign(place.begin(), place.end());
    meshopt_optimizeVertexCache(place.data(), inPart.data(), count, vertices);
  }
  std::vector<std::uint32_t> number(vertices, kNone), old;
  for (std::uint32_t& vertex : triangle) {
    if (number[vertex] == kNone) {
      number[vertex] = static_cast<std::uint32_t>(old.size());
      old.push_back(vertex);
    }
    vertex = number[vertex];
  }
  for (auto t = triangle.begin(); t != triangle.end(); t += 3)
    std::rotate(t, std::max_element(t, t + 3) + 1 == t + 3 ? t : std::max_element(t, t + 3) + 1,
                t + 3);
  return old;
}

/// `values` as bytes: of each column in turn first the lowest byte of every value, and so on.
template <class T>
std::string planes(const std::vector<T>& values, std::size_t columns) {
  std::string bytes;
  bytes.reserve(values.size() * sizeof(T));
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t k = 0; k < sizeof(T); ++k)
      for (std::size_t i = c; i < values.size(); i += columns)
        bytes += static_cast<char>(values[i] >> (8 * k) & 0xff);
  return bytes;
}

template <class T>
void toDifferences(std::vector<T>& values, std::size_t columns) {
  for (std::size_t i = values.size(); i-- > columns;)
    values[i] = static_cast<T>(values[i] - values[i - columns]);
}

/// Distance of each index below the next new vertex.
void toDistancesBack(std::vector<std::uint32_t>& triangle) {
  std::uint32_t next = 0;
  for (std::uint32_t& vertex : triangle) {
    const std::uint32_t index = vertex;
    vertex = next - index;  // modulo 2^32
    next = std::max(next, index + 1);
  }
}

void addTriangles(PackWriter& pack, const std::string& name, std::vector<std::uint32_t> triangle) {
  toDistancesBack(triangle);
  pack.addStored(name, planes(triangle, 3),
                 {{"type", "u32"},
                  {"shape", {triangle.size() / 3, 3}},
                  {"stored", "u32"},
                  {"coding", "back"}});
}

/// Numbers in steps of each column's range.
void addSteps(PackWriter& pack, const std::string& name, const std::vector<float>& values,
              const std::vector<std::uint32_t>& old, std::size_t columns, std::uint32_t steps) {
  std::vector<std::uint16_t> stored(old.size() * columns);
  Json low = Json::array(), step = Json::array();
  for (std::size_t c = 0; c < columns; ++c) {
    double least = 0, most = 0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      const double value{values[old[i] * columns + c]};
      least = i == 0 ? value : std::min(least, value);
      most = i == 0 ? value : std::max(most, value);
    }
    const double size = most > least ? (most - least) / steps : 1;
    for (std::size_t i = 0; i < old.size(); ++i)
      stored[i * columns + c] = static_cast<std::uint16_t>(
          std::lround((double{values[old[i] * columns + c]} - least) / size));
    low.push_back(least);
    step.push_back(size);
  }
  toDifferences(stored, columns);
  std::vector<std::size_t> shape{old.size()};
  if (columns > 1) shape.push_back(columns);
  pack.addStored(name, planes(stored, columns),
                 {{"type", "f32"},
                  {"shape", shape},
                  {"stored", "u16"},
                  {"coding", "differences"},
                  {"low", low},
                  {"step", step}});
}

/// Rows of four numbers, in the new order of their vertices.
void addFours(PackWriter& pack, const std::string& name, const std::vector<std::uint16_t>& values,
              const std::vector<std::uint32_t>& old) {
  std::vector<std::uint16_t> rows;
  rows.reserve(4 * old.size());
  for (const std::uint32_t vertex : old)
    rows.insert(rows.end(), values.begin() + 4 * static_cast<std::ptrdiff_t>(vertex),
                values.begin() + 4 * (static_cast<std::ptrdiff_t>(vertex) + 1));
  pack.add(name, std::span(std::as_const(rows)), {old.size(), 4});
}

}  // namespace

std::string compactPack(std::string_view bytes) {
  const PackReader read(bytes);
  const auto position = read.get<float>("position");
  auto triangle = read.get<std::uint32_t>("triangle");
  const auto old = order(triangle, position.size() / 3, read.members()["parts"]);
  PackWriter pack;
  for (const auto& [name, value] : read.members().items())
    if (name != "arrays") pack.set(name, value);
  addSteps(pack, "position", position, old, 3, kPositionSteps);
  if (read.has("radius_mm"))
    addSteps(pack, "radius_mm", read.get<float>("radius_mm"), old, 1, kRadiusSteps);
  if (read.has("node")) {
    const auto all = read.get<std::uint32_t>("node");
    std::vector<std::uint32_t> node(old.size());
    for (std::size_t i = 0; i < old.size(); ++i) node[i] = all[old[i]];
    toDifferences(node, 1);
    pack.addStored(
        "node", planes(node, 1),
        {{"type", "u32"}, {"shape", {node.size()}}, {"stored", "u32"}, {"coding", "differences"}});
  }
  if (read.has("joint_node")) {
    pack.add("joint_node", read.get<std::int32_t>("joint_node"));
    for (const char* const name : {"joint", "weight"})
      addFours(pack, name, read.get<std::uint16_t>(name), old);
  }
  addTriangles(pack, "triangle", std::move(triangle));
  if (read.has("moving")) {
    auto moving = read.get<std::uint32_t>("moving");
    std::vector<std::uint32_t> number(position.size() / 3);
    for (std::size_t i = 0; i < old.size(); ++i) number[old[i]] = static_cast<std::uint32_t>(i);
    for (std::uint32_t& vertex : moving) vertex = number[vertex];
    addTriangles(pack, "moving", std::move(moving));
  }
  return pack.bytes();
}

std::string compactDistances(std::string_view mesh, std::string_view distances) {
  const PackReader of(mesh), read(distances);
  auto triangle = of.get<std::uint32_t>("triangle");
  const auto old = order(triangle, of.get<float>("position").size() / 3, of.members()["parts"]);
  PackWriter pack;
  for (const auto& [name, value] : read.members().items())
    if (name != "arrays") pack.set(name, value);
  addSteps(pack, "distance_mm", read.get<float>("distance_mm"), old, 1, kDistanceSteps);
  return pack.bytes();
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                Z_BEST_COMPRESSION) != Z_OK)
    throw failed("there is not enough memory");
  out.resize(size);
  return out;
}

}  // namespace lumen::viewer
