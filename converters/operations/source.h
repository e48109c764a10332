// SPDX-License-Identifier: Apache-2.0
// Everything that a case is made of, as values: what a reader of a file, a scanner or an array of a
// notebook hands over.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/geometry/unit_guess.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/io/labels/label_meaning.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// A volume of labels: whole numbers, 0 around what they mark.
struct LabelPart {
  convert::Volume voxels;
  std::string name;  ///< for messages
  /// Meanings of its labels, as far as they are known, by ascending values.
  std::vector<convert::LabelMeaning> meanings;
};

/// Computed tomography without contrast.
struct NativePart {
  convert::Volume voxels;
  std::string name;  ///< for messages
};

/// The surface of vessels as triangles, in the unit of its file; axes are LPS.
struct MeshPart {
  convert::MeshFile file;
  bool isOfSimVascular = false;  ///< a model of SimVascular, which is often in cm
};

/// A centerline: points with radii and parents, in its own unit and axes.
struct CenterlinePart {
  convert::CenterlineFile file;
  std::string name;            ///< for messages
  convert::ReadFrame frame{};  ///< unit and axes that were taken, where `file` is in mm and LPS
};

/// One input, as aligned parts in one patient space. These sets of parts make a case:
///
/// | parts | the case |
/// |---|---|
/// | `grey` | the vessels that are found or seeded in the voxels |
/// | `labels` | the vessels that the labels mark |
/// | `grey` or `labels`, and `maps` | the same, whose branches have the names of the maps' labels |
/// | `grey` and `native`, and `maps` | the same, in the voxels less the bone of the other scan |
/// | `mesh` | the vessels whose wall it is |
/// | `mesh`, `centerline` | the same, along this centerline; a unit of 0 is that of the mesh |
/// | `centerline` | its vessels; points are in mm and LPS |
/// | `value` | itself |
struct Source {
  std::string name;                     ///< for messages, as a person knows it: "head.nrrd"
  std::optional<convert::Volume> grey;  ///< intensities of an angiogram
  std::optional<NativePart> native;     ///< the same body without contrast, on a grid of its own
  std::optional<LabelPart> labels;      ///< labels that are vessels
  /// Maps that state what lies where, each on a grid of its own; where two speak, the first counts.
  std::vector<LabelPart> maps;
  std::optional<MeshPart> mesh;
  std::optional<CenterlinePart> centerline;
  std::optional<formats::Case> value;
};

}  // namespace lumen::operations
