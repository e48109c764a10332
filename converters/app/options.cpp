// SPDX-License-Identifier: Apache-2.0
#include "converters/app/options.h"

#include <map>
#include <optional>

#include "formats/case/enum_names.h"

namespace lumen::app {

namespace {

/// "a, b or c".
std::string alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  return text;
}

/// A check without its text: the help says in words what is allowed.
CLI::Validator quietly(CLI::Validator check) {
  return check.description("");
}

const CLI::Validator kShare = quietly(CLI::Range(0.0, 1.0));
const CLI::Validator kPositive = quietly(CLI::PositiveNumber);
const CLI::Validator kNotNegative = quietly(CLI::NonNegativeNumber);

/// What --seeds-frame and --seeds-unit take.
const std::map<std::string, convert::SeedSystem> kSeedSystems = {
    {"lps", convert::SeedSystem::Lps},
    {"ras", convert::SeedSystem::Ras},
    {"voxel", convert::SeedSystem::Voxel}};
const std::map<std::string, double> kSeedUnits = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}};

CLI::Validator within(int low, int high) {
  return quietly(CLI::Range(low, high));
}

/// Adds options of one help group whose defaults are the values that the variables hold.
class Group {
public:
  Group(CLI::App& app, std::string title) : m_app(app), m_title(std::move(title)) {}

  template <class T>
  CLI::Option* add(const std::string& name, T& value, const std::string& type,
                   const std::string& help) {
    return m_app.add_option(name, value, help)
        ->type_name(type)
        ->group(m_title)
        ->capture_default_str();
  }
  /// A length that follows the voxel size unless it is given.
  CLI::Option* addScaled(const std::string& name, std::optional<double>& value,
                         const std::string& help, const std::string& defaultText) {
    return m_app.add_option(name, value, help + " [" + defaultText + "]")
        ->type_name("MM")
        ->group(m_title)
        ->check(kPositive);
  }
  CLI::Option* addFlag(const std::string& name, bool& value, const std::string& help) {
    return m_app.add_flag(name, value, help)->group(m_title);
  }

private:
  CLI::App& m_app;
  std::string m_title;
};

}  // namespace

convert::ReadVolumeOptions VolumeArguments::options() const {
  convert::ReadVolumeOptions options;
  options.series = series;
  if (crop.size() == 6)
    options.crop = convert::IndexBox{{crop[0], crop[2], crop[4]}, {crop[1], crop[3], crop[5]}};
  return options;
}

convert::SeedReading TrackArguments::reading() const {
  convert::SeedReading reading;
  if (const auto system = kSeedSystems.find(seedsFrame); system != kSeedSystems.end())
    reading.system = system->second;
  if (const auto unit = kSeedUnits.find(seedsUnit); unit != kSeedUnits.end())
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
  Group group(app, "Volume");
  group.add(
      "--series", volume.series, "ID",
      "DICOM series: its instance UID, or its number in the list that is printed when a folder "
      "holds several");
  app.add_option("--crop", volume.crop, "Keep this box of voxel indices only, ends included")
      ->option_text("I0,I1,J0,J1,K0,K1")
      ->group("Volume")
      ->delimiter(',')
      ->expected(6);
}

void addEncodingOptions(CLI::App& app, formats::EncodeOptions& encoding) {
  Group group(app, "Case file");
  group.addFlag(
      "--compress", encoding.compress,
      "Compress the chunks of a .lumen file with zstd; they can no longer be used in place");
  app.add_option("--point-bits", encoding.pointBits,
                 "Round wall points to so many bits in their bounding box, 1 to 30 [exact]")
      ->type_name("N")
      ->group("Case file")
      ->check(within(1, 30));
}

void addTrackOptions(CLI::App& app, TrackArguments& track) {
  convert::TrackOptions& o = track.options;
  Group volume(app, "Volume");
  volume.addFlag("--dark", o.dark, "Vessels are darker than their background");
  Group group(app, "Tracking");
  group.add("--seeds", track.seeds, "FILE",
            "Where vessels begin: lumen's seeds JSON, or points of 3D Slicer (.mrk.json, .fcsv)");
  app.add_option("--seeds-frame", track.seedsFrame,
                 "What the seeds' coordinates are, whatever their file says: lps, ras, or voxel "
                 "(indices; radii in the file's unit)")
      ->type_name("FRAME")
      ->group("Tracking")
      ->check(quietly(CLI::IsMember(kSeedSystems)));
  app.add_option("--seeds-unit", track.seedsUnit,
                 "Unit of the seeds' positions and radii, whatever their file says: mm, cm, m or "
                 "um")
      ->type_name("UNIT")
      ->group("Tracking")
      ->check(quietly(CLI::IsMember(kSeedUnits)));
  group.addFlag("--strict", track.strict,
                "Exit with 3, tracking nothing, if a seed cannot be placed in the volume; with 1 "
                "if one started no track");
  group.add("--inlier-rate", o.inlierRate, "SHARE", "Inlier rate that accepts a cylinder")
      ->check(kShare);
  group
      .add("--inlier-band", o.inlierBand, "SHARE",
           "Half width of the inlier band, relative to the radius")
      ->check(kShare);
  group.add("--rays", o.rays, "N", "Rays of a node: 12, 42, 162 or 642")
      ->check(quietly(CLI::IsMember({12, 42, 162, 642})));
  group.add("--axes", o.axes, "N", "Candidate axes of a node: 6, 21, 81 or 321")
      ->check(quietly(CLI::IsMember({6, 21, 81, 321})));
  group.add("--samples", o.samples, "N", "Samples on a ray")->check(within(8, 4096));
  group.add("--min-trials", o.minTrials, "N", "Fewest random circles for each axis")
      ->check(within(1, 1000000));
  group.add("--max-trials", o.maxTrials, "N", "Most random circles for each axis")
      ->check(within(1, 1000000));
  group.add("--step", o.step, "S", "Prediction step, in cylinder heights")->check(kPositive);
  group
      .add("--noise-margin", o.noiseMargin, "X",
           "A node below the inlier rate needs a wall this many times as strong as noise")
      ->check(within(0, 100));
  group
      .add("--look-ahead", o.lookAhead, "N",
           "Steps to look beyond a place where nothing fits; 0: stop there")
      ->check(within(0, 100));
  group
      .add("--branch-offset", o.branchOffset, "S",
           "A child starts this many parent radii from its parent's centerline")
      ->check(kNotNegative);
  group
      .add("--aneurysm-gradient", o.aneurysmGradient, "SHARE",
           "Aneurysm points need this share of the strongest gradient seen from their centre")
      ->check(kShare);
  app.add_option("--point-spread", o.pointSpread,
                 "Standard deviation of the blur that displaces the walls; 0: no correction "
                 "[measured in the volume]")
      ->type_name("MM")
      ->group("Tracking")
      ->check(kNotNegative);
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
  group.add("--max-nodes", o.maxNodes, "N", "Bound on the nodes of one branch")->check(kPositive);
  group.add("--random-seed", o.seed, "K", "Seed of the random numbers");
}

void addFitOptions(CLI::App& app, FitArguments& fit) {
  convert::FitOptions& o = fit.values;
  Group group(app, "Fitting");
  const std::vector<std::string> kernels(formats::kKernelNames.begin(),
                                         formats::kKernelNames.end());
  group.add("--kernel", fit.kernel, "NAME", alternatives(kernels))
      ->check(quietly(CLI::IsMember(kernels)));
  app.add_option("--kernel-parameter", o.kernelParameter,
                 "Cauchy's s^2 [0.2] or the Gaussian's a^2 [0.5]")
      ->type_name("X")
      ->group("Fitting")
      ->check(kPositive);
  group.add("--cohesion-weight", o.cohesionWeight, "W", "Weight alpha of the Lennard-Jones energy")
      ->check(kNotNegative);
  group.add("--curvature-weight", o.curvatureWeight, "W", "Weight beta of the curvature energy")
      ->check(kNotNegative);
  group.add("--cohesion-scale", o.cohesionScale, "S", "Scale s of the Lennard-Jones energy")
      ->check(kPositive);
  group.add("--max-subdivisions", o.maxSubdivisions, "N", "Most blob subdivisions in one node")
      ->check(kNotNegative);
  group
      .add("--neighbourhood", o.neighbourhood, "N",
           "Topological distance of the nodes whose points a node is fitted to")
      ->check(within(0, 100));
  group.add("--seam-sweeps", o.seamSweeps, "N", "Sweeps that tie adjacent models to one another")
      ->check(within(0, 100));
  group.add("--seam-weight", o.seamWeight, "W", "Weight of a tie, in wall points")
      ->check(kNotNegative);
  group.addScaled("--iso-level", o.isoLevel, "Iso-level T", "half a voxel");
  group.addScaled("--accuracy", o.accuracy, "Subdivide until no point is farther than this",
                  "1.5 voxels");
  group.addScaled("--max-distance", o.maxDistance, "Drop blobs farther than this from their node",
                  "100 voxels");
  group.addScaled("--min-width", o.minWidth, "Drop blobs narrower than this", "0.1 voxel");
}

void addMeshOptions(CLI::App& app, OutputOptions& output) {
  Group group(app, "Mesh");
  group
      .add("--cell", output.polygonise.cell, "MM",
           "Edge of a marching-cubes cell; 0: the voxel size")
      ->check(kNotNegative);
  group.addFlag("--draco", output.mesh.draco, "Compress glTF with KHR_draco_mesh_compression");
  group
      .add("--draco-position-bits", output.mesh.dracoPositionBits, "N",
           "Bits of a position in a branch's bounding box")
      ->check(within(1, 30));
  group.add("--draco-normal-bits", output.mesh.dracoNormalBits, "N", "Bits of a normal")
      ->check(within(2, 30));
}

void addPhantomOptions(CLI::App& app, convert::PhantomOptions& phantom) {
  Group group(app, "Phantom");
  group.add("--size", phantom.size, "N", "Voxels along an edge; 0: 128, or 256 for patient")
      ->check(within(0, 2048));
  group.add("--voxel", phantom.voxel, "MM", "Edge of a voxel")->check(kPositive);
  group
      .add("--noise", phantom.noise, "SHARE",
           "Standard deviation of the noise, as a share of the contrast")
      ->check(kNotNegative);
  group
      .add("--bias", phantom.bias, "SHARE",
           "Amplitude of the slow bias field, as a share of the contrast")
      ->check(kNotNegative);
  group
      .add("--psf", phantom.psf, "VOXELS",
           "Standard deviation of the Gaussian point-spread function")
      ->check(kNotNegative);
  group.add("--seed", phantom.seed, "K", "Seed of the random numbers");
}

}  // namespace lumen::app
