// SPDX-License-Identifier: Apache-2.0
// A tree of vessels as solvers in one dimension take it: conical vessels between numbered nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/export/shared/network.h"

namespace lumen::convert {

/// A cone of round sections. SI units.
struct OneDVessel {
  std::string name;                    ///< letters, digits, "_", "." and "-", unique
  std::uint32_t from = 0, to = 0;      ///< nodes
  double length = 0;                   ///< m
  double inRadius = 0, outRadius = 0;  ///< m
  double resistance = 0;               ///< its outlet's, Pa s/m^3; 0: it ends at a junction

  [[nodiscard]] double meanRadius() const { return 0.5 * (inRadius + outRadius); }
  /// Cells or elements: of a millimetre, and five at least.
  [[nodiscard]] int cells() const;
};

/// Nodes are 0, 1, ...; the inlet is node 0.
struct OneDNetwork {
  std::vector<Eigen::Vector3d> nodes;  ///< mm, LPS
  std::vector<OneDVessel>
      vessels;            ///< the inlet's first; no two between the same nodes in one direction
  double flow = 0;        ///< flow at the inlet, m^3/s
  std::size_t stubs = 0;  ///< vessels that were put between others, of one radius
  /// Vessels that were shorter than their radius, and are as long here.
  std::size_t lengthened = 0;
};

/// Tree number `tree` of a network. A vessel is the cone with its ends' ratio of radii and its
/// resistance by Poiseuille. At a node are three vessels at most: where more meet, stubs of one
/// radius lie between them. Throws Error(InvalidInput) where several inlets lead into one tree, and
/// where a loop leaves a junction nothing to flow in or out.
OneDNetwork oneDNetwork(const FlowNetwork& network, std::uint32_t tree);

}  // namespace lumen::convert
