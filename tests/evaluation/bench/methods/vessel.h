// SPDX-License-Identifier: Apache-2.0
// A case as the benchmarks ask it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/case/case.h"
#include "method.h"

namespace lumen::bench {

struct OwnedVessel {
  formats::Case source;
  std::shared_ptr<blob_model> model;
  Vessel vessel;  ///< without a mesh
};

/// Opens a case's models. Throws std::runtime_error.
OwnedVessel openVessel(formats::Case source, std::string name);

/// The case of a file. Throws std::runtime_error.
formats::Case readCase(const std::string& file);

/// A model that is queried by the scalar reference, of the same bytes. Throws std::runtime_error.
std::shared_ptr<blob_model> scalarModel(const formats::Case& source);

/// The edge of a dense grid's cells around a model, mm: `wanted`, or as fine as `most` values allow.
double gridCell(const blob_model* model, double wanted, double most);

/// A tube around a line of nodes, one the parent of the next: each has a model of seven equal blobs on the
/// line, as wide as puts the wall of the straight tube at `radius`, mm. Lines lie in planes of equal z.
formats::Case tubeAlong(const std::vector<formats::Vec3f>& line, double spacing, double radius);

}  // namespace lumen::bench
