// SPDX-License-Identifier: Apache-2.0
// Distances of points that are far from all walls. Far away, libblob finds the nearest point of the
// wall along many steps, and not always the nearest one; but points near each other have theirs
// near each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

/// The nearest points of the wall from the corners of coarse cells, from which those of the points
/// within the cells are found by Newton's method with the corner's curvatures. Places are in mm,
/// LPS. Any number of threads may ask.
class FarField {
public:
  /// Over a lattice whose cells are four of `fine`, in parallel; the same numbers on any number of
  /// threads. Throws Error(Cancelled).
  FarField(const GridSource& source, const Lattice& fine, Progress& progress);

  /// Answers the points that are far from all walls: a fifth of the diagonal of a cell at least. Others, and
  /// few for which Newton's method does not find its end, are not answered, but get a bound of their
  /// distance; `isAnswered` has one entry for each point. The error of a distance is
  /// mostly below a hundredth of the radius at its wall, and may be a third behind a fork or a bulge
  /// that is smaller than a cell.
  void answer(std::span<const Eigen::Vector3d> points, std::span<WallDistance> answers,
              std::span<char> isAnswered) const;

private:
  /// A corner with its nearest point of the wall.
  struct Foot {
    Eigen::Vector3d at = Eigen::Vector3d::Zero(), normal = at;
    Eigen::Vector3d across = at;   ///< a tangent; the other is normal x across
    std::array<double, 3> bend{};  ///< the shape operator along both tangents, 1/mm
    double distance = 0;           ///< mm, from the corner; below 0 in the lumen
    std::uint32_t node = 0;
    bool isUsable = false, isInPlace = false;  ///< on the wall; and nearest to the corner
  };
  struct Search;  ///< of the foot of a point

  void sampleCorners(const GridSource& source, Progress& progress);
  void takeFeetOfNeighbours(const Progress& progress);
  void sweep(bool isBackward);
  /// Moves a foot straight to the wall; false if that fails.
  bool settle(Foot& foot) const;
  void measureBend(Foot& foot) const;
  void moveToItsPlace(const Eigen::Vector3d& corner, Foot& foot) const;
  struct Step {
    Eigen::Vector3d along;
    bool isSound;  ///< the foot is nearest in all directions, not farthest in one
  };
  /// The step along the wall to the foot of a point that is `distance` above it, mm.
  static Step stepAlong(const Foot& foot, double distance, const Eigen::Vector3d& along);
  /// Moves the feet of all searches to the wall, and along it, until each is found, or by this number
  /// of evaluations.
  void search(std::span<Search> searches, int evaluations) const;
  void improve(Search& search, const Eigen::Vector3d& at, double above,
               const Eigen::Vector3d& normal, std::uint32_t node) const;
  /// The nearest of the feet of a far cell's corners; null in other cells and outside.
  [[nodiscard]] const Foot* startOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] std::size_t indexOf(int i, int j, int k) const;

  const VesselDistance& m_vessels;
  Lattice m_lattice;
  std::vector<Foot> m_feet;   ///< of the corners, x fastest
  std::vector<char> m_isFar;  ///< of the cells, by their first corner
};

}  // namespace lumen::convert
