// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/close_sheets.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "converters/geometry/box.h"
#include "converters/stages/surface/remesh/mend_crossings.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kMostInCube = 100;
constexpr float kFold = 0.5F;  // cosine of 60 degrees

std::vector<Eigen::Vector3f> roughNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normal(mesh.position.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangle) {
    const Eigen::Vector3f across = vectorArea(mesh, t).cast<float>();
    for (const std::uint32_t v : t) normal[v] += across;
  }
  return normal;
}

struct GridVertex {
  std::uint64_t cube = 0;
  std::uint32_t vertex = 0;
  float reach = 0;
  Eigen::Vector3f place = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  bool operator<(const GridVertex& other) const {
    return cube < other.cube || (cube == other.cube && vertex < other.vertex);
  }
};

/// Vertices by the cubes of a grid that they are in, cube by cube, each row of cubes along x together.
class VertexGrid {
public:
  VertexGrid(const TriangleMesh& mesh, const std::vector<double>& reach, double edge)
      : m_edge(static_cast<float>(edge)) {
    const std::vector<Eigen::Vector3f> normal = roughNormals(mesh);
    Box3d box;
    for (const Eigen::Vector3d& place : mesh.position) box.add(place);
    m_vertex.resize(mesh.position.size());
    tbb::parallel_for(std::size_t{0}, m_vertex.size(), [&](std::size_t v) {
      const Eigen::Vector3d place = mesh.position[v] - box.low;
      m_vertex[v] = {cubeAt((place / edge).array() + kBorder), static_cast<std::uint32_t>(v),
                     static_cast<float>(reach[v]), place.cast<float>(), normal[v]};
    });
    tbb::parallel_sort(m_vertex.begin(), m_vertex.end());
    for (std::size_t i = 0; i < m_vertex.size(); ++i)
      if (i == 0 || m_vertex[i].cube != m_vertex[i - 1].cube) m_first.push_back(i);
  }

  [[nodiscard]] std::size_t cubes() const { return m_first.size(); }
  /// Calls visit(one, other) for each vertex of a cube and each within the reach of one of its.
  template <class Visit>
  void eachPair(std::size_t cube, const Visit& visit) const {
    const std::size_t end = cube + 1 < m_first.size() ? m_first[cube + 1] : m_vertex.size();
    float most = 0;
    for (std::size_t i = m_first[cube]; i < end; ++i) most = std::max(most, m_vertex[i].reach);
    const auto rings = static_cast<std::int64_t>(std::ceil(most / m_edge));
    const auto own = static_cast<std::int64_t>(m_vertex[m_first[cube]].cube);
    for (std::int64_t z = -rings; z <= rings; ++z)
      for (std::int64_t y = -rings; y <= rings; ++y) {
        const std::int64_t row = own + (z * kRow + y) * kRow;
        const auto last = static_cast<std::uint64_t>(row + rings);
        auto other = std::lower_bound(m_vertex.begin(), m_vertex.end(),
                                      GridVertex{static_cast<std::uint64_t>(row - rings)});
        for (; other != m_vertex.end() && other->cube <= last; ++other)
          for (std::size_t i = m_first[cube]; i < end; ++i) visit(m_vertex[i], *other);
      }
  }

private:
  static constexpr std::int64_t kRow = 1 << 20;  // cubes along x, at most; the same along y
  static constexpr double kBorder = 1 << 10;     // cubes around
  static std::uint64_t cubeAt(const Eigen::Array3d& place) {
    const Eigen::Array<std::int64_t, 3, 1> at = place.cast<std::int64_t>();
    return static_cast<std::uint64_t>((at[2] * kRow + at[1]) * kRow + at[0]);
  }

  float m_edge;  // mm
  std::vector<GridVertex> m_vertex;
  std::vector<std::size_t> m_first;  // by cube
};

/// Marks the corners of triangles that are turned from the surface around.
void markFolds(const TriangleMesh& mesh, std::vector<float>& share) {
  const std::vector<Eigen::Vector3f> normal = roughNormals(mesh);
  for (const Triangle& t : mesh.triangle) {
    const Eigen::Vector3f across = vectorArea(mesh, t).cast<float>();
    const bool isFold = std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return across.dot(normal[v]) < kFold * across.norm() * normal[v].norm();
    });
    if (!isFold) continue;
    for (const std::uint32_t v : t) share[v] = 0;
  }
}

}  // namespace

std::vector<float> closeVertices(const TriangleMesh& mesh, const std::vector<double>& reach) {
  if (reach.empty()) return {};
  std::vector<double> sorted = reach;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const VertexGrid grid(mesh, reach, *middle);
  // in fuller cubes one side of a vessel reaches the other
  if (reach.size() > kMostInCube * grid.cubes()) return std::vector<float>(reach.size(), 0);
  std::vector<float> share(reach.size(), kNotClose);
  const auto note = [&](std::uint32_t v, float found) {
    const std::atomic_ref least(share[v]);
    float known = least.load(std::memory_order_relaxed);
    while (found < known && !least.compare_exchange_weak(known, found, std::memory_order_relaxed)) {
    }
  };
  tbb::parallel_for(std::size_t{0}, grid.cubes(), [&](std::size_t cube) {
    grid.eachPair(cube, [&](const GridVertex& one, const GridVertex& other) {
      if (!(one.normal.dot(other.normal) < 0)) return;
      const float distance = (one.place - other.place).norm();
      if (!(distance < one.reach)) return;
      note(one.vertex, distance / one.reach);
      note(other.vertex, distance / one.reach);
    });
  });
  markFolds(mesh, share);
  return share;
}

std::vector<std::array<std::uint32_t, 2>> crossingsOfChanged(
    const TriangleMesh& mesh, const std::vector<std::uint8_t>& isChanged,
    const std::vector<std::uint8_t>& isSearched, const Progress& progress) {
  std::vector<Box3d> boxes;
  std::size_t searched = 0;
  for (std::size_t f = 0; f < isChanged.size(); ++f) {
    searched += isSearched[f];
    if (isChanged[f] != 0 && isSearched[f] != 0) boxes.push_back(boxOf(mesh, mesh.triangle[f]));
  }
  if (boxes.empty()) return {};
  // a tree of boxes of most triangles finds nothing that the search itself would not
  const bool areMany = 2 * boxes.size() > searched;
  const BoxSet changed(areMany ? std::vector<Box3d>() : std::move(boxes));
  std::vector<std::uint8_t> isNear(isSearched);
  if (!areMany)
    tbb::parallel_for(std::size_t{0}, isNear.size(), [&](std::size_t f) {
      if (isNear[f] != 0) isNear[f] = changed.meets(boxOf(mesh, mesh.triangle[f])) ? 1 : 0;
    });
  auto pairs = crossingsAmong(mesh, isNear, progress).pairs;
  std::erase_if(pairs, [&](const std::array<std::uint32_t, 2>& pair) {
    return isChanged[pair[0]] == 0 && isChanged[pair[1]] == 0;
  });
  return pairs;
}

}  // namespace lumen::convert
