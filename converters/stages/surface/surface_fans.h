// SPDX-License-Identifier: Apache-2.0
// A surface from which triangles are taken, and to which others are added, in few places.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "converters/stages/surface/case_surface.h"

namespace lumen::convert {

/// The triangles at each vertex of a surface, which must stay.
class SurfaceFans {
public:
  explicit SurfaceFans(CaseSurface& surface);

  [[nodiscard]] CaseSurface& surface() { return m_surface; }
  [[nodiscard]] const CaseSurface& surface() const { return m_surface; }
  /// The triangles at a vertex, without those that were removed.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const;
  /// True if some triangle has both vertices.
  [[nodiscard]] bool areJoined(std::uint32_t a, std::uint32_t b) const;

  std::uint32_t addVertex(const Eigen::Vector3d& position, std::uint32_t node);
  void add(const Triangle& triangle, std::uint32_t group);
  void remove(std::uint32_t triangle);

  /// Drops the removed triangles, and the vertices without triangles; the fans end with it.
  void compact();

private:
  std::vector<std::uint32_t>& changed(std::uint32_t vertex);

  CaseSurface& m_surface;
  std::vector<std::uint32_t> m_offset, m_triangle;  ///< CSR of the surface as it was
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> m_changed;
  std::vector<bool> m_isRemoved;
};

}  // namespace lumen::convert
