// SPDX-License-Identifier: Apache-2.0
// A surface cut along its groups, for formats that give each group vertices of its own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// The faces of one group, and of one branch if the surface is also cut into branches.
struct MeshPart {
  std::uint32_t branch = 0;           ///< index into the surface's labels; 0 if not cut by branches
  std::uint32_t group = 0;            ///< index into the surface's groups
  bool isFlat = false;                ///< an inlet or an outlet
  std::vector<std::uint32_t> vertex;  ///< vertices of the surface, each once
  std::vector<Float3> normal;  ///< normal of each `vertex`: a flat part's own, else the surface's
  std::vector<Triangle> triangle;  ///< indices into `vertex`
};

/// The non-empty parts, by branch and then by group. A face belongs to the branch of two of its
/// vertices, or to that of its first.
std::vector<MeshPart> splitMesh(const SurfaceMesh& surface, MeshPer per);

/// Whether every edge lies between two faces that run along it in opposite directions.
bool isClosed(const SurfaceMesh& surface);

/// Widens the box `low` .. `high` so that it holds `point`.
void extendBox(const Float3& point, Float3& low, Float3& high);

// Names of groups for formats without quotation marks.

/// One word: white space and control characters become "_".
std::string oneWord(const std::string& name);

/// Name of an OpenFOAM patch: letters, digits, "_", "." and "-" of ASCII, all else "_"; at most 100
/// characters.
std::string openFoamWord(const std::string& name);

/// `rule(name)` of each name; a name that is already taken gets a number.
std::vector<std::string> distinct(const std::vector<std::string>& names,
                                  std::string (*rule)(const std::string&));

/// The names of the systems of a surface's branches; none if none is known.
std::vector<std::string> systemNames(const SurfaceMesh& surface);

/// The names of groups, in their order.
std::vector<std::string> plainGroupNames(const std::vector<FaceGroup>& groups);

}  // namespace lumen::convert
