// SPDX-License-Identifier: Apache-2.0
#include "tests/evaluation/reproduce/surface_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/io/vtk/vtk_xml.h"

namespace lumen::reproduce {
namespace {

constexpr std::size_t kRays = 12;        // across the vessel, from each node
constexpr double kOffFieldRadii = 1e-3;  // of the radius: farther is not on the field

Eigen::Vector3d toVector(const formats::Vec3f& v) {
  return {v.x, v.y, v.z};
}

std::vector<std::uint32_t> indices(const VtkArray* array, std::size_t count, double first,
                                   const std::string& name) {
  if (array == nullptr || array->values.size() != count)
    throw invalidInput(name + " does not have the arrays Branch and ModelFaceID");
  std::vector<std::uint32_t> result;
  for (const double value : array->values)
    result.push_back(static_cast<std::uint32_t>(value - first));
  return result;
}

// The distance of a point from the field's surface, mm, for a cursor that begins at `node`.
double distanceToField(const convert::SeparatedField& field, const Eigen::Vector3d& point,
                       std::uint32_t node) {
  constexpr double kStraight = 0.02;  // of the radius: so near to the wall, one evaluation tells
  const convert::SeparatedSample sample = field.at(point, node);
  if (std::abs(sample.distance) > kStraight * field.radius(sample.node))
    if (const auto foot = field.project(point, node)) return (foot->position - point).norm();
  return std::abs(sample.distance);
}

/// Where the nodes of a branch lie.
class Branches {
public:
  explicit Branches(const convert::SeparatedField& field)
      : m_field(field), m_tree(field.source().tree) {}

  /// The nodes of the branch that have less power at the point than those beside them: one for each leg that is near.
  [[nodiscard]] std::vector<std::uint32_t> cursors(const Eigen::Vector3d& point,
                                                   std::uint32_t branch) const {
    const formats::Branch& of = m_tree.branches[branch];
    const auto power = [&](std::uint32_t n) {
      const double r = m_tree.radius[n];
      return (point - toVector(m_tree.centre[n])).squaredNorm() - r * r;
    };
    const std::uint32_t end = of.firstNode + of.nodeCount;
    std::vector<std::uint32_t> result;
    double before = std::numeric_limits<double>::infinity(), here = power(of.firstNode);
    for (std::uint32_t n = of.firstNode; n < end; ++n) {
      const double after = n + 1 < end ? power(n + 1) : std::numeric_limits<double>::infinity();
      const double reach = 3 * double{m_tree.radius[n]};
      if (here <= before && here <= after && here < reach * reach) result.push_back(n);
      before = here, here = after;
    }
    return result;
  }

  /// The least distance to a sheet that one of the cursors reaches, in radii.
  [[nodiscard]] Farthest nearestSheet(const Eigen::Vector3d& point,
                                      const std::vector<std::uint32_t>& cursors) const {
    Farthest best{std::numeric_limits<double>::infinity(), point, 0};
    for (const std::uint32_t cursor : cursors) {
      const convert::SeparatedSample at = m_field.at(point, cursor);
      const double share = distanceToField(m_field, point, cursor) / m_field.radius(at.node);
      if (share < best.radii) best = {share, point, at.node};
    }
    return best;
  }

private:
  const convert::SeparatedField& m_field;
  const formats::CenterlineTree& m_tree;
};

void keepFarther(Farthest& most, const Farthest& other) {
  if (other.radii > most.radii) most = other;
}

// Where the ray leaves the lumen of the node's sheet; nothing within three radii.
std::optional<Eigen::Vector3d> wallAlong(const convert::SeparatedField& field, std::uint32_t node,
                                         const Eigen::Vector3d& from,
                                         const Eigen::Vector3d& outwards) {
  if (field.at(from, node).distance >= 0) return std::nullopt;
  double inside = 0, outside = 0;
  const double radius = field.radius(node);
  for (outside = 0.1; field.at(from + outside * radius * outwards, node).distance < 0;
       outside += 0.1) {
    inside = outside;
    if (outside > 3) return std::nullopt;
  }
  for (int step = 0; step < 30; ++step) {
    const double middle = (inside + outside) / 2;
    (field.at(from + middle * radius * outwards, node).distance < 0 ? inside : outside) = middle;
  }
  const Eigen::Vector3d wall = from + inside * radius * outwards;
  // The sheet that the node answers for jumps where a cursor takes another way: that is no wall.
  return std::abs(field.at(wall, node).distance) < kOffFieldRadii * radius ? std::optional(wall)
                                                                           : std::nullopt;
}

void measureField(const convert::SeparatedField& field, const WrittenSurface& surface,
                  FieldFacts& facts) {
  const formats::CenterlineTree& tree = field.source().tree;
  const convert::TriangleTree boxes(surface.mesh);
  std::vector<Farthest> most(tree.nodeCount());
  std::vector<std::size_t> met(tree.nodeCount(), 0);
  tbb::parallel_for(
      std::uint32_t{0}, static_cast<std::uint32_t>(tree.nodeCount()), [&](std::uint32_t n) {
        const Eigen::Vector3d centre = toVector(tree.centre[n]),
                              along = toVector(tree.direction[n]);
        const Eigen::Vector3d u = along.unitOrthogonal(), v = along.cross(u);
        for (std::size_t k = 0; k < kRays; ++k) {
          const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kRays;
          const auto wall = wallAlong(field, n, centre, std::cos(angle) * u + std::sin(angle) * v);
          if (!wall) continue;
          const convert::NearestPoint nearest = boxes.nearest(*wall);
          if (surface.group[nearest.triangle] != 0) continue;  // beyond an end
          ++met[n];
          keepFarther(most[n], {nearest.distance / field.radius(n), *wall, n});
        }
      });
  for (std::size_t n = 0; n < most.size(); ++n) {
    keepFarther(facts.field, most[n]);
    facts.rays += met[n];
  }
}

}  // namespace

WrittenSurface readSurface(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::array<std::string_view, 2> wanted{"Branch", "ModelFaceID"};
  const VtkPolyData data = parseVtkXml(text, file.string(), wanted);
  WrittenSurface surface;
  surface.mesh.position = data.position;
  for (std::size_t c = 0; c < data.polys.size(); ++c) {
    if (data.polys.end[c] - data.polys.begin(c) != 3)
      throw invalidInput(file.string() + " has polygons that are no triangles");
    const std::uint32_t* p = &data.polys.point[data.polys.begin(c)];
    surface.mesh.triangle.push_back({p[0], p[1], p[2]});
  }
  surface.branch = indices(data.pointArray("Branch"), data.position.size(), 0, file.string());
  surface.group = indices(data.cellArray("ModelFaceID"), data.polys.size(), 1, file.string());
  return surface;
}

std::vector<std::ptrdiff_t> eulerOfTrees(const formats::Case& source) {
  const formats::CenterlineTree& tree = source.tree;
  convert::DisjointSets sets(tree.nodeCount());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] >= 0) sets.join(n, static_cast<std::uint32_t>(tree.parent[n]));
  std::map<std::uint32_t, std::ptrdiff_t> loops;
  std::vector<std::array<std::uint32_t, 2>> closing;
  for (const auto& link : tree.links) {
    if (sets.find(link[0]) == sets.find(link[1]))
      closing.push_back(link);
    else
      sets.join(link[0], link[1]);
  }
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (source.models->offset[n + 1] > source.models->offset[n]) loops[sets.find(n)] += 0;
  for (const auto& link : closing) ++loops[sets.find(link[0])];
  std::vector<std::ptrdiff_t> result;
  for (const auto& [root, count] : loops) result.push_back(2 - 2 * count);
  std::ranges::sort(result);
  return result;
}

FieldFacts distanceFrom(const convert::SeparatedField& field, const WrittenSurface& surface) {
  const Branches branches(field);
  const convert::TriangleMesh& mesh = surface.mesh;
  std::vector<std::uint8_t> isWall(mesh.position.size(), 0), isEnd(mesh.position.size(), 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::uint32_t v : mesh.triangle[t]) (surface.group[t] == 0 ? isWall : isEnd)[v] = 1;
  std::vector<Farthest> ofVertex(mesh.position.size()), ofMiddle(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, mesh.position.size(), [&](std::size_t v) {
    if (isWall[v] != 0)
      ofVertex[v] = branches.nearestSheet(mesh.position[v],
                                          branches.cursors(mesh.position[v], surface.branch[v]));
  });
  tbb::parallel_for(std::size_t{0}, mesh.triangle.size(), [&](std::size_t t) {
    if (surface.group[t] != 0) return;
    const convert::Triangle& c = mesh.triangle[t];
    const Eigen::Vector3d middle =
        (mesh.position[c[0]] + mesh.position[c[1]] + mesh.position[c[2]]) / 3;
    ofMiddle[t] = branches.nearestSheet(
        middle, {ofVertex[c[0]].node, ofVertex[c[1]].node, ofVertex[c[2]].node});
  });
  FieldFacts facts;
  for (std::size_t v = 0; v < ofVertex.size(); ++v) {
    facts.vertices += isWall[v];
    if (ofVertex[v].radii > kOffFieldRadii) ++facts.verticesFar;
    keepFarther(facts.vertex, ofVertex[v]);
  }
  for (const Farthest& middle : ofMiddle) keepFarther(facts.middle, middle);
  measureField(field, surface, facts);
  return facts;
}

EndFacts measureEnds(const formats::Case& source, const WrittenSurface& surface) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> vertices;
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (surface.group[t] != 0)
      for (const std::uint32_t v : surface.mesh.triangle[t])
        vertices[surface.group[t]].push_back(v);
  EndFacts facts;
  facts.groups = vertices.size();
  for (const auto& [group, members] : vertices) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : members)
      mean += surface.mesh.position[v] / static_cast<double>(members.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const std::uint32_t v : members) {
      const Eigen::Vector3d d = surface.mesh.position[v] - mean;
      spread += d * d.transpose() / static_cast<double>(members.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    if (axes.eigenvalues()[0] > 1e-6 * axes.eigenvalues()[2]) continue;
    ++facts.flat;
    const Eigen::Vector3d normal = axes.eigenvectors().col(0);
    std::uint32_t node = 0;
    double least = std::numeric_limits<double>::infinity();
    const std::uint32_t branch = surface.branch[members.front()];
    const formats::Branch& of = source.tree.branches[branch];
    for (std::uint32_t n = of.firstNode; n < of.firstNode + of.nodeCount; ++n)
      if (const double d = (toVector(source.tree.centre[n]) - mean).norm(); d < least)
        least = d, node = n;
    const double cosine = std::abs(normal.dot(toVector(source.tree.direction[node])));
    facts.tilt = std::max(facts.tilt, std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi);
  }
  return facts;
}

}  // namespace lumen::reproduce
