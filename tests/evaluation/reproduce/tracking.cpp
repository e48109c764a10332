// SPDX-License-Identifier: Apache-2.0
// lumen_tracking_report FOLDER [SEEDS]: the tracker on synthetic patients: success, accuracy by
// radius, and where noise, coarse data and careless clicks make it fail. Writes tracking.md,
// tracking.json and the data of plots. SEEDS patients (10) as they come, the first three of them
// under everything else.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "converters/cli/terminal_progress.h"
#include "plot.h"
#include "report.h"
#include "seams.h"
#include "track_score.h"

namespace {

using namespace lumen;
using namespace lumen::reproduce;
using Outcomes = std::vector<TrackOutcome>;

constexpr int kSize = 256;
constexpr std::uint64_t kSweepSeeds = 3;
constexpr std::array kRadiusEdges = {0.0, 1.5, 2.0, 3.0, 5.0, 1e9};  // voxels
constexpr std::array kRateEdges = {0.0, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.01};
constexpr double kWell = 0.95;

convert::PhantomOptions patientOptions(std::uint64_t seed) {
  convert::PhantomOptions options;
  options.name = "patient";
  options.size = kSize;
  options.seed = seed;
  return options;
}

using Prepare = std::function<convert::Phantom(std::uint64_t seed, Progress& progress)>;

Outcomes runSeeds(std::uint64_t seeds, const Prepare& prepare, Progress& progress) {
  Outcomes out;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
    out.push_back(trackAndScore(prepare(seed, progress), progress));
  return out;
}

Prepare withOptions(const std::function<void(convert::PhantomOptions&)>& change) {
  return [change](std::uint64_t seed, Progress& progress) {
    convert::PhantomOptions options = patientOptions(seed);
    change(options);
    return convert::makePhantom(options, progress);
  };
}

/// Voxels mapped linearly from their range to that of an unsigned type.
template <class T>
void rescale(convert::Volume& volume) {
  const auto& from = std::get<std::vector<std::int16_t>>(volume.voxels);
  const auto [low, high] = std::minmax_element(from.begin(), from.end());
  const double first = *low,
               scale = static_cast<double>(std::numeric_limits<T>::max()) / (*high - first);
  std::vector<T> to;
  to.reserve(from.size());
  for (const std::int16_t x : from) to.push_back(static_cast<T>(std::lround(scale * (x - first))));
  volume.voxels = std::move(to);
}

/// Slices three voxels thick: means of three slices.
void mergeSlices(convert::Volume& volume) {
  convert::VolumeGeometry& geometry = volume.geometry;
  const auto& from = std::get<std::vector<std::int16_t>>(volume.voxels);
  const std::size_t slice =
      static_cast<std::size_t>(geometry.size[0]) * static_cast<std::size_t>(geometry.size[1]);
  geometry.size[2] /= 3;
  std::vector<std::int16_t> to(geometry.voxelCount());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const std::size_t at = 3 * slice * (i / slice) + i % slice;
    to[i] = static_cast<std::int16_t>(
        std::lround((from[at] + from[at + slice] + from[at + 2 * slice]) / 3.0));
  }
  volume.voxels = std::move(to);
  geometry.origin[2] += geometry.spacing[2];
  geometry.spacing[2] *= 3;
}

Prepare changed(double voxel, const std::function<void(convert::Phantom&, std::uint64_t)>& change) {
  return [voxel, change](std::uint64_t seed, Progress& progress) {
    convert::PhantomOptions options = patientOptions(seed);
    options.voxel = voxel;
    convert::Phantom phantom = convert::makePhantom(options, progress);
    change(phantom, seed);
    return phantom;
  };
}

/// Sums over branches; lengths in mm, the rest in voxels.
struct Summary {
  double branches = 0, well = 0, covered = 0, started = 0, leaked = 0, length = 0, missed = 0,
         falseLength = 0;
  double assd = 0, bias = 0, square = 0, measured = 0;

  void add(const BranchOutcome& b, double voxel) {
    branches += 1, length += b.length;
    well += b.score.overlap >= kWell ? 1 : 0;
    covered += b.score.missed <= (1 - kWell) * b.length ? 1 : 0;
    started += b.started ? 1 : 0;
    leaked += b.leaked ? 1 : 0;
    missed += b.score.missed, falseLength += b.score.falseLength;
    if (!std::isfinite(b.score.assd) || !std::isfinite(b.score.radiusBias)) return;
    measured += b.length;
    assd += b.length * b.score.assd / voxel;
    bias += b.length * b.score.radiusBias / voxel;
    square += b.length * std::pow(b.score.radiusRms / voxel, 2);
  }
  void addRow(const std::string& name, Table& table) const {
    table.rows.push_back({name, branches, 100 * well / branches, 100 * covered / branches,
                          branches - started, leaked, length, missed, falseLength, assd / measured,
                          bias / measured, std::sqrt(square / measured)});
  }
};

Table summaryTable(const std::string& title) {
  return {title,
          {"case", "vessels", "OV >= 0.95, %", "95 % of length, %", "not started", "leaked",
           "length mm", "missed mm", "false mm", "ASSD voxels", "radius bias voxels",
           "radius RMS voxels"},
          {}};
}

Summary summarise(const Outcomes& outcomes) {
  Summary sum;
  for (const TrackOutcome& outcome : outcomes)
    for (const BranchOutcome& branch : outcome.branches) sum.add(branch, outcome.voxel);
  double falseLength = 0;  // with what answers for no true branch
  for (const TrackOutcome& outcome : outcomes) falseLength += outcome.score.falseLength;
  sum.falseLength = falseLength;
  return sum;
}

std::string rangeName(double low, double high) {
  if (high > 1e6) return "from " + formatNumber(low);
  return formatNumber(low) + " to " + formatNumber(std::min(high, 1e6));
}

Table branchesByRadius(const Outcomes& outcomes) {
  Table table = summaryTable("Vessels by their mean true radius, voxels");
  for (std::size_t k = 0; k + 1 < kRadiusEdges.size(); ++k) {
    Summary sum;
    for (const TrackOutcome& outcome : outcomes)
      for (const BranchOutcome& branch : outcome.branches)
        if (branch.radius >= kRadiusEdges[k] && branch.radius < kRadiusEdges[k + 1])
          sum.add(branch, outcome.voxel);
    if (sum.branches > 0) sum.addRow(rangeName(kRadiusEdges[k], kRadiusEdges[k + 1]), table);
  }
  return table;
}

std::vector<NodeOutcome> allNodes(const Outcomes& outcomes) {
  std::vector<NodeOutcome> nodes;
  for (const TrackOutcome& outcome : outcomes)
    nodes.insert(nodes.end(), outcome.nodes.begin(), outcome.nodes.end());
  return nodes;
}

Table nodesByRadius(const std::vector<NodeOutcome>& nodes) {
  Table table{"Nodes within their own vessel by the true radius there, voxels",
              {"radius", "nodes", "centre median", "centre p90", "bias mean", "error median",
               "|error| p90"},
              {}};
  for (std::size_t k = 0; k + 1 < kRadiusEdges.size(); ++k) {
    std::vector<double> centre, error, size;
    double sum = 0;
    for (const NodeOutcome& node : nodes) {
      if (node.trueRadius < kRadiusEdges[k] || node.trueRadius >= kRadiusEdges[k + 1]) continue;
      if (node.centreError > node.trueRadius) continue;
      centre.push_back(node.centreError);
      error.push_back(node.radiusError);
      size.push_back(std::abs(node.radiusError));
      sum += node.radiusError;
    }
    for (auto* values : {&centre, &error, &size}) std::sort(values->begin(), values->end());
    if (centre.empty()) continue;
    const auto count = static_cast<double>(centre.size());
    table.rows.push_back({rangeName(kRadiusEdges[k], kRadiusEdges[k + 1]), count,
                          quantile(centre, 0.5), quantile(centre, 0.9), sum / count,
                          quantile(error, 0.5), quantile(size, 0.9)});
  }
  return table;
}

/// Error of the centres against the inlier rate; adds the curve of medians to the plot.
Table reliability(const std::string& name, const std::vector<NodeOutcome>& nodes, Plot& plot) {
  Table table{"Reliability, " + name + ": error of a node's centre by its inlier rate",
              {"inlier rate", "nodes", "median voxels", "p90 voxels", "over 1/2 voxel, %",
               "median, radii", "outside its vessel, %"},
              {}};
  Curve curve{name, {}};
  for (std::size_t k = 0; k + 1 < kRateEdges.size(); ++k) {
    std::vector<double> error, relative;
    double rate = 0, half = 0, outside = 0;
    for (const NodeOutcome& node : nodes) {
      if (!(node.inlierRate >= kRateEdges[k] && node.inlierRate < kRateEdges[k + 1])) continue;
      error.push_back(node.centreError);
      relative.push_back(node.centreError / node.trueRadius);
      rate += node.inlierRate;
      half += node.centreError > 0.5 ? 1 : 0;
      outside += relative.back() > 1 ? 1 : 0;
    }
    if (error.empty()) continue;
    std::sort(error.begin(), error.end());
    std::sort(relative.begin(), relative.end());
    const auto count = static_cast<double>(error.size());
    table.rows.push_back({rangeName(kRateEdges[k], std::min(1.0, kRateEdges[k + 1])), count,
                          quantile(error, 0.5), quantile(error, 0.9), 100 * half / count,
                          quantile(relative, 0.5), 100 * outside / count});
    if (count >= 20) curve.points.emplace_back(rate / count, quantile(error, 0.9));
  }
  plot.curves.push_back(curve);
  return table;
}

struct Case {
  std::string name;
  Prepare prepare;
};

std::vector<Case> dataCases() {
  std::vector<Case> cases;
  for (const double bias : {0.0, 0.2, 0.3, 0.5})
    cases.push_back({"bias field " + formatNumber(bias),
                     withOptions([bias](auto& options) { options.bias = bias; })});
  cases.push_back({"8-bit", changed(0.2, [](auto& p, auto) { rescale<std::uint8_t>(p.volume); })});
  cases.push_back(
      {"16-bit unsigned", changed(0.2, [](auto& p, auto) { rescale<std::uint16_t>(p.volume); })});
  cases.push_back({"voxels of 0.5 mm", changed(0.5, [](auto&, auto) {})});
  cases.push_back(
      {"0.5 x 0.5 x 1.5 mm", changed(0.5, [](auto& p, auto) { mergeSlices(p.volume); })});
  return cases;
}

std::vector<Case> clickCases() {
  const std::vector<std::pair<std::string, ClickError>> errors = {
      {"true direction and radius given", {0, 0, 1}},
      {"half a radius off", {0.5, -1, 0}},
      {"30 degrees off", {0, 30, 0}},
      {"radius times 1.5", {0, -1, 1.5}},
      {"radius divided by 1.5", {0, -1, 1 / 1.5}},
      {"half a radius, 30 degrees, times 1.5", {0.5, 30, 1.5}},
      {"no radius for any child", {0, -1, -1}}};
  std::vector<Case> cases;
  for (const auto& entry : errors)
    cases.push_back({entry.first, changed(0.2, [error = entry.second](auto& p, auto seed) {
                       disturbClicks(p, error, seed);
                     })});
  return cases;
}

Table runCases(const std::string& title, const std::vector<Case>& cases, std::uint64_t seeds,
               Progress& progress) {
  Table table = summaryTable(title);
  for (const Case& one : cases)
    summarise(runSeeds(seeds, one.prepare, progress)).addRow(one.name, table);
  return table;
}

void noiseSweep(std::uint64_t seeds, Report& report, Plot& reliabilityPlot, Plot& noisePlot,
                Progress& progress) {
  Table table = summaryTable("Noise, as a share of the contrast");
  Curve well{"OV >= 0.95", {}}, covered{"95 % of length", {}};
  std::vector<Table> curves;
  for (const double noise : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5}) {
    const Outcomes outcomes =
        runSeeds(seeds, withOptions([noise](auto& options) { options.noise = noise; }), progress);
    const Summary sum = summarise(outcomes);
    sum.addRow(formatNumber(noise), table);
    well.points.emplace_back(noise, 100 * sum.well / sum.branches);
    covered.points.emplace_back(noise, 100 * sum.covered / sum.branches);
    if (noise == 0.1 || noise == 0.15)
      curves.push_back(
          reliability("noise " + formatNumber(noise), allNodes(outcomes), reliabilityPlot));
  }
  noisePlot.curves = {well, covered};
  report.table(table);
  report.picture("tracking_noise.svg", noisePlot.title);
  for (const Table& curve : curves) report.table(curve);
}

void run(const std::filesystem::path& folder, std::uint64_t seeds, Progress& progress) {
  const std::uint64_t few = std::min(seeds, kSweepSeeds);
  std::filesystem::create_directories(folder);
  Report report("Tracking of synthetic patients");
  report.paragraph(
      "`phantom patient`, 256 voxels of 0.2 mm along an edge, noise 0.05, bias field 0.1, one "
      "click "
      "to a vessel, default parameters everywhere. Aneurysms are left out. OV and lengths are "
      "those "
      "of `lumen compare`; a vessel has leaked when a node lies outside of it and in another "
      "vessel "
      "that is neither its own child nor, for the vessel's beginning, its parent. In the thesis 94 "
      "% "
      "of 744 vessels succeeded, by eye, and 89 % to a third of their length or more (tables 3.8, "
      "3.9). Walls are corrected for the blur that is measured in the volume, and the volume is "
      "smoothed as its noise asks for. Slices of 1.5 mm are means of three slices of the volume of "
      "0.5 mm.");
  Plot reliabilityPlot{"90th percentile of the centres' error", "inlier rate", "voxels", false, {}};
  Plot noisePlot{"Vessels tracked", "noise / contrast", "%", false, {}};

  const Outcomes plain = runSeeds(seeds, withOptions([](auto&) {}), progress);
  Table total = summaryTable("All patients");
  for (std::size_t i = 0; i < plain.size(); ++i)
    summarise({plain[i]}).addRow("seed " + std::to_string(i + 1), total);
  summarise(plain).addRow("all", total);
  report.table(total);
  report.table(branchesByRadius(plain));
  report.table(nodesByRadius(allNodes(plain)));
  report.table(reliability("noise 0.05", allNodes(plain), reliabilityPlot));
  noiseSweep(few, report, reliabilityPlot, noisePlot, progress);
  report.picture("tracking_reliability.svg", reliabilityPlot.title);
  writePlot(folder, "tracking_noise", noisePlot);
  writePlot(folder, "tracking_reliability", reliabilityPlot);
  report.write(folder, "tracking");
  report.table(runCases("Data", dataCases(), few, progress));
  report.write(folder, "tracking");
  report.table(runCases("Clicks", clickCases(), few, progress));
  report.write(folder, "tracking");
  std::fputs(report.markdown().c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc == 3 ? std::atoi(argv[2]) : 10;
  if (argc < 2 || argc > 3 || seeds < 1) {
    std::fputs("usage: lumen_tracking_report FOLDER [SEEDS]\n", stderr);
    return 2;
  }
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, Verbosity::Quiet));
  try {
    run(argv[1], static_cast<std::uint64_t>(seeds), progress);
  } catch (const std::exception& e) {
    progress.abandon();
    std::fprintf(stderr, "lumen_tracking_report: %s\n", e.what());
    return 1;
  }
  return 0;
}
