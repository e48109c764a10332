// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_info.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/shown_text.h"
#include "converters/engine/stage_options.h"
#include "converters/geometry/far_origin.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

constexpr std::size_t kShownRows = 12;

Json pointJson(const Eigen::Vector3d& point, double scale) {
  return Json::array({jsonNumber(point.x() * scale), jsonNumber(point.y() * scale),
                      jsonNumber(point.z() * scale)});
}

Json genusJson(const std::optional<std::int64_t>& genus) {
  return genus ? Json(*genus) : Json(nullptr);
}

/// Sum of the genus of all components, if each has one.
std::optional<std::int64_t> sumGenus(const convert::MeshReport& report) {
  std::int64_t sum = 0;
  for (const convert::MeshComponent& c : report.components) {
    if (!c.genus) return std::nullopt;
    sum += *c.genus;
  }
  return sum;
}

std::vector<std::size_t> groupSizes(const convert::MeshFile& file) {
  std::vector<std::size_t> sizes(file.groups.size(), 0);
  for (const std::uint32_t g : file.group) ++sizes[g];
  return sizes;
}

Json componentsJson(const MeshInfo& info) {
  const double mm = info.file.scaleFor(info.frame.unit);
  Json list = Json::array();
  for (const convert::MeshComponent& c : info.report.components)
    list.push_back({{"vertices", c.vertices},
                    {"triangles", c.triangles},
                    {"closed", c.closed},
                    {"manifold", c.manifold},
                    {"oriented", c.oriented},
                    {"genus", genusJson(c.genus)},
                    {"boundary_loops", c.boundaryLoops},
                    {"area_mm2", jsonNumber(c.area * mm * mm)},
                    {"volume_mm3", jsonNumber(c.volume * mm * mm * mm)}});
  return list;
}

/// mm to a hundredth, without the sign of a zero.
std::string place(double value) {
  return fixedText(std::round(100 * value) / 100 + 0.0, 2);
}

/// "no, 3 edges of more than two triangles, 1 point where sheets touch".
std::string manifoldText(const convert::MeshReport& r) {
  if (r.manifold) return "yes";
  std::string text = "no";
  if (r.nonManifoldEdges > 0)
    text += ", " + counted(r.nonManifoldEdges, "edge", "edges") + " of more than two triangles";
  if (r.nonManifoldVertices > 0)
    text += ", " + counted(r.nonManifoldVertices, "point", "points") + " where sheets touch";
  return text;
}

std::string orientationText(const convert::MeshReport& r) {
  if (!r.oriented) return "not consistent at " + counted(r.misorientedEdges, "edge", "edges");
  const auto inward = std::count_if(r.components.begin(), r.components.end(),
                                    [](const convert::MeshComponent& c) { return c.volume < 0; });
  if (inward == 0) return "consistent, outward";
  if (static_cast<std::size_t>(inward) == r.components.size()) return "consistent, inward";
  return "consistent, " + std::to_string(inward) + " of " + std::to_string(r.components.size()) +
         " components inward";
}

std::string defectsText(const convert::MeshReport& r) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, one, many);
  };
  add(r.degenerateTriangles, "triangle without area", "triangles without area");
  add(r.duplicateTriangles, "duplicate triangle", "duplicate triangles");
  add(r.duplicatePoints, "duplicate point", "duplicate points");
  add(r.unusedPoints, "unused point", "unused points");
  return text.empty() ? "none" : text;
}

void addRows(Lines& lines, const MeshInfo& info) {
  const double mm = info.file.scaleFor(info.frame.unit);
  std::size_t shown = 0;
  for (const convert::BoundaryLoop& loop : info.report.boundaryLoops) {
    if (++shown > kShownRows) break;
    const Eigen::Vector3d c = loop.centre * mm;
    lines.add("", counted(loop.vertex.size(), "edge", "edges") + ", radius " +
                      place(loop.radius * mm) + " mm at " + place(c.x()) + "  " + place(c.y()) +
                      "  " + place(c.z()));
  }
  if (info.report.boundaryLoops.size() > kShownRows)
    lines.add("", "and " + std::to_string(info.report.boundaryLoops.size() - kShownRows) + " more");
}

std::string groupsText(const convert::MeshFile& file) {
  const std::vector<std::size_t> sizes = groupSizes(file);
  std::string text;
  for (std::size_t g = 0; g < file.groups.size() && g < kShownRows; ++g)
    text += (g > 0 ? ", " : "") + (file.groups[g].empty() ? "(no name)" : file.groups[g]) + " (" +
            std::to_string(sizes[g]) + ")";
  if (file.groups.size() > kShownRows)
    text += " and " + std::to_string(file.groups.size() - kShownRows) + " more";
  return text.empty() ? "none" : text;
}

}  // namespace

MeshInfo describeMesh(convert::MeshFile file, const std::string& name, const std::string& unit,
                      Progress& progress) {
  MeshInfo info;
  progress.begin("diagnosing", 0);
  const Eigen::Vector3d back = convert::moveNear(file.mesh.position);
  info.report = convert::diagnoseMesh(file.mesh, progress);
  info.report.low += back;
  info.report.high += back;
  for (convert::BoundaryLoop& loop : info.report.boundaryLoops) loop.centre += back;
  progress.end();
  const bool isSimVascular = isOfSimVascular(name, file);
  const operations::MeshPart part{std::move(file), isSimVascular};
  const std::optional<double> stated =
      unit.empty() ? std::nullopt : std::optional(millimetresByUnit().at(unit));
  info.frame = operations::meshFrame(part, convert::vesselSize(info.report), name, stated,
                                     operationContext(progress));
  info.file = part.file;
  return info;
}

Json meshInfoJson(const MeshInfo& info) {
  const convert::MeshReport& r = info.report;
  const double mm = info.file.scaleFor(info.frame.unit);
  Json json = {{"vertices", r.vertices},
               {"triangles", r.triangles},
               {"closed", r.closed},
               {"manifold", r.manifold},
               {"oriented", r.oriented},
               {"genus", genusJson(sumGenus(r))},
               {"self_intersections", r.selfIntersections},
               {"self_intersections_complete", r.allSelfIntersections},
               {"boundary_edges", r.boundaryEdges},
               {"non_manifold_edges", r.nonManifoldEdges},
               {"non_manifold_vertices", r.nonManifoldVertices},
               {"misoriented_edges", r.misorientedEdges},
               {"degenerate_triangles", r.degenerateTriangles},
               {"duplicate_triangles", r.duplicateTriangles},
               {"duplicate_points", r.duplicatePoints},
               {"unused_points", r.unusedPoints},
               {"area_mm2", jsonNumber(r.area * mm * mm)},
               {"volume_mm3", jsonNumber(r.volume * mm * mm * mm)},
               {"low_mm", pointJson(r.low, mm)},
               {"high_mm", pointJson(r.high, mm)},
               {"unit", unitName(info.frame.unit)},
               {"unit_from", info.frame.unitFrom},
               {"frame_stated", info.file.frameStated}};
  json["components"] = componentsJson(info);
  json["boundary_loops"] = Json::array();
  for (const convert::BoundaryLoop& loop : r.boundaryLoops)
    json["boundary_loops"].push_back({{"edges", loop.vertex.size()},
                                      {"centre_mm", pointJson(loop.centre, mm)},
                                      {"radius_mm", jsonNumber(loop.radius * mm)}});
  const std::vector<std::size_t> sizes = groupSizes(info.file);
  json["groups"] = Json::array();
  for (std::size_t g = 0; g < sizes.size(); ++g)
    json["groups"].push_back(
        {{"name", formats::printable(info.file.groups[g])}, {"triangles", sizes[g]}});
  json["notes"] = info.file.notes;
  return json;
}

std::string meshInfoText(const MeshInfo& info) {
  const convert::MeshReport& r = info.report;
  const double mm = info.file.scaleFor(info.frame.unit);
  const auto box = [&](Eigen::Index a) {
    return shownNumber(r.low[a] * mm) + " to " + shownNumber(r.high[a] * mm);
  };
  const std::optional<std::int64_t> genus = sumGenus(r);
  Lines lines;
  lines.add("mesh", counted(r.triangles, "triangle", "triangles") + ", " +
                        counted(r.vertices, "point", "points"));
  lines.add("unit", unitText(info.frame));
  lines.add("axes", axesText(info.frame));
  lines.add("closed",
            r.closed ? "yes"
                     : "no, " + counted(r.boundaryLoops.size(), "boundary loop", "boundary loops"));
  addRows(lines, info);
  lines.add("manifold", manifoldText(r));
  lines.add("orientation", orientationText(r));
  lines.add("components", std::to_string(r.components.size()));
  lines.add("genus", genus ? std::to_string(*genus) : "- (not manifold and oriented)");
  lines.add("intersections", (r.allSelfIntersections ? "" : "more than ") +
                                 counted(r.selfIntersections, "pair", "pairs") + " of triangles");
  lines.add("defects", defectsText(r));
  lines.add("area", shownNumber(r.area * mm * mm) + " mm2");
  lines.add("volume", shownNumber(r.volume * mm * mm * mm) + " mm3" +
                          (r.closed ? "" : ", with the loops closed"));
  lines.add("box", box(0) + ", " + box(1) + ", " + box(2) + " mm");
  lines.add("groups", groupsText(info.file));
  for (const std::string& note : info.file.notes) lines.add("note", note);
  return lines.text();
}

}  // namespace lumen::engine
