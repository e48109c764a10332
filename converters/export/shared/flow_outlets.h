// SPDX-License-Identifier: Apache-2.0
// Outlets of a network of vessels: the flow that each takes, and why.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/warning.h"

namespace lumen::convert {

struct ExportResult;
struct FlowNetwork;

struct OutletRow {
  std::uint32_t joint = 0;  ///< of the network
  std::string name;         ///< as the files of the folder have it
  double radius = 0;        ///< mm, endCalibre(): by it the outlet takes its share
  double tip = 0;           ///< mm, endRadius()
  double share = 0;         ///< of the flow into its tree
  double flow = 0;          ///< ml/s
  bool takesRest = false;   ///< its pressure is stated, and its flow follows

  /// The reason for the share, for people.
  [[nodiscard]] std::string why() const;
};

/// The outlets of all trees, by blood::murrayShare() of their endCalibre().
std::vector<OutletRow> outletRows(const FlowNetwork& network);

/// Outlets as CSV: name, radius by which it takes its share, radius of its tip, share, flow, reason.
std::string outletTable(const std::vector<OutletRow>& outlets);

/// A warning for each outlet of a short vessel that takes much of its tree's flow, with its place.
std::vector<Warning> outletWarnings(const FlowNetwork& network,
                                    const std::vector<OutletRow>& outlets);

/// Adds the outlets, their table as a file, and the warnings of pressures and outlets.
void addOutlets(const FlowNetwork& network, ExportResult& result);

}  // namespace lumen::convert
