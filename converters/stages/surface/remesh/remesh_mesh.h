// SPDX-License-Identifier: Apache-2.0
// The halfedge mesh of a piece, and which changes to it are allowed. Only sources that change
// meshes include this: OpenMesh's headers are slow to compile.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
// EigenVectorT.hh specialises a template without including it.
// clang-format off
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Core/Geometry/EigenVectorT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
// clang-format on

#include "converters/stages/surface/remesh/remesh_piece.h"

namespace lumen::convert {

/// Freedom of a vertex to move.
enum class VertexKind : std::uint8_t {
  Wall,   ///< along the field's surface
  Flat,   ///< within the plane of its end
  Rim,    ///< along a rim
  Locked  ///< not at all
};

struct RemeshTraits : OpenMesh::DefaultTraits {
  using Point = Eigen::Vector3d;
  using Normal = Eigen::Vector3d;
  VertexTraits {
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double target = 0;
    double drift = 0;  // along the surface since it was last moved onto the field, mm
    std::uint32_t node = 0;
    std::uint32_t home = kNewVertex;
    int valence = 0;        // while flipToSix() runs
    std::uint32_t end = 0;  // the group of the flat end, of kinds Flat and Rim; 0: none
    VertexKind kind = VertexKind::Wall;
    bool isSeparated = false;
    bool isOffField = false;
  };
  FaceTraits { std::uint32_t group = 0; };
  EdgeTraits { bool isRim = false; };
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
};

/// A piece as halfedges, with the rules that keep it a manifold with its rims on the same surface.
class RemeshMesh : public OpenMesh::TriMesh_ArrayKernelT<RemeshTraits> {
public:
  using Corners = std::array<Eigen::Vector3d, 3>;

  RemeshMesh(const RemeshPiece& piece, const PieceRules& rules);
  [[nodiscard]] RemeshPiece toPiece() const;
  [[nodiscard]] const PieceRules& rules() const { return m_rules; }
  /// One element of a long loop is done: now and then throws Error(Cancelled) if it is to stop.
  void pulse() {
    if (++m_pulse % kPulses == 0) m_rules.progress.check();
  }

  [[nodiscard]] double lengthOf(EdgeHandle edge) const {
    const HalfedgeHandle h = halfedge_handle(edge, 0);
    return (point(to_vertex_handle(h)) - point(from_vertex_handle(h))).norm();
  }
  [[nodiscard]] double targetOf(EdgeHandle edge) const {
    const HalfedgeHandle h = halfedge_handle(edge, 0);
    return 0.5 * (data(to_vertex_handle(h)).target + data(from_vertex_handle(h)).target);
  }
  [[nodiscard]] std::array<VertexHandle, 3> verticesOf(FaceHandle face) const {
    const HalfedgeHandle h = halfedge_handle(face);
    return {from_vertex_handle(h), to_vertex_handle(h), to_vertex_handle(next_halfedge_handle(h))};
  }
  [[nodiscard]] Corners cornersOf(FaceHandle face) const {
    const auto v = verticesOf(face);
    return {point(v[0]), point(v[1]), point(v[2])};
  }
  /// Calls `visit` with the face and the other two vertices, in its order, of each face around
  /// `vertex`, which has one. Quicker than OpenMesh's circulators with verticesOf().
  template <class Visit>
  void eachFaceAround(VertexHandle vertex, Visit&& visit) const {
    const HalfedgeHandle first = halfedge_handle(vertex);
    HalfedgeHandle h = first;
    do {
      const HalfedgeHandle before = prev_halfedge_handle(h);
      if (const FaceHandle face = face_handle(h); face.is_valid())
        visit(face, to_vertex_handle(h), from_vertex_handle(before));
      h = opposite_halfedge_handle(before);
    } while (h != first);
  }
  [[nodiscard]] EdgeHandle longestEdge(FaceHandle face) const;

  /// The direction in which a face of these vertices should look, of any length: zero if unknown.
  [[nodiscard]] Eigen::Vector3d outward(std::uint32_t group,
                                        const std::array<VertexHandle, 3>& vertices) const {
    if (const auto& plane = m_rules.plane[group]) return *plane;
    return data(vertices[0]).gradient + data(vertices[1]).gradient + data(vertices[2]).gradient;
  }
  /// The squared sine of a face's least angle; 0 if it is turned away from where it should look.
  [[nodiscard]] double measureQuality(FaceHandle face) const;
  [[nodiscard]] double measureQuality(const Corners& corners, const Eigen::Vector3d& outward) const;

  /// A face around a vertex, without that vertex' place.
  struct StarFace {
    Eigen::Vector3d a, b;     ///< the other corners, in the order of the face
    Eigen::Vector3d outward;  ///< as outward()
    double target = 0;        ///< sum of the corners' targets
  };
  /// Makes `star` the faces around `vertex`, which has one: for several places of the vertex that
  /// are looked at one after another.
  void gatherStar(VertexHandle vertex, std::vector<StarFace>& star) const;
  /// The least quality of a star's faces, as if its vertex were at `position`; any value up to
  /// `least` if it is not more than that.
  [[nodiscard]] double starQuality(const std::vector<StarFace>& star,
                                   const Eigen::Vector3d& position, double least = 0) const;
  /// True if no face of a star is turned away, or further than now, by moving its vertex from
  /// `here` to `position`.
  [[nodiscard]] bool mayMove(const std::vector<StarFace>& star, const Eigen::Vector3d& here,
                             const Eigen::Vector3d& position) const;

  /// Whether topology, rims and boundary allow a collapse of `h` (its start vanishes);
  /// afterCollapse() has its outcome.
  [[nodiscard]] bool mayCollapse(HalfedgeHandle h) const;
  struct Outcome {
    bool isTurned = false;  ///< a face would turn away, or further than before
    double quality = 0;     ///< the least of the changed faces, after
    double before = 0;      ///< the least before, with the faces that vanish
    double longest = 0;     ///< longest new edge, over its target
  };
  [[nodiscard]] Outcome afterCollapse(HalfedgeHandle h) const;
  /// True if Outcome::longest would be more than `share`: faster than the full outcome.
  [[nodiscard]] bool makesLonger(HalfedgeHandle h, double share) const;
  /// Collapses like OpenMesh, whose decimater calls it too, and counts the edges of rims.
  void collapse(HalfedgeHandle h);

  [[nodiscard]] bool mayFlip(EdgeHandle edge) const;
  [[nodiscard]] Outcome afterFlip(EdgeHandle edge) const;

  /// Puts a vertex in the middle of `edge`; its place in the field is not looked up.
  VertexHandle splitEdge(EdgeHandle edge);

private:
  void findKinds();
  /// Calls `visit` with each vertex around `vertex`, which has an edge, until it returns false; true
  /// if it never did.
  template <class Visit>
  bool eachAround(VertexHandle vertex, Visit&& visit) const {
    const HalfedgeHandle first = halfedge_handle(vertex);
    HalfedgeHandle h = first;
    do {
      if (!visit(to_vertex_handle(h))) return false;
      h = opposite_halfedge_handle(prev_halfedge_handle(h));
    } while (h != first);
    return true;
  }
  [[nodiscard]] bool keepsManifold(HalfedgeHandle h) const;
  static constexpr std::uint32_t kPulses = 4096;  // elements that take a few milliseconds
  const PieceRules& m_rules;
  std::uint32_t m_pulse = 0;
  std::vector<std::uint32_t> m_rimEdges;  ///< count for each group
};

}  // namespace lumen::convert
