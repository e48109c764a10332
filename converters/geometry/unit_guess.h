// SPDX-License-Identifier: Apache-2.0
// The unit of a mesh or centerline whose file states none, by the size of known vessels; and sizes that
// a stated unit makes impossible.
#pragma once

#include <string>

#include "converters/base/field_word.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// Measures by which vessels are known, in the unit of their file.
struct VesselSize {
  double radius =
      0;  ///< twice the volume over the area, which is the radius of a tube; NaN: unknown
  double diagonal = 0;  ///< of the bounding box
};

/// The size of a mesh with a triangle, whose triangles are oriented; openings count as closed by
/// fans.
VesselSize vesselSize(const TriangleMesh& mesh);

/// A unit that makes vessels of this size plausible.
struct UnitGuess {
  double millimetres = 1;   ///< in one unit of the file: 1, 10, 1000, 1e-3 or 1e-6
  std::string unit = "mm";  ///< "mm", "cm", "m", "um" or "nm"
  bool plausible = true;    ///< false: none of them is
  std::string other;        ///< another unit in which it has the size of known vessels; or empty
};

/// The first of mm, m and cm in which this is the size of known vessels: of radius and box of
/// the arteries of the brain, of the neck and limbs, or of the aorta. Models of SimVascular are in
/// cm if that is one of them. A size of none is in the first of these units in
/// which its radius is from 0.2 to 30 mm in a box of 3 mm to 2 m, or else in the first of um and nm in
/// which it is from a micrometre on in a box of 10 um or more, or else in mm.
UnitGuess guessUnit(const VesselSize& size, bool isSimVascular = false);

/// A sentence for people on a guess that may be wrong: not mm, not plausible, or one of two; empty
/// for mm alone.
std::string unitWarning(const UnitGuess& guess, const VesselSize& size, bool isSimVascular,
                        const FieldWord& word = {});

enum class UnitBy { StandardOfGltf, File };

/// A sentence for people on vessels whose size, of `millimetres` mm in one unit of `numbers`, is not
/// possible; empty for others. A file that states its unit may be one of a microscope, a format whose
/// standard states it is not.
std::string statedWarning(const VesselSize& numbers, double millimetres, UnitBy by,
                          const FieldWord& word);

/// Unit and axes that were taken for a file.
struct ReadFrame {
  double unit = 1;           ///< mm in one unit of the file
  std::string unitFrom;      ///< "option", "file", "standard" or "guess"
  bool frameStated = false;  ///< the file, or the user, names its axes
};

}  // namespace lumen::convert
