// SPDX-License-Identifier: Apache-2.0
// Shortcuts to the samples of a lattice that are far from all walls.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

// The part of a grid in which a wall may be nearer than its band.

/// Cells of four samples of a lattice or more, marked where they come within the band of the balls of
/// nodes in which all walls lie. Places are in mm, LPS.
class NearCells {
public:
  /// Cells near all nodes, or near those of a region. O(nodes, times the cells of a ball).
  NearCells(const GridSource& source, const Lattice& fine);

  /// False if no wall is within the band of a point of the lattice.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;

private:
  void mark(const Eigen::Vector3d& centre, double reach);
  [[nodiscard]] std::size_t indexOf(const std::array<int, 3>& cell) const;
  [[nodiscard]] std::array<int, 3> cellOf(const Eigen::Vector3d& point) const;

  Eigen::Vector3d m_first;
  double m_edge = 0;
  std::array<int, 3> m_size{};
  std::vector<char> m_isNear;
};

// Distances of points that are far from all walls. Far away, libblob finds the nearest point of the
// wall along many steps, and not always the nearest one; but points near each other have theirs
// near each other.

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

/// A source with a shortcut: with a band, the cells beyond it are not asked; without one, distances
/// far from all walls come from coarse cells.
class GridShortcuts {
public:
  /// Throws Error(Cancelled).
  GridShortcuts(const GridSource& source, const Lattice& lattice, Progress& progress);
  GridShortcuts(const GridShortcuts&) = delete;
  GridShortcuts& operator=(const GridShortcuts&) = delete;

  [[nodiscard]] const GridSource& source() const { return m_source; }

private:
  GridSource m_source;
  std::optional<FarField> m_far;
  std::optional<NearCells> m_near;
};

}  // namespace lumen::convert
