// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/grid/grid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/distance_grid.h"
#include "converters/export/shared/grid_files.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kVdbBand = 3;                // samples, as OpenVDB's own level sets have
constexpr std::size_t kMostBranches = 65535;  // numbers of 16 bits, without 0

const char* const kDistances = "distances to the wall, negative in the lumen";
const char* const kBranches = "in which branch's lumen a sample is: the numbers of branches.json";

/// One of the grids of a folder.
struct GridPlan {
  std::string stem;   ///< stem of its files: empty, or "NAME."
  TreeRegion region;  ///< empty: all vessels
  Lattice lattice;
};

bool wants(const GridOptions& options, GridFormat format) {
  return std::find(options.formats.begin(), options.formats.end(), format) != options.formats.end();
}

void requireSound(const ExportInput& input, const GridOptions& options) {
  const bool isOfMm = wants(options, GridFormat::Nrrd) || wants(options, GridFormat::Nifti) ||
                      wants(options, GridFormat::Mhd);
  if (input.frame.unit != LengthUnit::Millimetre && isOfMm)
    throw Error(ErrorKind::Usage,
                input.field("unit") +
                    " m: readers of nrrd, nifti and mhd take their lengths for mm; " +
                    input.field("format") + " vdb or cdf can be in m");
  if (input.source.tree.branches.size() > kMostBranches)
    throw unsupported("a grid distinguishes 65535 branches, and this case has " +
                      std::to_string(input.source.tree.branches.size()));
  if (wants(options, GridFormat::Vdb)) requireVdb(input.options.word);
}

/// Around the walls of the vessels of a region.
Box3d boxOfRegion(const SurfaceMesh& wall, const TreeRegion& region) {
  Box3d box;
  for (std::size_t v = 0; v < wall.position.size(); ++v)
    if (std::binary_search(region.begin(), region.end(), wall.node[v]))
      box.add(toEigen(wall.position[v]));
  return box;
}

std::vector<GridPlan> planGrids(const ExportInput& input, const GridOptions& options) {
  const formats::CenterlineTree& tree = input.source.tree;
  const SurfaceMesh wall = quickSurface(input.source, input.progress);
  if (wall.position.empty())
    throw invalidInput("the models of this case have no wall, so there is no distance to it");
  const Box3d box = boundingBox(wall);
  const double spacing = gridSpacing(input.options.spacing, box, kGridBorder, tree);
  const double border = (options.band ? *options.band : kGridBorder) + kGridBorderSamples * spacing;
  const Lattice whole = latticeOver(box, border, spacing, input.options.word);
  if (!options.perBranch) return {{"", {}, whole}};
  std::vector<std::string> labels;
  for (const formats::Branch& branch : tree.branches) labels.push_back(branch.label);
  const std::vector<std::string> words = distinct(labels, fileWord);
  std::vector<GridPlan> plans;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    TreeRegion region = regionOfBranch(tree, b);
    const Box3d own = boxOfRegion(wall, region);
    if (own.isEmpty()) continue;  // it has no wall of its own
    plans.push_back({words[b] + ".", std::move(region), cropLattice(whole, own, border)});
  }
  return plans;
}

/// Branches by their numbers in a branch grid.
VolumeNotes makeNotes(const formats::CenterlineTree& tree) {
  VolumeNotes notes = {{"lumen.distance", "mm, negative in the lumen"}};
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
    notes["lumen.branch." + std::to_string(b + 1)] = formats::printable(tree.branches[b].label);
  return notes;
}

std::vector<std::uint16_t> findBranches(const DistanceGrid& grid) {
  std::vector<std::uint16_t> branches;
  branches.reserve(grid.values.size());
  for (const WallDistance& value : grid.values)
    branches.push_back(static_cast<std::uint16_t>(value.distance < 0 ? value.branch + 1 : 0));
  return branches;
}

/// The files of one grid.
class GridFiles {
public:
  GridFiles(const ExportInput& input, const GridOptions& options, const VesselDistance& vessels,
            const GridPlan& plan)
      : m_input(input), m_options(options), m_plan(plan), m_source{vessels} {
    if (!plan.region.empty()) m_source.region = &plan.region;
    if (m_options.band) m_source.band = *m_options.band;
  }

  std::vector<ExportFile> make() {
    addVolumes();
    const double unit = 1 / m_input.frame.scale();
    if (wants(m_options, GridFormat::Vdb)) {
      GridSource source = m_source;
      if (!m_options.band) source.band = kVdbBand * m_plan.lattice.spacing;
      add("distance.vdb",
          encodeVdb(source, m_plan.lattice, {.unit = unit, .half = m_options.half},
                    m_input.progress),
          "a level set \"distance\", and numbers \"branch\"");
    }
    if (wants(m_options, GridFormat::Cdf))
      add("distance.cdf", encodeCdf(m_source, m_plan.lattice, unit, m_input.progress),
          "distances, positive in the lumen, for Bullet's btSdfCollisionShape");
    return std::move(m_files);
  }

private:
  void add(const std::string& name, std::string bytes, const std::string& about) {
    m_files.push_back({m_plan.stem + name, std::move(bytes), m_plan.stem.empty() ? about : "", ""});
  }

  void addVolumes() {
    if (!wants(m_options, GridFormat::Nrrd) && !wants(m_options, GridFormat::Nifti) &&
        !wants(m_options, GridFormat::Mhd))
      return;
    const DistanceGrid grid = sampleGrid(m_source, m_plan.lattice, m_input.progress);
    Volume volume = distanceVolume(grid, 1);
    addVolume(volume, "distance", kDistances);
    volume.voxels = findBranches(grid);
    addVolume(volume, "branch", kBranches);
  }

  void addVolume(const Volume& volume, const std::string& name, const std::string& about) {
    if (wants(m_options, GridFormat::Mhd)) {
      const std::string raw = m_plan.stem + name + ".raw";
      add(name + ".mhd", metaImageHeader(volume, raw), about + "; in `" + raw + "`");
      add(name + ".raw", std::string(voxelBytes(volume)), "");
    }
    const auto addAs = [&](const std::string& file, const VolumeFormat& format) {
      add(file, encodeVolume(volume, format, true, file, makeNotes(m_input.source.tree)), about);
    };
    if (wants(m_options, GridFormat::Nrrd)) addAs(name + ".nrrd", VolumeFormat::Nrrd);
    if (wants(m_options, GridFormat::Nifti)) addAs(name + ".nii.gz", VolumeFormat::Nifti);
  }

  const ExportInput& m_input;
  const GridOptions& m_options;
  const GridPlan& m_plan;
  GridSource m_source;
  std::vector<ExportFile> m_files;
};

std::string branchTable(const formats::Case& value) {
  const formats::CenterlineTree& tree = value.tree;
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(value);
  Json list = Json::array();
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
    list.push_back(
        {{"value", b + 1},
         {"label", tree.branches[b].label},
         {"kind", tree.branches[b].kind == formats::BranchKind::Aneurysm ? "aneurysm" : "vessel"}});
  for (std::size_t b = 0; b < systems.size(); ++b)
    list[b]["system"] = formats::kVesselSystemNames[static_cast<std::size_t>(systems[b])];
  return Json{{"branches", std::move(list)}}.dump(2, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

}  // namespace

ExportResult exportGrid(const ExportInput& input, const GridOptions& options) {
  requireSound(input, options);
  const VesselDistance vessels(input.source, options.exact);
  ExportResult result;
  const std::vector<GridPlan> plans = planGrids(input, options);
  for (const GridPlan& plan : plans)
    for (ExportFile& file : GridFiles(input, options, vessels, plan).make())
      result.files.push_back(std::move(file));
  if (options.perBranch)
    result.others.push_back({"NAME.distance.*, NAME.branch.*",
                             "of each branch: distances, and in which branch a sample is"});
  result.files.push_back(
      {"branches.json", branchTable(input.source), "which number is which branch", ""});
  result.losses = gridLosses(plans.front().lattice, input.source.tree);
  result.ends = findEnds(input.source.tree);
  result.start = options.perBranch
                     ? exportText("grid/per-branch.md")
                     : exportText("grid/one.md", {{"perBranch", input.field("per-branch")}});
  return result;
}

TargetRow gridRow() {
  return {.name = "grid",
          .title = "those who read grids of distances",
          .files = {"branches.json"},
          .units = {LengthUnit::Millimetre, LengthUnit::Metre},
          .axes = {Axes::Lps},
          .holds = "the signed distance to the wall, and whose lumen a sample is in",
          .lacks = "what is thinner than two samples; where vessels touch, their walls",
          .unless = "per-branch",
          .options = {"grid", "format", "band", "half", "per-branch", "exact"},
          .needsVessel = false};
}

}  // namespace lumen::convert
