// SPDX-License-Identifier: Apache-2.0
// Conventions: Godot 3 and 4, "Node type customization using name suffixes"; Unity, "Importing LOD
// meshes"; glTF's extension MSFT_lod; Unreal, "Simple versus complex collision".
// Declared in targets.h.
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/write_gltf.h"

namespace lumen::convert {

namespace {

// twice an artery's wall: the thinner a wall, the finer its triangles must be
constexpr Length kRenderedWall = {0, 0.4};  // radii
constexpr int kLevels = 3;  // levels of detail, each with a quarter of the triangles

struct Convention {
  std::vector<std::string> nodes;  ///< nodes of the levels of detail
  bool lod = false;                ///< by MSFT_lod
  std::string start;               ///< README.md: how to load it
};

std::array<double, 3> tripleOf(const Eigen::Vector3d& v) {
  return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
}

ExportResult exportScene(const ExportInput& input, const Convention& convention) {
  CommonOptions options = input.options;
  options.surface.levels = static_cast<int>(convention.nodes.size());
  const ExportInput leveled{input.source, options, input.frame, input.progress};
  ExportedSurface surface = wallSurface(leveled, kRenderedWall);
  std::vector<SurfaceMesh> levels = {std::move(surface.mesh)};
  std::move(surface.coarser.begin(), surface.coarser.end(), std::back_inserter(levels));
  GltfScene scene{convention.nodes, convention.lod, {}};
  for (const NamedEnd& end : surface.ends)
    scene.places.push_back({end.name, tripleOf(input.frame.position(end.position)),
                            tripleOf(input.frame.direction(end.direction))});
  ExportResult result;
  result.files.push_back(
      {"vessels.glb", encodeGlbScene(levels, scene),
       "the wall of the vessels as a solid; a node at each end, its z axis out of it", ""});
  result.start = convention.start;
  result.ends = std::move(surface.ends);
  result.surface = std::move(surface.report);
  return result;
}

std::vector<std::string> levelNames() {
  std::vector<std::string> names;
  for (int level = 0; level < kLevels; ++level)
    names.push_back("vessel_LOD" + std::to_string(level));
  return names;
}

}  // namespace

ExportResult exportGodot(const ExportInput& input) {
  return exportScene(input, {{"vessel-col"}, false, exportText("engines/godot.md")});
}

ExportResult exportUnity(const ExportInput& input) {
  return exportScene(input, {levelNames(), true, exportText("engines/unity.md")});
}

ExportResult exportUnreal(const ExportInput& input) {
  return exportScene(input, {levelNames(), true,
                             exportText("engines/unreal.md", {{"unit", input.field("unit")}})});
}

ExportResult exportBlender(const ExportInput& input) {
  return exportScene(input, {{"vessel"}, false, exportText("engines/blender.md")});
}

TargetRow godotRow() {
  return {.name = "godot",
          .title = "Godot 3 and 4",
          .files = {"vessels.glb"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lsa},
          .holds = "the wall as a solid with a collider of its triangles; the ends as nodes",
          .lacks = "the tree, its radii and its models",
          .options = {"edge", "max-error", "triangles", "thickness"},
          .needsVessel = false};
}

TargetRow unityRow() {
  return {.name = "unity",
          .title = "Unity, by a package for glTF",
          .files = {"vessels.glb"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lsa},
          .holds = "the wall as a solid in three levels of detail; the ends as nodes",
          .lacks = "the tree, its radii and its models; a collider, which Unity makes",
          .options = {"edge", "max-error", "triangles", "thickness"},
          .needsVessel = false};
}

TargetRow unrealRow() {
  return {.name = "unreal",
          .title = "Unreal Engine 5",
          .files = {"vessels.glb"},
          .units = {LengthUnit::Metre, LengthUnit::Centimetre},
          .axes = {Axes::Lsa},
          .holds = "the wall as a solid in three levels of detail; the ends as nodes",
          .lacks = "the tree, its radii and its models; a collider, which Unreal makes",
          .options = {"edge", "max-error", "triangles", "thickness"},
          .needsVessel = false};
}

TargetRow blenderRow() {
  return {.name = "blender",
          .title = "Blender",
          .files = {"vessels.glb"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lsa},
          .holds = "the wall as a solid; the ends as empties",
          .lacks = "the tree, its radii and its models",
          .options = {"edge", "max-error", "triangles", "thickness"},
          .needsVessel = false};
}

}  // namespace lumen::convert
