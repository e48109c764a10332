// SPDX-License-Identifier: Apache-2.0
// The cross-sections of a case in a volume (docs/method.md, section 2.11).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box_tree.h"
#include "converters/stages/fitting/image/section_fit.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert::fitting {

/// The section of one node. Its plane is normal to the node's direction, with the origin at its
/// centre; heights run along the direction.
struct NodeSection {
  Eigen::Vector3d origin, u, v, axis;
  Outline outline;
  double low = 0, high = 0;  ///< heights of the voxels that count, mm
  Eigen::Vector2d bend;      ///< the curvature of the axis by the nodes around, 1/mm
  bool isSac = false;        ///< of an aneurysm: no section
  double contrast = 0;       ///< 0: unknown

  [[nodiscard]] Eigen::Vector2d inPlane(const Eigen::Vector3d& offset) const {
    return {offset.dot(u), offset.dot(v)};
  }
  /// The point of the wall at the angle `a` and the height `h`, mm, LPS.
  [[nodiscard]] Eigen::Vector3d wall(double a, double h) const;
};

/// All sections, with the voxels around them. Immutable while nodes are fitted, so that their order
/// does not matter.
class Sections {
public:
  /// Circles of the nodes' radii. `blur`: standard deviation of the point-spread function along the
  /// finest axis of the volume, mm. The arguments must outlive the object.
  Sections(const formats::Case& value, const Volume& volume, bool dark, double blur);

  [[nodiscard]] const NodeSection& operator[](std::uint32_t node) const { return m_sections[node]; }
  [[nodiscard]] NodeSection& operator[](std::uint32_t node) { return m_sections[node]; }
  [[nodiscard]] double voxel() const { return m_voxel; }
  [[nodiscard]] double blur() const { return m_blur; }
  void setBlur(double blur) { m_blur = blur; }
  /// Lengthens the stretches whose voxels count by a factor, and sets all outlines back to circles.
  void setStretch(double factor);

  /// The point-spread function in a node's plane, mm^2.
  [[nodiscard]] Eigen::Matrix2d covariance(std::uint32_t node) const;

  /// Another node whose lumen may show in the voxels of a node's section.
  struct Other {
    std::uint32_t node;
    bool isJoined;                        ///< by the tree near by: no wall lies between the two
    std::optional<BlurredSection> image;  ///< made when it is first needed
  };
  /// The nodes that may show, but for those next to the node along its own vessel.
  [[nodiscard]] std::vector<Other> others(std::uint32_t node) const;

  /// The lumen of other nodes at a place.
  struct Beside {
    double share = 0;      ///< of the point-spread function
    double intensity = 0;  ///< that it adds
    bool isJoined = false;
  };
  [[nodiscard]] Beside beside(std::vector<Other>& others, const Eigen::Vector3d& place) const;

  /// The voxels of a node's section.
  [[nodiscard]] std::vector<SectionVoxel> voxels(std::uint32_t node) const;
  /// Whether a joined vessel opens the wall at a place.
  [[nodiscard]] bool isOpen(std::vector<Other>& others, const Eigen::Vector3d& place) const;

private:
  void place(std::uint32_t node);

  const formats::Case& m_case;
  const Volume& m_volume;
  formats::Neighbours m_neighbours;
  double m_sign, m_voxel, m_blur, m_stretch = 1;
  std::vector<NodeSection> m_sections;
  std::vector<double> m_arc;  ///< mm along a branch
  BoxTree<double> m_balls;
};

// Differences between the shapes of sections within a case (docs/method.md, section 2.11).

/// The spread of shapes among the fitted sections of `nodes`: for each kind of parameter the root of
/// the mean of the squares that the noise does not explain (empirical Bayes: H. Robbins, An empirical
/// Bayes approach to statistics, 1956), at most the usual spread. The usual one where fewer than
/// eight values are determined by voxels rather than by the prior. `fits`: one for each node of the
/// case.
ShapeSpread measureSpread(const Sections& sections, std::span<const SectionFit> fits,
                          std::span<const std::uint32_t> nodes);

}  // namespace lumen::convert::fitting
