// SPDX-License-Identifier: Apache-2.0
// Surface of a case for writers of meshes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/geometry/mesh_measures.h"
#include "formats/case/vessel_system.h"
#include "formats/view/float3.h"

namespace lumen::convert {

using formats::Float3;

enum class FaceKind : std::uint8_t {
  Wall,    ///< the vessels' wall, and the sides of flow extensions
  Inlet,   ///< a flat end before the first node of a root
  Outlet,  ///< a flat end behind the last node of a branch
  Cap      ///< an end that no plane could cut, closed by the field itself
};

/// A set of faces with a name: "wall", "outer-wall", "inlet", "inlet-LABEL", "outlet-LABEL",
/// "cap-LABEL". Its number in a file (VTP ModelFaceID, STL solid, ...) is its index plus one.
struct FaceGroup {
  std::string name;  ///< unique in its surface
  FaceKind kind = FaceKind::Wall;
  friend bool operator==(const FaceGroup&, const FaceGroup&) = default;
};

/// Triangles with data of the case. Arrays of vertices all have the size of `position`.
struct SurfaceMesh {
  std::vector<Float3> position;       ///< mm, LPS
  std::vector<Float3> normal;         ///< unit, out of the lumen
  std::vector<float> radius;          ///< radius of the vessel there, mm
  std::vector<float> confidence;      ///< the inlier rate there, in [0, 1]; empty if unknown
  std::vector<std::uint32_t> branch;  ///< index into `labels`
  /// node at which a cursor on the surface is there (libblob); empty if unknown
  std::vector<std::uint32_t> node;

  std::vector<Triangle> triangle;    ///< indices of vertices, counter-clockwise seen from outside
  std::vector<std::uint32_t> group;  ///< group of each triangle: index into `groups`
  std::vector<FaceGroup> groups;
  std::vector<std::string> labels;  ///< labels of the case's branches
  /// Systems of vessels of these; empty if none is known.
  std::vector<formats::VesselSystem> systems;
};

}  // namespace lumen::convert
