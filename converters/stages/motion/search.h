// SPDX-License-Identifier: Apache-2.0
// Moves of the stations of a tree that lead to vessels of a volume with little strain
// (docs/method.md, section 12).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/stages/motion/evidence.h"
#include "converters/stages/motion/stations.h"

namespace lumen::convert {

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
