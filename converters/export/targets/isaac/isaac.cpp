// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/distance_grid.h"
#include "converters/export/shared/grid_files.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/isaac/usd.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

/// Cells along the longest side of PhysX's distance field: its default.
constexpr int kSdfResolution = 256;

std::string usdTuple(const Eigen::Vector3d& v) {
  return vectorText(v, kFloatDigits);
}

/// Texts of `count` entries in brackets.
template <class TextOf>
std::string usdList(std::size_t count, TextOf textOf) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ", ";
    text += textOf(i);
  }
  return text + "]";
}

std::string usdString(const std::string& text) {
  std::string out = "\"";
  for (const char c : formats::printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Letters, digits and "_" of ASCII, not beginning with a digit.
std::string usdWord(const std::string& name) {
  std::string word = openFoamWord(name);
  for (char& c : word)
    if (c == '.' || c == '-') c = '_';
  return word.front() >= '0' && word.front() <= '9' ? "_" + word : word;
}

std::string extentText(const SurfaceMesh& mesh) {
  const Box3d box = boundingBox(mesh);
  std::string text = "[";
  text += usdTuple(box.low) + ", " + usdTuple(box.high) + "]";
  return text;
}

/// Nodes of each branch, from the one that it starts at in its parent.
std::vector<std::vector<std::size_t>> collectCurves(const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::size_t>> curves;
  for (const formats::Branch& branch : tree.branches) {
    std::vector<std::size_t> curve;
    if (branch.parentNode >= 0) curve.push_back(static_cast<std::size_t>(branch.parentNode));
    for (std::size_t n = 0; n < branch.nodeCount; ++n) curve.push_back(branch.firstNode + n);
    if (curve.size() > 1) curves.push_back(std::move(curve));
  }
  return curves;
}

/// The branches as polylines, in the frame's unit.
struct Curves {
  std::vector<std::size_t> counts, branches;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> widths;
};

Curves centerline(const formats::CenterlineTree& tree, const ExportFrame& frame) {
  Curves made;
  for (const auto& curve : collectCurves(tree)) {
    made.counts.push_back(curve.size());
    made.branches.push_back(tree.branch[curve[1]]);
    for (const std::size_t place : curve) {
      made.points.push_back(frame.position(toEigen(tree.centre[place])));
      // a branch is as wide at its parent's node as at its own first node
      const bool isOthers = tree.branch[place] != tree.branch[curve[1]];
      const std::size_t node = isOthers ? curve[1] : place;
      made.widths.push_back(2 * frame.length(static_cast<double>(tree.radius[node])));
    }
  }
  return made;
}

/// The primvar of colours, in linear light, of branches: one for each vertex or each curve.
template <class Branches>
std::string colorsText(const Branches& branches, const SurfaceMesh& mesh,
                       const std::string& interpolation) {
  SurfaceMesh colored;
  colored.systems = mesh.systems;
  for (const auto branch : branches) colored.branch.push_back(static_cast<std::uint32_t>(branch));
  const std::vector<Color> colors = vertexColors(colored, {ColorBy::System, 0, 1});
  const auto text = [&](std::size_t i) {
    const Color& c = colors[i];
    return vectorText(Eigen::Vector3d(c[0], c[1], c[2]) / 65535, 4);
  };
  return "        color3f[] primvars:displayColor = " + usdList(colors.size(), text) +
         " (\n            interpolation = \"" + interpolation + "\"\n        )\n";
}

std::string curveColors(const Curves& curves, const SurfaceMesh& mesh) {
  const auto name = [&](std::size_t i) {
    return usdString(systemName(mesh.systems[curves.branches[i]]));
  };
  return colorsText(curves.branches, mesh, "uniform") +
         "        custom string[] lumen:systems = " + usdList(curves.branches.size(), name) + "\n";
}

std::string endPrim(const NamedEnd& end, const std::string& word, const ExportFrame& frame) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), frame.direction(end.direction));
  return exportText("isaac/end.usda",
                    {{"word", word},
                     {"name", usdString(end.name)},
                     {"radius", numberText(frame.length(end.radius))},
                     {"position", usdTuple(frame.position(end.position))},
                     {"turn", numberText(turn.w()) + ", " + numberText(turn.x()) + ", " +
                                  numberText(turn.y()) + ", " + numberText(turn.z())}});
}

std::string endPrims(const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  std::vector<std::string> names;
  for (const NamedEnd& end : ends) names.push_back(end.name);
  const std::vector<std::string> words = distinct(names, usdWord);
  std::string text;
  for (std::size_t i = 0; i < ends.size(); ++i) text += endPrim(ends[i], words[i], frame);
  return text;
}

}  // namespace

std::string encodeUsda(const SurfaceMesh& mesh, const formats::CenterlineTree& tree,
                       const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  const Curves curves = centerline(tree, frame);
  const auto index = [&](std::size_t i) { return std::to_string(mesh.triangle[i / 3][i % 3]); };
  const auto point = [&](std::size_t i) {
    const Float3& p = mesh.position[i];
    return usdTuple({p[0], p[1], p[2]});
  };
  return exportText(
      "isaac/vessel.usda",
      {{"axes", std::string(axesText(frame.axes))},
       {"metres", numberText(0.001 / frame.scale())},
       {"up", frame.axes == Axes::Lsa ? "Y" : "Z"},
       {"resolution", std::to_string(kSdfResolution)},
       {"extent", extentText(mesh)},
       {"counts", usdList(mesh.triangle.size(), [](std::size_t) { return std::string("3"); })},
       {"indices", usdList(3 * mesh.triangle.size(), index)},
       {"points", usdList(mesh.position.size(), point)},
       {"curves", usdList(curves.counts.size(),
                          [&](std::size_t i) { return std::to_string(curves.counts[i]); })},
       {"curvePoints",
        usdList(curves.points.size(), [&](std::size_t i) { return usdTuple(curves.points[i]); })},
       {"widths",
        usdList(curves.widths.size(), [&](std::size_t i) { return numberText(curves.widths[i]); })},
       {"wallColors", mesh.systems.empty() ? "" : colorsText(mesh.branch, mesh, "vertex")},
       {"curveColors", mesh.systems.empty() ? "" : curveColors(curves, mesh)},
       {"ends", endPrims(ends, frame)}});
}

namespace {

using Json = nlohmann::ordered_json;

constexpr double kTissueBorder = 5;  // mm of tissue around the vessels
/// A wall as thick as arteries have it, about a tenth of their diameter.
constexpr Length kDeformableWall{.mm = 0, .radii = 0.2};

/// Values of the synthetic volume: muscle has 35 to 55 HU, arteries in CT angiography 250 HU and
/// more.
constexpr double kTissueHu = 40, kLumenHu = 350;

/// The workflow's own map of HU to attenuation (its HuToMuMapping): linear, -1000 HU is 0, 3000 HU
/// is 0.02 / mm.
double attenuationOf(double hu) {
  return 0.02 * (hu + 1000) / 4000;
}

const char* const kSource =
    "synthetic, made by lumen from a model of the vessels: soft tissue of 40 HU, lumen of 350 HU, "
    "mu = 0.02 / mm * (HU + 1000) / 4000";

DistanceGrid makeGrid(const ExportInput& input, const VesselDistance& vessels,
                      const SurfaceMesh& wall) {
  const Box3d box = boundingBox(wall);
  const double spacing = gridSpacing(input.options.spacing, box, kTissueBorder, input.source.tree);
  // farther than a voxel from the wall, a voxel is all tissue or all lumen
  return sampleGrid({vessels, nullptr, 2 * spacing},
                    latticeOver(box, kTissueBorder, spacing, input.options.word), input.progress);
}

std::vector<std::size_t> shapeOf(const Lattice& lattice) {
  return {static_cast<std::size_t>(lattice.size[2]), static_cast<std::size_t>(lattice.size[1]),
          static_cast<std::size_t>(lattice.size[0])};
}

std::string metadataText(const Lattice& lattice) {
  const double h = lattice.spacing;
  return Json{{"shape_zyx", shapeOf(lattice)},
              {"spacing_zyx_mm", {h, h, h}},
              {"origin_xyz_mm", {lattice.first.x(), lattice.first.y(), lattice.first.z()}},
              {"hu_range", {kTissueHu, kLumenHu}},
              {"mu_range", {attenuationOf(kTissueHu), attenuationOf(kLumenHu)}},
              {"source", kSource}}
             .dump(2) +
         "\n";
}

/// A voxel that the wall cuts has a share of both, as in an image.
std::string encodeAttenuations(const DistanceGrid& grid) {
  std::vector<float> mu;
  mu.reserve(grid.values.size());
  for (const WallDistance& value : grid.values) {
    const double depth = static_cast<double>(value.distance) / grid.lattice.spacing;
    const double share = std::clamp(0.5 - depth, 0.0, 1.0);
    mu.push_back(static_cast<float>(attenuationOf(kTissueHu + share * (kLumenHu - kTissueHu))));
  }
  return encodeNpy(mu, shapeOf(grid.lattice));
}

std::string encodeMask(const DistanceGrid& grid) {
  std::vector<std::uint8_t> mask;
  mask.reserve(grid.values.size());
  for (const WallDistance& value : grid.values) mask.push_back(value.distance < 0 ? 1 : 0);
  return encodeNpy(mask, shapeOf(grid.lattice));
}

void addCache(ExportResult& result, const ExportInput& input, const DistanceGrid& grid) {
  const formats::CenterlineTree& tree = input.source.tree;
  const std::size_t nodes = tree.nodeCount();
  std::vector<float> points;
  std::vector<std::int64_t> edges;
  for (std::size_t n = 0; n < nodes; ++n) {
    for (const float x : {tree.centre[n].x, tree.centre[n].y, tree.centre[n].z})
      points.push_back(x);
    if (tree.parent[n] >= 0) {
      edges.push_back(tree.parent[n]);
      edges.push_back(static_cast<std::int64_t>(n));
    }
  }
  for (const auto& link : tree.links) edges.insert(edges.end(), {link[0], link[1]});
  const auto add = [&](const char* name, std::string bytes, const char* about) {
    result.files.push_back({name, std::move(bytes), about, "mm"});
  };
  add("metadata.json", metadataText(grid.lattice), "the cache's grid, mm, LPS");
  add("mu_volume.npy", encodeAttenuations(grid),
      "**synthetic** attenuation, 1/mm: f32, in the order z, y, x");
  add("vessel_mask.npy", encodeMask(grid), "1 in the lumen: u8, in the order z, y, x");
  add("centerline_points_mm.npy", encodeNpy(points, {nodes, 3}),
      "f32, x, y, z of each node, mm, LPS; the first is the root");
  add("centerline_edges.npy", encodeNpy(edges, {edges.size() / 2, 2}),
      "i64, nodes that are joined, from the root on");
  add("centerline_radii_mm.npy", encodeNpy(tree.radius, {nodes}), "f32, of each node, mm");
}

}  // namespace

ExportResult exportIsaac(const ExportInput& input) {
  ExportResult result;
  ExportedSurface wall = wallSurface(input, kDeformableWall);
  const SurfaceMesh shape = quickSurface(input.source, input.progress);
  const VesselDistance vessels(input.source);
  const DistanceGrid grid = makeGrid(input, vessels, shape);
  addCache(result, input, grid);
  result.files.push_back({"vessel.usda",
                          encodeUsda(wall.mesh, input.source.tree, wall.ends, input.frame),
                          "USD: wall with physics schemas, centerline, ends", ""});
  for (std::string& loss : gridLosses(grid.lattice, input.source.tree))
    result.losses.push_back(std::move(loss));
  result.start = exportText("isaac/README.md");
  result.ends = std::move(wall.ends);
  result.surface = std::move(wall.report);
  return result;
}

TargetRow isaacRow() {
  return {.name = "isaac",
          .title = "catheter navigation of isaac-for-healthcare, and Isaac Sim",
          .files = {"metadata.json", "mu_volume.npy", "vessel_mask.npy", "centerline_points_mm.npy",
                    "centerline_edges.npy", "centerline_radii_mm.npy", "vessel.usda"},
          .units = {LengthUnit::Metre, LengthUnit::Millimetre},
          .axes = {Axes::Lps, Axes::Lsa},
          .holds =
              "the tree as arrays; a mask; a synthetic attenuation; a wall with physics schemas of "
              "USD, and its ends",
          .lacks = "names of branches, and that an aneurysm is one",
          .options = {"edge", "max-error", "triangles", "thickness", "grid"}};
}

}  // namespace lumen::convert
