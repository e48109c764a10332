// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/mesh_options.h"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "converters/cli/option_group.h"

namespace lumen::app {

namespace {

/// What --mesh-per and --color take; without the option it is the first value of its type.
const std::map<std::string, convert::MeshPer> kMeshPer = {{"whole", convert::MeshPer::Whole},
                                                          {"branch", convert::MeshPer::Branch}};
const std::map<std::string, convert::ColorBy> kColorBy = {
    {"none", convert::ColorBy::None},
    {"branch", convert::ColorBy::Branch},
    {"radius", convert::ColorBy::Radius},
    {"confidence", convert::ColorBy::Confidence}};

void setEdge(convert::EdgeLength& edge, const std::string& text) {
  const convert::Length length = convert::parseLength(text, "--edge");
  edge.share = length.radii;
  if (length.mm > 0) edge.minimum = edge.maximum = length.mm;
}

/// The closed surface.
void addSurfaceOptions(CLI::App& app, convert::ClosedSurfaceOptions& surface) {
  OptionGroup group(app, "Mesh");
  const auto addLength = [&](const std::string& name, std::function<void(const std::string&)> set,
                             const std::string& help) {
    return app.add_option_function<std::string>(name, std::move(set), help)
        ->type_name("LENGTH")
        ->group("Mesh");
  };
  addLength(
      "--edge", [&](const std::string& text) { setEdge(surface.edge, text); },
      "Length of edges, as a share of the vessel's radius such as 0.25r, or in mm")
      ->default_str("0.25r");
  group.add("--edge-min", surface.edge.minimum, "MM", "Least length of edges")->check(kNotNegative);
  app.add_option("--edge-max", surface.edge.maximum, "Greatest length of edges")
      ->type_name("MM")
      ->group("Mesh")
      ->check(kPositive);
  group.addScaled("--gap", surface.gap, "What touching vessels keep between them",
                  "0.1 voxels, or 0.05 of the least radius");
  group.addFlag("--open", surface.open, "Leave the flat ends of vessels open");
  app.add_option_function<std::vector<std::string>>(
         "--extend",
         [&](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             surface.extend.push_back(convert::parseEndLength(text, "--extend"));
         },
         "Flow extensions at all ends, such as 5r or 20mm, or at those of a branch: LABEL=5r")
      ->option_text("[LABEL=]LENGTH")
      ->group("Mesh");
  addLength(
      "--thickness",
      [&](const std::string& text) {
        surface.thickness = convert::parseLength(text, "--thickness");
      },
      "A solid wall of this thickness around the lumen, such as 0.5 (mm) or 0.2r; thinner where "
      "vessels touch, which is told");
  group
      .add(
          "--max-error", surface.maxError, "MM",
          "Drop triangles as long as the surface stays within this distance of that with all, both "
          "ways; 0: none")
      ->check(kNotNegative);
}

}  // namespace

void addMeshOptions(CLI::App& app, OutputOptions& output) {
  convert::WriteMeshOptions& mesh = output.mesh;
  addSurfaceOptions(app, output.surface);
  OptionGroup group(app, "Mesh");
  group.addFlag(
      "--patches", output.patches,
      "Give the surface in pieces, one group of faces for each branch, which meet but are "
      "not joined");
  group
      .add("--cell", output.polygonise.cell, "MM",
           "With --patches: edge of a marching-cubes cell; 0: the voxel size")
      ->check(kNotNegative);
  group
      .add("--lod", output.surface.levels, "N",
           "Levels of detail in one glTF, each with a quarter of the triangles (MSFT_lod)")
      ->check(wholeIn(1, 8));
  group.addChoice("--mesh-per", mesh.per, kMeshPer, "glTF: one mesh, or one for each branch");
  group.addChoice("--color", mesh.color, kColorBy,
                  "glTF: colours of vertices, which all kinds of colour vision tell apart");
  group.addFlag("--stl-solids", mesh.stlSolids,
                "Write STL as text with one named solid for each group of faces, as OpenFOAM takes "
                "it");
  CLI::Option* meshopt = group.addFlag(
      "--meshopt", mesh.meshopt,
      "Compress glTF with EXT_meshopt_compression, to a micrometre; not for the f3d of "
      "Debian 12, which crashes on any such file");
  group
      .addFlag("--draco", mesh.draco,
               "Compress glTF with KHR_draco_mesh_compression; not for the f3d of Debian 12, "
               "which crashes on any such file")
      ->excludes(meshopt);
  group
      .add("--draco-position-bits", mesh.dracoPositionBits, "N",
           "Bits of a position in the bounding box of the mesh")
      ->check(wholeIn(1, 30));
  group.add("--draco-normal-bits", mesh.dracoNormalBits, "N", "Bits of a normal")
      ->check(wholeIn(2, 30));
}

}  // namespace lumen::app
