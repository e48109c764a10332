// SPDX-License-Identifier: Apache-2.0
// Closed surfaces of synthetic cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/extract.h"
#include "formats/case/case_field.h"

namespace lumen::test {

/// A case with its field, and its closed surface before any end is cut.
struct ClosedCase {
  formats::Case source;
  field::BlendedField blended;
  convert::SeparatedField field;
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

/// Area of the triangles of a group, mm^2.
inline double areaOf(const convert::CaseSurface& surface, std::uint32_t group) {
  convert::TriangleMesh part{surface.mesh.position, {}};
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (surface.group[t] == group) part.triangle.push_back(surface.mesh.triangle[t]);
  return measureFacts(part).area;
}

/// Expects a manifold surface without crossings, of this Euler characteristic.
inline void expectClosed(const convert::CaseSurface& surface, std::ptrdiff_t euler) {
  const MeshFacts facts = measureFacts(surface.mesh);
  EXPECT_EQ(facts.euler, euler);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(convert::selfIntersections(surface.mesh).pairs.size(), 0U);
}

}  // namespace lumen::test
