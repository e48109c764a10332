// SPDX-License-Identifier: Apache-2.0
// The unit of a mesh whose file states none, by the size of known vessels.
#pragma once

#include <string>

#include "converters/base/field_word.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/repair/mesh_report.h"

namespace lumen::convert {

/// Measures by which vessels are known, in the unit of the mesh.
struct VesselSize {
  double radius = 0;    ///< twice the volume over the area, which is the radius of a tube
  double diagonal = 0;  ///< of the bounding box
};

/// The size of a mesh with a triangle, whose triangles are oriented; openings count as closed by
/// fans.
VesselSize vesselSize(const TriangleMesh& mesh);
VesselSize vesselSize(const MeshReport& report);

/// A unit that makes vessels of a mesh of this size plausible.
struct UnitGuess {
  double millimetres = 1;   ///< in one unit of the mesh: 1, 10 or 1000
  std::string unit = "mm";  ///< "mm", "cm" or "m"
  bool plausible = true;    ///< false: none of them is
  std::string other;        ///< another unit in which it has the size of known vessels; or empty
};

/// The first of mm, m and cm in which the mesh has the size of known vessels: of radius and box of
/// the arteries of the brain, of the neck and limbs, or of the aorta. Models of SimVascular are in
/// cm if that is one of them. A mesh that has the size of none is in the first of these units in
/// which its radius is from 0.2 to 30 mm in a box of 3 mm to 2 m, or else in mm.
UnitGuess guessUnit(const VesselSize& size, bool isSimVascular = false);

/// A sentence for people on a guess that may be wrong: not mm, not plausible, or one of two; empty
/// for mm alone.
std::string unitWarning(const UnitGuess& guess, const VesselSize& size, bool isSimVascular,
                        const FieldWord& word = {});

}  // namespace lumen::convert
