// SPDX-License-Identifier: Apache-2.0
// Triangle mesh as stored in a file of another program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// A mesh as stored in its file: nothing is repaired, and triangles may have any orientation.
struct MeshFile {
  /// The mesh has the file's unit, and the axes that the file names are turned to LPS. glTF, in
  /// metres with +Y up by its standard, becomes mm and LPS. There is at least one triangle,
  /// coordinates are finite and below 1e12, indices are in range. Equal points of STL are merged.
  TriangleMesh mesh;
  std::vector<std::string> groups;   ///< names of sets of triangles in the file
  std::vector<std::uint32_t> group;  ///< index into `groups` of each triangle; empty: no groups
  double unitMm = 0;                 ///< mm in one unit of `mesh`; 0: the file states none
  bool frameStated = false;          ///< the file names its axes
  /// Assumptions and omissions of the reader, one printable sentence each.
  std::vector<std::string> notes;
};

}  // namespace lumen::convert
