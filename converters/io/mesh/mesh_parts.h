// SPDX-License-Identifier: Apache-2.0
// A surface cut along its groups, for formats that give each group vertices of its own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// The faces of one group, and of one branch if the surface is also cut into branches.
struct MeshPart {
  std::uint32_t branch = 0;  ///< index into the surface's labels; 0 if not cut by branches
  std::uint32_t group = 0;   ///< index into the surface's groups
  formats::VesselSystem system = formats::VesselSystem::Unknown;  ///< where cut by systems
  bool isFlat = false;                                            ///< an inlet or an outlet
  std::vector<std::uint32_t> vertex;  ///< vertices of the surface, each once
  std::vector<Float3> normal;  ///< normal of each `vertex`: a flat part's own, else the surface's
  std::vector<Triangle> triangle;  ///< indices into `vertex`
};

/// The non-empty parts, by branch, then by group, and then by system of vessels if they are cut by
/// systems, which the surface states. A face belongs to the branch of two of its vertices, or to that
/// of its first.
std::vector<MeshPart> splitMesh(const SurfaceMesh& surface, MeshPer per, bool bySystem = false);

// Systems of vessels on a surface.

/// "artery", as files name it.
std::string systemName(formats::VesselSystem system);

/// The system of each triangle; none if the surface states no systems.
std::vector<formats::VesselSystem> triangleSystems(const SurfaceMesh& surface);

/// The system of most triangles, the least value of several; none as above.
std::optional<formats::VesselSystem> mainSystem(const SurfaceMesh& surface);

/// A system, and the surface with the triangles of it alone; its vertices are all there.
struct SystemPart {
  formats::VesselSystem system = formats::VesselSystem::Unknown;
  SurfaceMesh surface;
  [[nodiscard]] std::string name() const { return systemName(system); }
};

/// One part for each system that a triangle has, in the order of their values; none if the surface
/// states no systems.
std::vector<SystemPart> splitBySystem(const SurfaceMesh& surface);

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
