// SPDX-License-Identifier: Apache-2.0
// The arrays of a surface whose edges collapse, in passes that can be undone in part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/simplify/vertex_kinds.h"

namespace lumen::convert {

/// A triangle that gets other corners.
struct ChangedTriangle {
  std::uint32_t index = 0;
  Triangle corner{};
};

/// A vertex that went, and the triangle that it is near.
struct GoneVertex {
  std::uint32_t vertex = 0, triangle = 0;
};

/// A closed surface, the triangles around its vertices, and for each triangle the vertices that went
/// and are near it. In a pass, no two collapses share a triangle.
class CollapsingMesh {
public:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// `closeFrom`: closeVertices(), for lookWithin(); empty: undoCrossings() looks at all triangles.
  CollapsingMesh(CaseSurface& surface, const std::vector<float>& closeFrom);

  [[nodiscard]] std::size_t vertices() const { return m_place.size(); }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return m_triangle; }
  [[nodiscard]] const Eigen::Vector3d& place(std::uint32_t v) const { return m_place[v]; }
  [[nodiscard]] std::uint32_t group(std::uint32_t f) const { return m_surface.group[f]; }
  [[nodiscard]] const VertexKinds& kinds() const { return m_kinds; }
  /// The triangles around a vertex when the pass began, in the order of their indices.
  [[nodiscard]] std::span<const std::uint32_t> fan(std::uint32_t v) const {
    return std::span(m_fan).subspan(m_offset[v], m_offset[v + 1] - m_offset[v]);
  }
  /// The vertices that went and are near a triangle: a list that ends with kNone.
  [[nodiscard]] std::uint32_t firstGone(std::uint32_t f) const { return m_firstGone[f]; }
  [[nodiscard]] std::uint32_t nextGone(std::uint32_t v) const { return m_nextGone[v]; }

  struct Collapse {
    std::uint32_t gone = 0, kept = 0;
    std::size_t firstBefore = 0, firstGone = 0;
    bool isUndone = false;
  };

  /// From now on undoCrossings() looks at triangles with a corner, or a vertex that went near them, that
  /// is close to another sheet within a share of its reach.
  void lookWithin(double share);
  void beginPass();
  /// Whether an earlier collapse of this pass has changed a triangle around the vertex.
  [[nodiscard]] bool isTouched(std::uint32_t v) const { return m_isTouched[v] != 0; }
  /// Replaces the triangles around `gone` by `after`; `taken`: the vertices that went, this one
  /// included, with the triangles that they are near now. Without them all triangles around are
  /// close where one was.
  void collapse(std::uint32_t gone, std::uint32_t kept, const std::vector<ChangedTriangle>& after,
                const std::vector<GoneVertex>& taken);
  /// Undoes the collapses of this pass whose triangles pass through others, until none does.
  void undoCrossings(const Progress& progress);
  [[nodiscard]] const std::vector<Collapse>& collapses() const { return m_collapses; }
  /// The triangles around the vertex of a collapse before it.
  [[nodiscard]] std::span<const ChangedTriangle> before(const Collapse& collapse) const {
    const std::size_t next = static_cast<std::size_t>(&collapse - m_collapses.data()) + 1;
    const std::size_t end =
        next < m_collapses.size() ? m_collapses[next].firstBefore : m_before.size();
    return std::span(m_before).subspan(collapse.firstBefore, end - collapse.firstBefore);
  }
  /// Drops the triangles that went.
  void endPass();

  void dropVertices();
  /// For each triangle, whether undoCrossings() looks at it.
  [[nodiscard]] const std::vector<std::uint8_t>& isClose() const { return m_isCloseTriangle; }

private:
  void undo(Collapse& collapse);
  [[nodiscard]] std::span<const GoneVertex> goneBefore(const Collapse& collapse) const;
  void setGone(const GoneVertex& gone);
  [[nodiscard]] std::uint8_t isCloseVertex(std::uint32_t v) const {
    return m_closeFrom.empty() || double{m_closeFrom[v]} < m_share ? 1 : 0;
  }
  [[nodiscard]] std::uint8_t hasCloseCorner(const Triangle& t) const;

  CaseSurface& m_surface;
  std::vector<Eigen::Vector3d>& m_place;
  std::vector<Triangle>& m_triangle;
  const std::vector<float>& m_closeFrom;
  double m_share = 1;
  std::vector<std::uint8_t> m_isCloseTriangle;
  VertexKinds m_kinds;
  std::vector<std::uint32_t> m_offset, m_fan, m_at;  ///< CSR: triangles around each vertex
  std::vector<std::uint8_t> m_isTouched, m_isDropped;
  std::vector<std::uint32_t> m_nextGone, m_firstGone;
  std::vector<Collapse> m_collapses;
  std::vector<ChangedTriangle> m_before;  ///< of all collapses of the pass
  std::vector<GoneVertex> m_goneBefore;
};

}  // namespace lumen::convert
