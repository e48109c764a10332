// SPDX-License-Identifier: Apache-2.0
// Points spread evenly over the wall of a case.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

struct WallSample {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS, on f = T
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();   ///< unit normal
  std::uint32_t node = 0;                              ///< node of the cell in which it lies
  double radius = 0;  ///< mm from the axis, for an aneurysm from its node
};

/// Samples of the wall, node by node. Vessels: rings of rays, about `spacing` mm apart, around the
/// axis between a node and the one before it in its branch (around the node, if it is the only
/// one). Aneurysms: rays from each node in all directions. Every ray's end is projected on the
/// surface; it is a sample if it stays within three radii and ends in a cell of its own branch
/// (aneurysms: of its own node), so that no place is sampled twice.
class WallSampler {
public:
  /// All arguments must outlive this object.
  WallSampler(const formats::CenterlineTree& tree, const field::BlendedField& surface,
              double spacing)
      : m_tree(tree), m_surface(surface), m_spacing(spacing) {}

  /// Adds the samples that belong to `node`.
  void sample(std::uint32_t node, std::vector<WallSample>& out) const;

private:
  void ring(std::uint32_t near, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
            double radius, double turn, std::vector<WallSample>& out) const;
  void sphere(std::uint32_t node, std::vector<WallSample>& out) const;
  void project(const Eigen::Vector3d& centre, const Eigen::Vector3d& ray, double radius,
               std::uint32_t near, const Eigen::Vector3d* plane,
               std::vector<WallSample>& out) const;

  const formats::CenterlineTree& m_tree;
  const field::BlendedField& m_surface;
  double m_spacing;
};

// Apparent edge of a round vessel under the blur of a scanner (docs/method.md, section 7.1).

/// Displacement of the edge that findEdge() detects at the wall of a cylinder or a ball blurred by
/// a Gaussian: measured on exact profiles, so it holds for findEdge()'s definition of an edge.
class IdealEdge {
public:
  /// `pointSpread`: standard deviation of the Gaussian, mm; 0: no displacement.
  IdealEdge(double pointSpread, double voxel);

  /// mm outward of the wall, so less than 0 where vessels appear too narrow.
  [[nodiscard]] double ofCylinder(double radius) const { return at(m_cylinder, radius, 0.5); }
  [[nodiscard]] double ofBall(double radius) const { return at(m_ball, radius, 1.0); }

private:
  [[nodiscard]] double at(const std::vector<double>& table, double radius, double bends) const;

  double m_sigma, m_voxel;
  std::vector<double> m_cylinder, m_ball;  ///< by radius, in steps of kRadiusStep voxels
};

}  // namespace lumen::convert
