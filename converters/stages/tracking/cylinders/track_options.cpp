// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/track_options.h"

#include "converters/base/error.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {
namespace {

constexpr NumberRange kShare{0, 1};
constexpr NumberRange kOpenRange{0, 1, true};
constexpr int kMostTrials = 1000000;

void addSearchRows(TrackOptions& o, OptionTable& table) {
  table.add("inlier-rate", &o.inlierRate, "SHARE", "Inlier rate that accepts a cylinder")
      .in(kOpenRange)
      .recorded();
  table
      .add("inlier-band", &o.inlierBand, "SHARE",
           "Half width of the inlier band, relative to the radius")
      .in(NumberRange{0, 1, true, true})
      .recorded();
  table.add("rays", &o.rays, "N", "Rays of a node: 12, 42, 162 or 642")
      .among({12, 42, 162, 642})
      .recorded();
  table
      .add("samples", &o.samples, "N",
           "Samples on a ray; without clicks at most 16 for each edge of a voxel")
      .in(WholeRange{8, 4096})
      .recorded();
}

/// Rows of tracks that advance from a seed by random search. A vessel that is found has its course:
/// it takes no steps, and nothing of it is drawn at random.
void addAdvanceRows(TrackOptions& o, OptionTable& table) {
  const char* const seeds = "seeds";
  table.add("axes", &o.axes, "N", "Candidate axes of a node from a seed on: 6, 21, 81 or 321")
      .among({6, 21, 81, 321})
      .recorded()
      .onlyWith(seeds);
  table.add("min-trials", &o.minTrials, "N", "Fewest random circles for each axis, from a seed on")
      .in(WholeRange{1, kMostTrials})
      .recorded()
      .onlyWith(seeds);
  table.add("max-trials", &o.maxTrials, "N", "Most random circles for each axis, from a seed on")
      .in(WholeRange{1, kMostTrials})
      .recorded()
      .onlyWith(seeds);
  table.add("step", &o.step, "S", "Prediction step from a seed on, in cylinder heights")
      .in(NumberRange{0, 2, true})
      .recorded()
      .onlyWith(seeds);
  table
      .add("look-ahead", &o.lookAhead, "N",
           "Steps to look beyond a place where nothing fits; 0: stop there")
      .in(WholeRange{0, 100})
      .recorded()
      .onlyWith(seeds);
  table
      .add("branch-offset", &o.branchOffset, "S",
           "The track of a child's seed starts this many parent radii from its parent's centerline")
      .in(NumberRange{0, 10, true})
      .recorded()
      .onlyWith(seeds);
  table.add("max-nodes", &o.maxNodes, "N", "Bound on the nodes of one track from a seed")
      .in(WholeRange{2})
      .recorded()
      .onlyWith(seeds);
  table
      .add("random-seed", &o.seed, "K",
           "Seed of the random numbers from a seed on, and of repeated runs")
      .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})  // cases store a signed number
      .recorded()
      .onlyWith(seeds)
      .onlyWith("repeat");
}

void addWallRows(TrackOptions& o, OptionTable& table) {
  table
      .add("noise-margin", &o.noiseMargin, "X",
           "A node below the inlier rate needs a wall this many times as strong as noise")
      .in(NumberRange{0, 100})
      .recorded();
  table
      .add("aneurysm-gradient", &o.aneurysmGradient, "SHARE",
           "Aneurysm points need this share of the strongest gradient seen from their centre")
      .in(kShare)
      .recorded();
}

void addVolumeRows(TrackOptions& o, OptionTable& table) {
  table
      .add("point-spread", &o.pointSpread, "MM",
           "Standard deviation of the blur that displaces the walls; 0: no correction [measured in "
           "the volume]")
      .in(NumberRange{0, 1000})
      .recorded();
  table
      .add("smoothing", &o.smoothing, "MM",
           "Standard deviation of the Gaussian that the volume is smoothed by; 0: none [by its "
           "noise]")
      .in(kNotNegative)
      .recorded();
  OptionRow& evenBlur = table.flag(
      "even-blur", o.evenBlur,
      "Smooth the finer axes of a volume whose coarsest edge is over 1.5 times as long, until all "
      "are about as blurred [on]");
  evenBlur.recorded().negative = "no-even-blur";
}

}  // namespace

void TrackOptions::addRows(OptionTable& table) {
  addFoundRows(table);
  addAdvanceRows(*this, table);
}

void TrackOptions::addFoundRows(OptionTable& table) {
  table.group("Volume");
  table.flag("dark", dark, "Vessels are darker than their background").recorded();
  table.group("Tracking");
  addSearchRows(*this, table);
  addWallRows(*this, table);
  addVolumeRows(*this, table);
}

void TrackOptions::check(double smallestEdge) const {
  TrackOptions copy = *this;
  OptionTable table;
  copy.addRows(table);
  table.requireValues("tracking options: ");
  if (maxTrials < minTrials)
    throw invalidInput("tracking options: max-trials: found " + std::to_string(maxTrials) +
                       ", expected at least min-trials, " + std::to_string(minTrials));
  if (smoothing.value_or(0.0) > BsplineVolume::kMostSmoothing * smallestEdge)
    throw invalidInput(
        "tracking options: smoothing must be at most twice the smallest edge of a voxel");
}

std::map<std::string, formats::ParameterValue> TrackOptions::parameters() const {
  TrackOptions copy = *this;
  OptionTable table;
  copy.addRows(table);
  return table.recordedValues();
}

}  // namespace lumen::convert
