// SPDX-License-Identifier: Apache-2.0
// The wall that a mesh of a whole case follows: the wall of the blended field, kept off other
// vessels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/case/topology.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

/// Position of the wall; lengths in mm.
struct SeparationOptions {
  /// Gap between two vessels where their walls touch or overlap.
  double gap = 0;
  /// Gap as a share of the lesser radius of both; added to `gap`.
  double gapShare = 0;
  /// Greatest distance of the surface outside of the lumen's wall: 0, or a wall's thickness.
  double offset = 0;
  /// Distance as a share of the local radius; added to `offset`.
  double offsetShare = 0;
  /// Least length of the path along the tree between vessels that touch, as a multiple of the width
  /// of both.
  double leastPath = 0;
  /// Whether vessels that touch are one: none keeps off another.
  bool isUnion = false;
};

/// Values of a SeparatedField at a point.
struct SeparatedSample {
  double distance = 0;  ///< to the surface, about, mm; negative inside
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< unit, out of the lumen
  std::uint32_t node = 0;                              ///< at which following the point ends
  bool isSeparated = false;  ///< here the surface keeps off another vessel and is not f = T
  double wall = 0;           ///< distance to f = T, about, mm; negative inside
  std::uint32_t other = 0;   ///< where isSeparated: the node of the other vessel
};

/// The signed distance to the surface of a case, for a point reached along the tree.
///
/// A *sheet* of a point is a node that following a cursor can end at, with the nodes that blend
/// with it there: two vessels that touch are two sheets. With d the distance to a sheet's wall (the
/// one-evaluation distance of docs/method.md, section 4.2) and a the distance to its axis, as a
/// share of the radius there, the surface is the zero of
///
///     g = max(d, (a - a') / |grad(a - a')| + gap/2)
///
/// where a' is that of the other sheet that gives most. So where two lumens overlap each
/// ends half a gap before the place that is as far from both axes, and no vessel loses its axis to
/// a wider one. Within a quarter of a radius of its axis the node of the greater index goes first,
/// so that neither is severed where two axes cross.
///
/// Never changed after construction: any number of threads may ask.
class SeparatedField {
public:
  /// `source` has models and, with `field`, must stay.
  SeparatedField(const formats::Case& source, const field::BlendedField& field,
                 const SeparationOptions& options);
  virtual ~SeparatedField() = default;
  SeparatedField(const SeparatedField&) = delete;
  SeparatedField& operator=(const SeparatedField&) = delete;

  /// The sample for a cursor that begins at `node` and follows.
  [[nodiscard]] virtual SeparatedSample at(const Eigen::Vector3d& point, std::uint32_t node) const;

  /// The sample of the sheet of a point whose axis is the nearest in radii, among the one that
  /// following from `node` leads to and those that touch it.
  [[nodiscard]] virtual SeparatedSample deepest(const Eigen::Vector3d& point,
                                                std::uint32_t node) const;

  /// Whether two cursors that have followed a point are on one sheet of it.
  [[nodiscard]] bool areOneSheet(const Eigen::Vector3d& point, std::uint32_t a,
                                 std::uint32_t b) const;

  /// Whether a cursor at node `from` that follows to the point gets onto the sheet of node `to`.
  [[nodiscard]] virtual bool isReached(const Eigen::Vector3d& point, std::uint32_t from,
                                       std::uint32_t to) const;

  /// Distance of a point from the axis at a node, as a share of the radius there.
  [[nodiscard]] double axisShare(const Eigen::Vector3d& point, std::uint32_t node) const {
    return nearestAxis(point, node).share;
  }

  /// Whether another vessel may be near a node.
  [[nodiscard]] bool mayTouch(std::uint32_t node) const {
    return m_touchingOffset[node] < m_touchingOffset[node + 1];
  }

  /// The nodes that may touch a node, ascending.
  [[nodiscard]] std::span<const std::uint32_t> touching(std::uint32_t node) const {
    return std::span(m_touching)
        .subspan(m_touchingOffset[node], m_touchingOffset[node + 1] - m_touchingOffset[node]);
  }

  /// The point of the surface that Newton's method reaches from `start`, within 1e-4 of the local
  /// radius; `sample`: the values of at() there. With `plane`, a unit vector, it stays in the plane
  /// through `start` normal to it. Nothing if there is no surface near by.
  struct Foot {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    SeparatedSample sample;
  };
  [[nodiscard]] std::optional<Foot> project(const Eigen::Vector3d& start, std::uint32_t node,
                                            const Eigen::Vector3d* plane = nullptr) const;

  /// The radius of the vessel at a node, mm.
  [[nodiscard]] double radius(std::uint32_t node) const { return m_source.tree.radius[node]; }
  [[nodiscard]] const formats::Case& source() const { return m_source; }
  [[nodiscard]] const field::BlendedField& field() const { return m_field; }
  [[nodiscard]] const SeparationOptions& options() const { return m_options; }

private:
  /// Distance to the wall f = T, and its gradient.
  struct Wall {
    double distance = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  };
  /// The position relative to the axis at a sheet's node: along tree edges, radii in between are
  /// linear.
  struct Axis {
    double share = 0;                                    ///< distance as a share of the radius
    double radius = 1;                                   ///< at the foot
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< unit, away from the axis
  };
  [[nodiscard]] Wall nearestWall(const Eigen::Vector3d& point, std::uint32_t node) const;
  [[nodiscard]] bool isLeast(const Eigen::Vector3d& point, std::uint32_t node) const;
  [[nodiscard]] Axis nearestAxis(const Eigen::Vector3d& point, std::uint32_t node) const;
  /// `sample` kept off the sheet of node `other`.
  void separate(SeparatedSample& sample, const Eigen::Vector3d& point, std::uint32_t other) const;
  /// The axes of two sheets, for comparison: the one with precedence is nearer within its core.
  [[nodiscard]] std::pair<Axis, Axis> nearestAxes(const Eigen::Vector3d& point, std::uint32_t a,
                                                  std::uint32_t b) const;
  [[nodiscard]] SeparatedSample sampleSheet(const Eigen::Vector3d& point, std::uint32_t node) const;
  /// The nodes besides `node` that a sheet of the point ends at, one for each sheet.
  template <class Visit>
  void eachOtherSheet(const Eigen::Vector3d& point, std::uint32_t node, Visit&& visit) const;

  const formats::Case& m_source;
  const field::BlendedField& m_field;
  SeparationOptions m_options;
  double m_wall;  ///< the level transform on the wall
  formats::Neighbours m_edges;
  std::vector<std::uint32_t> m_touchingOffset, m_touching;  ///< CSR over nodes
};

/// For each node, in CSR form, the nodes whose lumen may touch its own although they are not near
/// along the tree: their centres are closer than `reach` times the sum of both radii plus `margin`
/// mm, and the path along the tree is longer than 1.3 times that distance, and than `leastPath`
/// times the sum of the radii plus `margin`. Symmetric, ascending.
void findTouchingNodes(const formats::CenterlineTree& tree, double reach, double margin,
                       double leastPath, std::vector<std::uint32_t>& offset,
                       std::vector<std::uint32_t>& node);

}  // namespace lumen::convert
