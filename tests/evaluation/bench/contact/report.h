// SPDX-License-Identifier: Apache-2.0
// Measurements of contact_bench.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/case/case.h"
#include "method.h"
#include "tally.h"

namespace lumen::bench {

struct Rate {
  std::size_t environments;
  int threads;
  double queriesPerSecond;
};

struct MethodResult {
  std::string name;
  double megabytes = 0;
  Tally tally;
  std::vector<Rate> rates;
};

struct CaseResult {
  std::string name;
  std::size_t nodes = 0, triangles = 0;
  double lengthMm = 0, voxelMm = 0;
  std::size_t points = 0, touching = 0,
              past = 0;  ///< of wires; touching the wall; with the axis past it
  std::vector<MethodResult> methods;
};

/// The case and its load; no methods yet.
CaseResult describeCase(const Vessel& vessel, const std::vector<Truth>& truth,
                        const formats::CenterlineTree& tree);

/// For report.py.
std::string json(const std::vector<CaseResult>& results);

struct ContactOptions {
  std::string json;
  std::size_t environments = 4096;
  int turns = 7;
  std::vector<std::string> cases;
};

/// `--json FILE [--environments N] [--turns N] CASE...`, what is not given as in `options`. Throws
/// std::runtime_error with the usage where the file or a case is missing.
ContactOptions contactOptions(int argc, char** argv, ContactOptions options);

/// The closed surface of a case as `lumen convert CASE MESH --edge 0.5r` makes it: what a simulator would
/// load, with a quarter of the default's triangles, which makes every search among them faster. Throws as
/// convert::closedSurface().
Triangles closedMesh(const formats::Case& source);

}  // namespace lumen::bench
