// SPDX-License-Identifier: Apache-2.0
// A case as queries need it: its model, and the branch in which new points are looked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blob.h"

namespace lumensofa {

struct CloseModel {
  void operator()(blob_model* model) const { blob_model_close(model); }
};

/// Nodes of a branch lie one after another.
struct NodeRange {
  std::uint32_t first = 0, count = 0;
};

struct VesselCase {
  std::unique_ptr<blob_model, CloseModel> model;  ///< null if it could not be opened
  double isoLevel = 0;                            ///< mm
  std::size_t nodeCount = 0;
  NodeRange branch;     ///< all nodes if no branch was asked for
  std::string problem;  ///< one sentence without a full stop, if `model` is null
};

/// Reads a case. `branch` is a label, or empty for the whole tree. Memory is bounded by the size of
/// the file.
VesselCase openVesselCase(const std::string& path, const std::string& branch);

/// The node of least power among those of the branch, the lowest index among equals; of the whole
/// tree by libblob's own search. `model`: the vessel's, or that of a pose of it.
std::uint32_t locate(const VesselCase& vessel, const blob_model* model, const double point[3]);

}  // namespace lumensofa
