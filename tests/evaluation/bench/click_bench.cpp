// SPDX-License-Identifier: Apache-2.0
// Costs of one click on the public 3DRA: the vessel under it, its track, and the models that are new or
// stale with it.
//
// click_bench VOLUME CASE LABEL... prints, for each branch of the case, milliseconds of the processor: the
// branch is deleted, and tracked and fitted again from the middle of it. Tracking one vessel is the work of
// one core, fitting that of all.
#include <cstdio>
#include <ctime>
#include <string>

#include "converters/base/vectors.h"
#include "converters/io/volume/read_volume.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/tracking/vessel_at_click.h"
#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "formats/case/reachability.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

/// Milliseconds of the processor, over all threads: what others run beside it does not count.
double since(std::clock_t& start) {
  const std::clock_t now = std::clock();
  const double ms = 1e3 * static_cast<double>(now - start) / CLOCKS_PER_SEC;
  start = now;
  return ms;
}

void again(const TrackingVolume& volume, const formats::Case& whole, const std::string& label) {
  formats::Case value = whole;
  std::uint32_t branch = 0;
  while (branch < value.tree.branches.size() && value.tree.branches[branch].label != label)
    ++branch;
  if (branch == value.tree.branches.size()) return;
  const formats::Branch old = value.tree.branches[branch];
  SeedBranch seed;
  seed.label = label + " again";
  const Eigen::Vector3d click = toEigen(value.tree.centre[old.firstNode + old.nodeCount / 2]);
  Progress silent;
  std::clock_t clock = std::clock();
  const Change change = deleteBranch(value, branch);
  const double deleting = since(clock);
  refit(value, change.stale, recordedFitOptions(value), silent);
  const double refitting = since(clock);
  const VesselAtClick vessel = vesselAtClick(volume, click);
  const double finding = since(clock);
  seed.points.push_back({click, std::nullopt});
  const AddedTracks tracks = addTracksFromSeeds(volume, value, {seed}, silent);
  const double tracking = since(clock);
  std::vector<std::uint32_t> before(tracks.result.tree.nodeCount(), UINT32_MAX);
  for (std::uint32_t n = 0; n < tracks.firstNewNode; ++n) before[n] = n;
  const auto stale = staleNodes(value, tracks.result, before);
  const double comparing = since(clock);
  formats::Case out = tracks.result;
  refit(out, stale, recordedFitOptions(out), silent);
  const double fitting = since(clock);
  const bool isNew = tracks.firstNewBranch < out.tree.branches.size();
  const auto reach = formats::measureReachability(out.tree, formats::caseField(out));
  std::printf(
      "%-12s %5.1f -> %5.1f mm, parent %5d; delete %5.1f refit %5.0f (%zu) click %5.1f%s track "
      "%6.0f "
      "compare %5.1f fit %6.0f (%zu) ms; reachable %.0f of %.0f; %s\n",
      label.c_str(), formats::branchLength(whole.tree, old),
      isNew ? formats::branchLength(out.tree, out.tree.branches.back()) : 0,
      isNew ? out.tree.branches.back().parentNode : -2, deleting, refitting, change.stale.size(),
      finding, vessel.found ? "" : "!", tracking, comparing, fitting, stale.size(), reach.reachable,
      reach.total, tracks.failures.empty() ? "" : tracks.failures[0].reason.c_str());
}

int run(int count, char** arguments) {
  Progress silent;
  const Volume volume = readVolume(arguments[1], VolumeFormat::Nrrd, ReadVolumeOptions{}, silent);
  const auto read = formats::readCaseFile(arguments[2]);
  if (!read) return 1;
  std::clock_t clock = std::clock();
  const TrackingVolume tracking(volume, *read, silent);
  std::printf("volume made ready: %.0f ms; smoothing %g, blur %g, half level %g, noise %g\n",
              since(clock), *tracking.options().smoothing, tracking.wallShape()->pointSpread,
              tracking.wallShape()->halfLevel, tracking.noiseFloor());
  for (int i = 3; i < count; ++i) again(tracking, *read, arguments[i]);
  return 0;
}

}  // namespace
}  // namespace lumen::convert

int main(int count, char** arguments) {
  if (count < 4) return 2;
  return lumen::convert::run(count, arguments);
}
