// SPDX-License-Identifier: Apache-2.0
// Closed surfaces of synthetic cases.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "converters/stages/surface/cut_ends.h"
#include "converters/stages/surface/extract.h"
#include "formats/case/case_field.h"

namespace lumen::test {

/// A case with its field, and its closed surface before any end is cut.
struct ClosedCase {
  formats::Case source;
  field::BlendedField blended;
  convert::SheetField field;
  convert::CaseSurface surface;

  explicit ClosedCase(formats::Case value)
      : source(std::move(value)),
        blended(formats::caseField(source)),
        field(source, blended, {.gap = 0.02}) {
    Progress silent;
    convert::ExtractionReport report;
    surface = convert::extractSurface(field, 0.5, report, silent);
  }
  ClosedCase(const ClosedCase&) = delete;
  ClosedCase& operator=(const ClosedCase&) = delete;
};

/// A tube along x with a branch of 8 nodes towards y that hangs on its 10th node.
inline formats::Case forkCase() {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  addVessel(result, "trunk", straightPath({0, 0, 0}, {1, 0, 0}, 20), 1.0, 1.0);
  addVessel(result, "side", straightPath({10, 1.5, 0}, {0, 1, 0}, 8), 0.8, 1.0, 10);
  addModels(result);
  return result;
}

}  // namespace lumen::test
