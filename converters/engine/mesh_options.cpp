// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_options.h"

#include <cstdint>
#include <map>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/options/parsed_number.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/scope.h"

namespace lumen::engine {

namespace {

const std::map<std::string, convert::MeshPer> kMeshPer = {{"whole", convert::MeshPer::Whole},
                                                          {"branch", convert::MeshPer::Branch}};
const std::map<std::string, convert::ColorBy> kColorBy = {
    {"none", convert::ColorBy::None},
    {"branch", convert::ColorBy::Branch},
    {"radius", convert::ColorBy::Radius},
    {"confidence", convert::ColorBy::Confidence},
    {"system", convert::ColorBy::System}};

// Bounds of layers that keep numbers of cells and heights within reason.
constexpr std::int64_t kMostLayers = 50;
constexpr double kMostGrowth = 3;

const std::map<std::string, convert::Touching> kTouching = {{"share", convert::Touching::Share},
                                                            {"apart", convert::Touching::Apart}};

void setEdge(convert::EdgeLength& edge, const std::string& text) {
  const convert::Length length = convert::parseLength(text, "--edge");
  edge.share = length.radii;
  if (length.mm > 0) edge.minimum = edge.maximum = length.mm;
}

/// A bound of edges that are shares of the radius; `bound` is a member of its edge.
OptionRow& addBound(OptionTable& table, const std::string& name,
                    convert::ClosedSurfaceOptions& surface, double& bound,
                    const std::string& help) {
  convert::EdgeLength& edge = surface.edge;
  const auto store = [&surface, &bound](const std::vector<std::string>& texts) {
    if (surface.edge.share > 0) bound = parsedNumber(texts.back()).value_or(bound);
    surface.fewTriangles = false;
  };
  return table.add(name, OptionTarget(store), "MM", help).without("patches").unusedIf([&edge] {
    return edge.share > 0 ? "" : "does nothing with --edge in mm";
  });
}

/// "0.25r"
void addPatchRows(OptionTable& table, OutputOptions& output) {
  table.flag("patches", output.surface.isInPatches,
             "Write the surface in pieces, one group of faces for each branch, which meet but are "
             "not joined");
  table
      .add("cell", &output.surface.patches.cell, "MM",
           "Edge of a marching-cubes cell of the patches; 0: the voxel size")
      .in(kNotNegative)
      .onlyWith("patches");
}

void addGltfRows(OptionTable& table, OutputOptions& output) {
  convert::WriteMeshOptions& mesh = output.mesh;
  mesh.word = optionWord();
  table.scope(kAnyContent, kGltf);
  table
      .add("lod", &output.surface.closed.levels, "N",
           "Levels of detail in one glTF, each with a quarter of the triangles (MSFT_lod)")
      .in(WholeRange{1, 8});
  table.choice("mesh-per", mesh.per, kMeshPer, "Meshes of a glTF: one, or one for each branch");
  table
      .choice(kOption.colour.name, mesh.color, kColorBy,
              "Colours of a glTF's vertices, which all kinds of colour vision can distinguish")
      .alsoCalled("color");
  table
      .flag("skin", mesh.skin,
            "Write the motion of a case as a skin and an animation of a glTF; without it, the case "
            "at rest")
      .forInputs(kCases)
      .notBeside("time")
      .negative = "no-skin";
  table.flag("meshopt", mesh.meshopt,
             "Compress glTF with EXT_meshopt_compression, to a micrometre; not for the f3d of "
             "Debian 12, which crashes on any such file");
  table
      .flag("draco", mesh.draco,
            "Compress glTF with KHR_draco_mesh_compression; not for the f3d of Debian 12, which "
            "crashes on any such file")
      .without("meshopt");
  table
      .add("draco-position-bits", &mesh.dracoPositionBits, "N",
           "Bits of a position in the bounding box of the mesh")
      .in(WholeRange{1, 30})
      .onlyWith("draco");
  table.add("draco-normal-bits", &mesh.dracoNormalBits, "N", "Bits of a normal")
      .in(WholeRange{2, 30})
      .onlyWith("draco");
}

}  // namespace

void addSurfaceRows(OptionTable& table, convert::ClosedSurfaceOptions& surface) {
  using Texts = std::vector<std::string>;
  const bool isFew = surface.fewTriangles;
  OptionRow& edge = table
                        .add(
                            "edge",
                            [&surface](const Texts& texts) {
                              setEdge(surface.edge, texts.back());
                              surface.fewTriangles = false;
                            },
                            "LENGTH",
                            "Edges of equal lengths: a share of the vessel's radius such as "
                            "0.25r, or mm")
                        .without("patches");
  if (isFew)
    edge.unusedIf([&surface] {
      const bool isByError =
          surface.maxError.value_or(convert::SurfaceError{}) != convert::SurfaceError{};
      return !surface.thickness && (surface.maxTriangles || isByError)
                 ? "does nothing with --max-error or --triangles"
                 : "";
    });
  else
    edge.defaults(shownNumber(surface.edge.share) + "r");
  table
      .add(
          "extend",
          [&surface](const Texts& texts) {
            for (const std::string& text : texts)
              surface.extend.push_back(convert::parseEndLength(text, "--extend"));
          },
          "[LABEL=]LENGTH",
          "Flow extensions at all ends, such as 5r or 20mm, or at those of a branch: LABEL=5r")
      .many()
      .without("patches");
  table
      .add(
          "thickness",
          [&surface](const Texts& texts) {
            surface.thickness = convert::parseLength(texts.back(), "--thickness");
          },
          "LENGTH",
          "Thickness of a solid wall around the lumen, such as 0.5 (mm) or 0.2r; between lumens "
          "that "
          "touch it is down to half, and lumen reports where")
      .forOutputs(kAllSurfaces)
      .without("patches");
  table
      .add(
          "max-error",
          [&surface](const Texts& texts) {
            surface.maxError = convert::parseSurfaceError(texts.back(), "--max-error");
          },
          "LENGTH",
          "As few triangles as lie within this distance of the field: mm, or 0.1v (voxels), or "
          "0.03r (radii), or the larger of several; 0: edges of equal lengths")
      .defaults(isFew ? std::string(convert::kUsualSurfaceErrorText) : "0")
      .without("patches");
  table
      .add("triangles", &surface.maxTriangles, "N",
           "Greatest number of triangles; lumen reports how far off the surface then is")
      .in(WholeRange{1, 1 << 24})
      .without("patches");
}

void addLayerRows(OptionTable& table, convert::VolumeMeshOptions& cells) {
  cells.word = optionWord();
  const auto noLayers = [&cells] { return cells.layers > 0 ? "" : "does nothing with --layers 0"; };
  table
      .add("layers", &cells.layers, "N",
           "Layers of prisms at the wall, with tetrahedra within; 0: tetrahedra alone")
      .in(WholeRange{0, kMostLayers});
  table
      .add("growth", &cells.growth, "FACTOR",
           "Height of a layer over that of the one before it, away from the wall")
      .in(NumberRange{1, kMostGrowth})
      .unusedIf(noLayers);
  table
      .add(
          "layer-height",
          [&cells](const std::vector<std::string>& texts) {
            cells.height = convert::parseLength(texts.back(), "--layer-height");
          },
          "LENGTH",
          "Height of the layer at the wall, as a share of the vessel's radius such as 0.05r, or in "
          "mm; layers are thinner where they would meet")
      .defaults(shownNumber(cells.height.radii) + "r")
      .unusedIf(noLayers);
}

void addMeshFileRows(OptionTable& table, OutputOptions& output) {
  convert::ClosedSurfaceOptions& surface = output.surface.closed;
  table.group("Mesh");
  table.scope(kAnyContent, kAllMeshes);
  addSurfaceRows(table, surface);
  table
      .choice(
          "touching", surface.touching, kTouching,
          "Walls of vessels that touch: they share one, or keep apart, each a sixth as thick as "
          "asked for or more")
      .forOutputs(kAllSurfaces)
      .onlyWith("thickness");
  convert::EdgeLength& edge = surface.edge;
  addBound(table, "edge-min", surface, edge.minimum, "Least length of edges")
      .in(kNotNegative)
      .defaults("0");
  addBound(table, "edge-max", surface, edge.maximum, "Greatest length of edges").in(kPositive);
  table
      .scaled("gap", surface.gap, "Distance that touching vessels keep",
              "0.1 voxels, or 0.05 of the least radius")
      .without("patches");
  table.scope(kAnyContent, kAllSurfaces);
  table.flag("open", surface.open, "Leave the flat ends of vessels open").without("patches");
  addPatchRows(table, output);
  addGltfRows(table, output);
  table.scope(kAnyContent, kStl);
  table.flag("stl-solids", output.mesh.stlSolids,
             "Write STL as text with one named solid for each group of faces, as OpenFOAM takes "
             "it");
  table.scope(kAnyContent, kCells);
  addLayerRows(table, output.cells);
  table.scope(kAnyContent);
  table.group("");
}

}  // namespace lumen::engine
