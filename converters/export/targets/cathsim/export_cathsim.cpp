// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blob.h"
#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/mujoco_text.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/cathsim/wall_prisms.h"
#include "converters/export/targets/targets.h"
#include "converters/geometry/case_model.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kUsualPieces = 20000;  // each is a file and a geom: more no one loads

constexpr const char* kFolder = "phantom_assets/meshes/vessel/";

/// A twentieth of the middle one of the radii, mm.
double usualError(const formats::CenterlineTree& tree) {
  constexpr double kShare = 0.05;
  std::vector<float> radii = tree.radius;
  std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2),
                   radii.end());
  return kShare * radii[radii.size() / 2];
}

/// The surface, and behind it, if it has more triangles than either allows, the one with so few
/// that each can be a geom: off by `maxError`, or as far as it takes to have `most` triangles.
ExportedSurface surfaceInTwo(const ExportInput& input, const SurfaceError& maxError,
                             std::uint64_t most) {
  CommonOptions options = input.options;
  options.surface.maxError = maxError;
  options.surface.maxTriangles = static_cast<std::int64_t>(most);
  options.surface.withWhole = !input.options.surface.maxError;
  if (!options.surface.withWhole) {
    ExportedSurface fine = lumenSurface(input);
    if (fine.mesh.triangle.size() <= most) return fine;
    ExportedSurface coarse = lumenSurface({input.source, options, input.frame, input.progress});
    std::swap(fine.mesh, coarse.mesh);
    coarse.coarser.push_back(std::move(fine.mesh));
    return coarse;
  }
  return lumenSurface({input.source, options, input.frame, input.progress});
}

/// As surfaceInTwo(), with the count of the coarse one. Adds a sentence where it is farther off than
/// asked for. Throws Error(InvalidInput) if it has too many triangles at least.
ExportedSurface makeSurfaces(const ExportInput& input, std::vector<std::string>& losses) {
  const std::uint64_t most = input.options.maxPieces == 0 ? kUsualPieces : input.options.maxPieces;
  const SurfaceError maxError =
      input.options.surface.maxError.value_or(SurfaceError{.mm = usualError(input.source.tree)});
  ExportedSurface made = surfaceInTwo(input, maxError, most);
  const SurfaceMesh& coarse = made.coarser.empty() ? made.mesh : made.coarser.back();
  if (coarse.triangle.size() > most)
    throw invalidInput("the wall has " + std::to_string(coarse.triangle.size()) +
                       " triangles at least, each of which is a convex piece; expected is " +
                       input.field("max-pieces") + " of as many");
  made.report.vertices = coarse.position.size();
  made.report.triangles = coarse.triangle.size();
  made.report.errors = {made.report.errors.back()};
  const double error = made.report.errors.front();
  // without a second surface, it is the field that no triangle follows
  const bool isCut = input.options.surface.maxError ? !made.coarser.empty() : error > maxError.mm;
  if (isCut)
    losses.push_back("the wall is simplified to at most " + std::to_string(most) +
                     " convex pieces, up to " + fixedText(error, 3) +
                     " mm off the surface; a greater " + input.field("max-pieces") +
                     " is nearer to it");
  return made;
}

std::vector<SurfaceMesh> makeHulls(const ExportInput& input, const SurfaceMesh& mesh) {
  constexpr double kHeight = 0.5;         // radii: a wire sinks in by much less
  constexpr double kLeastVolume = 2e-15;  // m^3: MuJoCo refuses meshes of less than half of it
  const OwnedModel model = openModels(input.source);
  const Eigen::Matrix3d back = input.frame.rotation().transpose() / input.frame.scale();
  return wallPrisms(mesh, kHeight, kLeastVolume, [&](const Float3& point) {
    const Eigen::Vector3d lps = back * Eigen::Vector3d(point[0], point[1], point[2]);
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_sample sample;
    blob_query(model.get(), BLOB_BLENDED, lps.data(), &cursor, &sample);
    return (sample.state & BLOB_INSIDE) != 0;
  });
}

/// The attribute rgba of a piece whose system of vessels is known; else nothing.
std::string hullColor(const SurfaceMesh& hull) {
  const auto system = mainSystem(hull);
  if (!system) return "";
  const auto [red, green, blue] = systemColor(*system);
  return " rgba=\"" + numberText(red, 3) + " " + numberText(green, 3) + " " + numberText(blue, 3) +
         " 1\"";
}

std::string phantomText(const ExportFrame& frame, const std::vector<SurfaceMesh>& hulls,
                        const std::vector<NamedEnd>& ends) {
  std::string meshes, geoms, sites;
  for (std::size_t k = 0; k < hulls.size(); ++k) {
    const std::string name = "hull_" + std::to_string(k);
    meshes += "    <mesh name=\"" + name + "\" file=\"vessel/" + name + ".stl\"/>\n";
    geoms += "      <geom name=\"" + name + "\" type=\"mesh\" mesh=\"" + name + "\"" +
             hullColor(hulls[k]) + "/>\n";
  }
  for (const NamedEnd& end : ends) sites += "      " + endSite(frame, end);
  return exportText(
      "cathsim/vessel.xml",
      {{"version", LUMEN_VERSION}, {"meshes", meshes}, {"geoms", geoms}, {"ends", sites}});
}

}  // namespace

ExportResult exportCathsim(const ExportInput& input) {
  ExportResult result;
  ExportedSurface made = makeSurfaces(input, result.losses);
  const SurfaceMesh& coarse = made.coarser.empty() ? made.mesh : made.coarser.back();
  const std::vector<SurfaceMesh> hulls = makeHulls(input, coarse);
  result.ends = plainlyNamed(std::move(made.ends));
  result.files = {
      {"phantom_assets/vessel.xml", phantomText(input.frame, hulls, result.ends),
       "the phantom: one body, the geom `visual` without contacts, hulls, sites", ""},
      {std::string(kFolder) + "visual.stl", stlInMetres(made.mesh), "the surface", ""},
      {std::string(kFolder) + "simplified.stl", stlInMetres(coarse), "with fewer triangles", ""}};
  for (std::size_t k = 0; k < hulls.size(); ++k)
    result.files.push_back(
        {kFolder + ("hull_" + std::to_string(k)) + ".stl", stlInMetres(hulls[k]), "", ""});
  result.others.push_back({std::string(kFolder) + "hull_*.stl", "the wall's convex pieces"});
  result.start = exportText("cathsim/README.md", {{"hulls", std::to_string(hulls.size())}});
  result.surface = std::move(made.report);
  return result;
}

TargetRow cathsimRow() {
  return {.name = "cathsim",
          .title = "CathSim",
          .files = {"phantom_assets/vessel.xml", "phantom_assets/meshes/vessel/visual.stl",
                    "phantom_assets/meshes/vessel/simplified.stl",
                    "phantom_assets/meshes/vessel/hull_0.stl"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lps},
          .holds = "the surface; the wall as convex pieces; the ends as targets",
          .lacks = "the tree and its radii",
          .options = {"edge", "max-error", "max-pieces"}};
}

}  // namespace lumen::convert
