// SPDX-License-Identifier: Apache-2.0
// Moves of the stations of a tree that lead to vessels of a volume with little strain
// (docs/method.md, section 12).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/bspline.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Some nodes of a tree, about a radius apart, at which its motion is sought (docs/method.md, section 12).

/// Stations are nodes: the roots, the ends of branches, the nodes that branches hang on, and nodes
/// between, at least a radius apart and as far from the end of their branch. They ascend, so a parent comes before its children.
struct Stations {
  std::vector<std::uint32_t> node;
  std::vector<std::int32_t> parent;  ///< the station above, or -1
  std::vector<double> gap;           ///< mm along the tree from the parent; 0 without one
  std::vector<double> length;        ///< mm of vessel that a station stands for
  /// 1 for a tip, -1 for a root with one edge, by the direction that leads out; else 0
  std::vector<int> end;

  /// A node's stations above and below it, itself twice if it is one, and its share of the path.
  struct Between {
    std::uint32_t above, below;
    double share;
  };
  std::vector<Between> between;  ///< one for each node of the tree

  [[nodiscard]] std::size_t size() const { return node.size(); }
  /// Moves of all nodes from those of the stations, linear in the length along the tree.
  [[nodiscard]] std::vector<Eigen::Vector3d> spread(
      const std::vector<Eigen::Vector3d>& moves) const;
};

Stations placeStations(const formats::CenterlineTree& tree);

// The contrast of a disc across a vessel against the ring around it.

/// Evidence of vessels in one volume. Thread-safe; the volume must outlive it.
class Evidence {
public:
  /// `smoothing`: standard deviation of a Gaussian that the voxels are smoothed with, mm.
  Evidence(const Volume& volume, bool dark, double smoothing);

  /// The mean of the disc of `radius` mm across `direction` (unit) at `centre` (mm, LPS), less that of
  /// the ring at 1.7 radii, in the voxels' units; positive for a vessel. Zero where a part of either
  /// lies outside of the volume.
  [[nodiscard]] double contrastAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction,
                                  double radius) const;

  /// The contrast of the last disc of a vessel that ends a radius farther on: the mean of the disc less the
  /// greater of two means, of the ring around it and of the disc two radii on in the direction `outward`.
  [[nodiscard]] double contrastOfEnd(const Eigen::Vector3d& centre,
                                     const Eigen::Vector3d& direction,
                                     const Eigen::Vector3d& outward, double radius) const;

private:
  struct Disc {
    double inside, around;
  };
  [[nodiscard]] Disc discAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction,
                            double radius) const;

  BsplineVolume m_voxels;
  double m_sign;
};

/// Moves that are considered: those of `around` plus h (i, j, k), with i, j, k from -steps to steps.
struct MoveGrid {
  double step = 0;  ///< h, mm
  int steps = 0;
  [[nodiscard]] int width() const { return 2 * steps + 1; }
  [[nodiscard]] std::size_t count() const {
    const auto w = static_cast<std::size_t>(width());
    return w * w * w;
  }
  [[nodiscard]] Eigen::Vector3d move(std::size_t label) const;
};

/// A station as it is looked for.
struct StationShape {
  Eigen::Vector3d centre, direction;  ///< at rest, and as it is turned by now
  double radius;                      ///< mm
  /// Difference of its move and that of its parent that a turn of the vessel explains, mm: no strain.
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward =
      Eigen::Vector3d::Zero();  ///< unit, out of the vessel at an end, or zero
};

struct SearchResult {
  std::vector<Eigen::Vector3d> moves;  ///< one for each station, mm
  std::vector<double>
      evidence;  ///< contrast at the place found, as a share of the usual one, 0 to 1
};

/// The moves of least energy: the length of the vessel without evidence, plus kStrainCost times the
/// square of the strain along it, in mm. Exact, by messages from the tips to the roots. `around`: one move
/// for each station. `usual`: the contrast that each station has where it is right, as in another
/// volume; empty: the median of the best that the stations have. Throws Error(InvalidInput) where no
/// station has any contrast, and Error(Cancelled). Advances `progress` by one for each station.
SearchResult searchMoves(const Stations& stations, const std::vector<StationShape>& shapes,
                         const std::vector<Eigen::Vector3d>& around,
                         const std::vector<double>& usual, const MoveGrid& grid,
                         const Evidence& evidence, Progress& progress);

/// Contrasts of stations at `around`, one move for each, as searchMoves() sees them on a grid of this step.
std::vector<double> contrastsAt(const std::vector<StationShape>& shapes,
                                const std::vector<Eigen::Vector3d>& around, double step,
                                const Evidence& evidence);

}  // namespace lumen::convert
