// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/options.h"

#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "converters/base/error.h"
#include "converters/base/suggestion.h"
#include "converters/cli/option_group.h"
#include "converters/cli/value_checks.h"
#include "formats/case/enum_names.h"

namespace lumen::app {

namespace {

const CLI::Validator kShare = numberIn({0, 1});
const CLI::Validator kOpenShare = numberIn({0, 1, true});
const CLI::Validator kWeight = numberIn({0, 1e6});
const CLI::Validator kScale = numberIn({1e-3, 1e3});
// cases store it as a signed number
const CLI::Validator kRandomSeed = wholeIn(0, std::numeric_limits<std::int64_t>::max());

/// What --unit and --seeds-unit take.
const std::map<std::string, double> kMillimetresOf = {
    {"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}};

/// What --seeds-frame takes.
const std::map<std::string, convert::SeedSystem> kSeedSystems = {
    {"lps", convert::SeedSystem::Lps},
    {"ras", convert::SeedSystem::Ras},
    {"voxel", convert::SeedSystem::Voxel}};

/// What --spacing takes; each number of it is checked.
Eigen::Vector3d spacingOf(const std::string& text) {
  std::vector<double> values;
  for (const std::string& word : CLI::detail::split(text, ',')) values.push_back(std::stod(word));
  if (values.size() == 1) return Eigen::Vector3d::Constant(values[0]);
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw Error(ErrorKind::Usage, "--spacing: " + std::to_string(values.size()) +
                                    " numbers; expected one, or three with commas between them");
}

}  // namespace

convert::ReadVolumeOptions VolumeArguments::options() const {
  convert::ReadVolumeOptions options;
  options.series = series;
  if (!spacing.empty()) options.spacing = spacingOf(spacing);
  if (const auto mm = kMillimetresOf.find(unit); mm != kMillimetresOf.end())
    options.unit = mm->second;
  options.allowedDetached.assign(allowDetached.begin(), allowDetached.end());
  if (crop.size() == 6)
    options.crop = convert::IndexBox{{crop[0], crop[2], crop[4]}, {crop[1], crop[3], crop[5]}};
  return options;
}

convert::SeedReading TrackArguments::reading() const {
  convert::SeedReading reading;
  if (const auto system = kSeedSystems.find(seedsFrame); system != kSeedSystems.end())
    reading.system = system->second;
  if (const auto unit = kMillimetresOf.find(seedsUnit); unit != kMillimetresOf.end())
    reading.unit = unit->second;
  return reading;
}

convert::FitOptions FitArguments::options() const {
  convert::FitOptions options = values;
  if (const auto known = formats::enumFromName<formats::Kernel>(formats::kKernelNames, kernel))
    options.kernel = *known;
  return options;
}

void addVolumeOptions(CLI::App& app, VolumeArguments& volume) {
  OptionGroup group(app, "Volume");
  group.add(
      "--series", volume.series, "ID",
      "DICOM series: its instance UID, or its number in the list that is printed when a folder "
      "holds several");
  app.add_option("--crop", volume.crop, "Keep this box of voxel indices only, ends included")
      ->option_text("I0,I1,J0,J1,K0,K1")
      ->group("Volume")
      ->delimiter(',')
      ->check(wholeIn(0, std::numeric_limits<int>::max()))
      ->expected(6);
  app.add_option("--spacing", volume.spacing,
                 "Distance of voxels along i, j and k, or of all, in mm, whatever the file says")
      ->option_text("MM or MM,MM,MM")
      ->group("Volume")
      ->join(',')
      ->check(oneOrThreeIn({0, kLongest, true}));
  app.add_option(
         "--unit", volume.unit,
         "Unit of the lengths in a volume's header, a mesh or a centerline: mm, cm, m or um, "
         "whatever the file says")
      ->type_name("UNIT")
      ->group("Volume")
      ->check(oneOf(namesOf(kMillimetresOf)));
  app.add_option("--allow-detached", volume.allowDetached,
                 "Allow a header to take its voxels, or a scene its mesh, from this file, or from "
                 "below this folder; otherwise only from its own folder. May be given several "
                 "times")
      ->option_text("PATH")
      ->group("Volume")
      ->check(fileName())
      ->allow_extra_args(false);
}

void addEncodingOptions(CLI::App& app, formats::EncodeOptions& encoding) {
  OptionGroup group(app, "Case file");
  group.addFlag(
      "--compress", encoding.compress,
      "Compress the chunks of a .lumen file with zstd; they can no longer be used in place");
  app.add_option("--point-bits", encoding.pointBits,
                 "Round wall points to so many bits in their bounding box, 1 to 30 [exact]")
      ->type_name("N")
      ->group("Case file")
      ->check(wholeIn(1, 30));
}

void addTrackOptions(CLI::App& app, TrackArguments& track) {
  convert::TrackOptions& o = track.options;
  OptionGroup volume(app, "Volume");
  volume.addFlag("--dark", o.dark, "Vessels are darker than their background");
  OptionGroup group(app, "Tracking");
  addFile(app, "--seeds", track.seeds,
          "Where vessels begin: lumen's seeds JSON, or points of 3D Slicer (.mrk.json, .fcsv)")
      ->group("Tracking");
  app.add_option("--seeds-frame", track.seedsFrame,
                 "What the seeds' coordinates are, whatever their file says: lps, ras, or voxel "
                 "(indices; radii in the file's unit)")
      ->type_name("FRAME")
      ->group("Tracking")
      ->check(oneOf(namesOf(kSeedSystems)));
  app.add_option("--seeds-unit", track.seedsUnit,
                 "Unit of the seeds' positions and radii, whatever their file says: mm, cm, m or "
                 "um")
      ->type_name("UNIT")
      ->group("Tracking")
      ->check(oneOf(namesOf(kMillimetresOf)));
  group.add("--inlier-rate", o.inlierRate, "SHARE", "Inlier rate that accepts a cylinder")
      ->check(kOpenShare);
  group
      .add("--inlier-band", o.inlierBand, "SHARE",
           "Half width of the inlier band, relative to the radius")
      ->check(numberIn({0, 1, true, true}));
  group.add("--rays", o.rays, "N", "Rays of a node: 12, 42, 162 or 642")
      ->check(oneOf({12, 42, 162, 642}));
  group.add("--axes", o.axes, "N", "Candidate axes of a node: 6, 21, 81 or 321")
      ->check(oneOf({6, 21, 81, 321}));
  group.add("--samples", o.samples, "N", "Samples on a ray")->check(wholeIn(8, 4096));
  group.add("--min-trials", o.minTrials, "N", "Fewest random circles for each axis")
      ->check(wholeIn(1, 1000000));
  group.add("--max-trials", o.maxTrials, "N", "Most random circles for each axis")
      ->check(wholeIn(1, 1000000));
  group.add("--step", o.step, "S", "Prediction step, in cylinder heights")
      ->check(numberIn({0, 2, true}));
  group
      .add("--noise-margin", o.noiseMargin, "X",
           "A node below the inlier rate needs a wall this many times as strong as noise")
      ->check(numberIn({0, 100}));
  group
      .add("--look-ahead", o.lookAhead, "N",
           "Steps to look beyond a place where nothing fits; 0: stop there")
      ->check(wholeIn(0, 100));
  group
      .add("--branch-offset", o.branchOffset, "S",
           "A child starts this many parent radii from its parent's centerline")
      ->check(numberIn({0, 10, true}));
  group
      .add("--aneurysm-gradient", o.aneurysmGradient, "SHARE",
           "Aneurysm points need this share of the strongest gradient seen from their centre")
      ->check(kShare);
  app.add_option("--point-spread", o.pointSpread,
                 "Standard deviation of the blur that displaces the walls; 0: no correction "
                 "[measured in the volume]")
      ->type_name("MM")
      ->group("Tracking")
      ->check(numberIn({0, 1000}));
  app.add_option("--smoothing", o.smoothing,
                 "Standard deviation of the Gaussian that the volume is smoothed by; 0: none "
                 "[by its noise]")
      ->type_name("MM")
      ->group("Tracking")
      ->check(kNotNegative);
  app.add_flag("--even-blur,!--no-even-blur", o.evenBlur,
               "Smooth the finer axes of a volume whose coarsest edge is over 1.5 times as long, "
               "until all are about as blurred [on]")
      ->group("Tracking");
  group.add("--max-nodes", o.maxNodes, "N", "Bound on the nodes of one branch")
      ->check(wholeIn(2, std::numeric_limits<int>::max()));
  group.add("--random-seed", o.seed, "K", "Seed of the random numbers")->check(kRandomSeed);
}

void addCenterlineOptions(CLI::App& app, MeshArguments& mesh) {
  addFile(
      app, "--centerline", mesh.centerline,
      "Where the vessels of a mesh run: .vtp with VMTK's arrays, .swc, .tre or curves of 3D Slicer "
      "(.mrk.json, or a folder of them) [found inside of the mesh]")
      ->group("Surface");
  app.add_option(
         "--centerline-frame", mesh.centerlineFrame,
         "Axes of --centerline: lps, or ras, whose x and y are negated [as its file says, or "
         "those of the mesh]")
      ->type_name("FRAME")
      ->group("Surface")
      ->check(oneOf(std::vector<std::string>{"lps", "ras"}));
  app.add_option("--centerline-unit", mesh.centerlineUnit,
                 "Unit of --centerline: mm, cm, m or um [as its file says, or that of the mesh]")
      ->type_name("UNIT")
      ->group("Surface")
      ->check(oneOf(namesOf(kMillimetresOf)));
}

void addSceneOptions(CLI::App& app, MeshArguments& mesh) {
  app.add_option("--mesh", mesh.scene.mesh,
                 "Which mesh of a scene the vessels are: the name of its loader or of the loader's "
                 "node [the one in a node that says vessel, or that does not move]")
      ->type_name("NAME")
      ->group("Surface");
}

void addMaskOptions(CLI::App& app, MaskArguments& mask) {
  CLI::Option* all =
      app.add_flag("--mask", mask.isMask,
                   "The volume holds labels, and all but 0 are vessels; it needs no seeds")
          ->group("Surface");
  CLI::Option* one = app.add_option("--label", mask.label,
                                    "The volume holds labels, and this one alone is of vessels")
                         ->type_name("N")
                         ->group("Surface")
                         ->check(wholeIn(1, 1 << 24));
  app.add_option("--labels", mask.labels,
                 "The volume holds labels, and these are of vessels, such as 1=ica,2=mca; "
                 "branches get their names")
      ->type_name("LIST")
      ->group("Surface")
      ->excludes(all)
      ->excludes(one);
  one->excludes(all);
}

void addFitOptions(CLI::App& app, FitArguments& fit) {
  convert::FitOptions& o = fit.values;
  OptionGroup group(app, "Fitting");
  const std::vector<std::string> kernels(formats::kKernelNames.begin(),
                                         formats::kKernelNames.end());
  group.add("--kernel", fit.kernel, "NAME", alternatives(kernels))->check(oneOf(kernels));
  app.add_option("--kernel-parameter", o.kernelParameter,
                 "Cauchy's s^2 [0.2] or the Gaussian's a^2 [0.5]")
      ->type_name("X")
      ->group("Fitting")
      ->check(kScale);
  group.add("--cohesion-weight", o.cohesionWeight, "W", "Weight alpha of the Lennard-Jones energy")
      ->check(kWeight);
  group.add("--curvature-weight", o.curvatureWeight, "W", "Weight beta of the curvature energy")
      ->check(kWeight);
  group.add("--cohesion-scale", o.cohesionScale, "S", "Scale s of the Lennard-Jones energy")
      ->check(kScale);
  group.add("--max-subdivisions", o.maxSubdivisions, "N", "Most blob subdivisions in one node")
      ->check(wholeIn(0, 1000));
  group
      .add("--neighbourhood", o.neighbourhood, "N",
           "Topological distance of the nodes whose points a node is fitted to")
      ->check(wholeIn(0, 100));
  group.add("--seam-sweeps", o.seamSweeps, "N", "Sweeps that tie adjacent models to one another")
      ->check(wholeIn(0, 100));
  group.add("--seam-weight", o.seamWeight, "W", "Weight of a tie, in wall points")->check(kWeight);
  group.addScaled("--iso-level", o.isoLevel, "Iso-level T", "half a voxel");
  group.addScaled("--accuracy", o.accuracy, "Subdivide until no point is farther than this",
                  "1.5 voxels");
  group.addScaled("--max-distance", o.maxDistance, "Drop blobs farther than this from their node",
                  "100 voxels");
  group.addScaled("--min-width", o.minWidth, "Drop blobs narrower than this", "0.1 voxel");
}

void addPhantomOptions(CLI::App& app, convert::PhantomOptions& phantom) {
  OptionGroup group(app, "Phantom");
  group
      .add("--size", phantom.size, "N",
           "Voxels along an edge; 0: 128, or 256 for patient; not with --tree")
      ->check(wholeIn(0, 1024));
  group.add("--voxel", phantom.voxel, "MM", "Edge of a voxel")->check(numberIn({0.01, 10}));
  group
      .add("--slice-thickness", phantom.sliceThickness, "MM",
           "Thickness of a slice along z, which is the mean over it; 0: a voxel, or five for "
           "thick-slices")
      ->check(kNotNegative);
  group
      .add("--fade", phantom.fade, "SHARE",
           "Share of the contrast that is lost at the end farthest from the root")
      ->check(kShare);
  group
      .add("--noise", phantom.noise, "SHARE",
           "Standard deviation of the noise, as a share of the contrast")
      ->check(numberIn({0, 2}));
  group
      .add("--bias", phantom.bias, "SHARE",
           "Amplitude of the slow bias field, as a share of the contrast")
      ->check(numberIn({0, 2}));
  group
      .add("--psf", phantom.psf, "VOXELS",
           "Standard deviation of the Gaussian point-spread function")
      ->check(numberIn({0, 5}));
  group.add("--seed", phantom.seed, "K", "Seed of the random numbers")->check(kRandomSeed);
}

}  // namespace lumen::app
