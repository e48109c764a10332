// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/phantom.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/motion/posing.h"
#include "converters/stages/phantom/clutter.h"
#include "converters/stages/phantom/phantom_scene.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

constexpr int kSmallestSize = 32, kLargestSize = 1024;
constexpr double kUsualVoxel = 0.2, kOrganVoxel = 1, kLeastVoxel = 0.01, kLargestVoxel = 10;  // mm
// The full contrast, of which noise and bias are shares: 220 HU in organs.
constexpr double kOrganContrast = 0.22;

void requireRange(const std::string& field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::Usage, "phantom: " + field + " is " + formats::shortText(value) +
                                    ", expected " + formats::shortText(low) + " to " +
                                    formats::shortText(high));
}

// Rules that the rows of the options cannot state.
void checkOptions(const PhantomOptions& options) {
  const std::vector<std::string>& names = phantomNames();
  if (options.tree.empty() && std::find(names.begin(), names.end(), options.name) == names.end())
    throw Error(ErrorKind::Usage,
                "phantom: there is no '" + formats::printable(options.name) + "'");
  if (options.size != 0)
    requireRange(options.word("size"), options.size, kSmallestSize, kLargestSize);
  requireRange(options.word("voxel"), options.voxel, kLeastVoxel, kLargestVoxel);
  if (options.sliceThickness != 0)
    requireRange(options.word("slice-thickness"), options.sliceThickness, options.voxel,
                 100 * options.voxel);
  (void)parseClutter(options.clutter, options.word);
  (void)missingParts(options);
}

formats::Case describeTruth(const PhantomScene& scene, const PhantomOptions& options) {
  formats::Case truth;
  truth.tree = scene.design.tree;
  formats::Step step;
  step.name = "phantom";
  step.tool = "lumen " LUMEN_VERSION;
  step.parameters = options.parameters();
  if (options.tree.empty()) {
    step.parameters["size"] = static_cast<std::int64_t>(scene.grid.size[0]);
  } else {
    step.parameters.erase("name");
    step.parameters.erase("size");
    step.parameters["tree-sha256"] = scene.treeSha256;
  }
  step.parameters.insert(scene.design.notes.begin(), scene.design.notes.end());
  truth.metadata.steps.push_back(step);
  if (!scene.design.systems.empty()) formats::setNodeSystems(truth, scene.design.systems);
  return truth;
}

VolumeGeometry geometryOf(const PhantomScene& scene, const Image& image) {
  VolumeGeometry geometry = scene.grid;
  geometry.size[2] = image.size[2];
  geometry.spacing.z() *= scene.slice;
  geometry.origin.z() += 0.5 * (scene.slice - 1) * scene.grid.spacing.z();
  return geometry;
}

// Puts the ground where no vessel is; `image` has the vessels with their contrast.
void drawGround(const Design& design, const VolumeGeometry& grid, Image& image,
                Progress& progress) {
  Design full = design;
  std::fill(full.contrast.begin(), full.contrast.end(), 1.0F);
  const Image share = drawOccupancy(full, grid, progress);
  tbb::parallel_for(0, grid.size[2], [&](int z) {
    progress.check();
    for (int y = 0; y < grid.size[1]; ++y) {
      float* row = image.row(y, z);
      const float* inside = share.value.data() + share.index(y, z);
      for (int x = 0; x < grid.size[0]; ++x)
        row[x] += (1 - inside[x]) * static_cast<float>(design.ground(grid.position({x, y, z})));
    }
  });
}

// Steps that drawing one phase announces: the tree, which is drawn twice above a ground, two passes of
// the blur, and the noise each report every slice.
std::size_t stepsOf(const PhantomScene& scene, const PhantomOptions& options) {
  return (scene.design.ground ? 4 : 3) * static_cast<std::size_t>(scene.grid.size[2]) +
         static_cast<std::size_t>(scene.grid.size[1]) +
         clutterSteps(parseClutter(options.clutter), scene.design, scene.grid);
}

// The voxels of a design in a scene.
Volume draw(const PhantomScene& scene, const Design& design, const PhantomOptions& options,
            int phase, Progress& progress) {
  Image image = drawOccupancy(design, scene.grid, progress);
  if (design.ground) drawGround(design, scene.grid, image, progress);
  addClutter(parseClutter(options.clutter), design, scene.grid, options.seed, image, progress);
  blur(image, Eigen::Vector3d::Constant(options.psf), progress);
  if (scene.slice != 1) image = averageSlices(image, scene.slice);
  Volume volume;
  volume.geometry = geometryOf(scene, image);
  // noise of its own for each phase
  const std::uint64_t seed = options.seed + 1000003 * static_cast<std::uint64_t>(phase);
  const double full = design.ground ? kOrganContrast : 1;
  volume.voxels =
      degrade(image, full * options.bias, full * options.noise, seed, scene.slice, progress);
  return volume;
}

void requireTree(const PhantomScene& scene, const PhantomOptions& options) {
  if (options.motion == PhantomMotion::None) return;
  if (scene.design.ground)
    throw Error(ErrorKind::Usage, "phantom: the tissue around the vessels of '" + options.name +
                                      "' would stand still; " + options.word("motion") +
                                      " expects another phantom");
  if (!scene.design.wall) return;
  throw Error(ErrorKind::Usage, "phantom: the wall of '" + options.name +
                                    "' is not that of its tree, which " + options.word("motion") +
                                    " would move; expected another phantom");
}

formats::Motion motionOf(const PhantomScene& scene, const PhantomOptions& options) {
  return motionOfTissue(scene.design.tree, MovingTissue(options.motion, boxOf(scene.design.tree)),
                        periodOf(options.motion), static_cast<std::size_t>(options.phases));
}

Design designAt(const PhantomScene& scene, const formats::Motion& motion, int phase) {
  const auto first = motion.pose.begin() + static_cast<std::ptrdiff_t>(motion.node.size()) *
                                               static_cast<std::ptrdiff_t>(phase);
  Design design = scene.design;
  design.tree = posedTree(scene.design.tree,
                          {first, first + static_cast<std::ptrdiff_t>(motion.node.size())});
  return design;
}

void addImageRows(PhantomOptions& o, OptionTable& table) {
  constexpr NumberRange kTwice{0, 2};
  table
      .add("noise", &o.noise, "SHARE",
           "Standard deviation of the noise, as a share of the contrast")
      .in(kTwice)
      .recorded();
  table
      .add("bias", &o.bias, "SHARE", "Amplitude of the slow bias field, as a share of the contrast")
      .in(kTwice)
      .recorded();
  table.add("psf", &o.psf, "VOXELS", "Standard deviation of the Gaussian point-spread function")
      .in(NumberRange{0, 5})
      .recorded();
}

void addMotionRows(PhantomOptions& o, OptionTable& table) {
  table
      .choice(
          "motion", o.motion, phantomMotionByName(),
          "Motion of the vessels: one volume for each phase of a cycle, numbered, and a truth with "
          "its motion")
      .recorded();
  table.add("phases", &o.phases, "N", "Phases of the motion, evenly over its cycle")
      .in(WholeRange{2, 100})
      .recorded()
      .onlyWith("motion");
}

}  // namespace

void PhantomOptions::addRows(OptionTable& table) {
  table.group("Phantom");
  table
      .add("size", &size, "N",
           "Voxels along an edge; 0: 128, 256 for patient and willis, 112 for organs; not with " +
               word("tree"))
      .in(WholeRange{0, kLargestSize})
      .recorded()
      .notBeside("tree");
  table.add("voxel", &voxel, "MM", "Edge of a voxel; 0: 0.2, or 1 for organs")
      .in(NumberRange{0, kLargestVoxel})
      .recorded();
  table
      .add("slice-thickness", &sliceThickness, "MM",
           "Thickness of a slice along z, which is the mean over it; 0: a voxel, or five for "
           "thick-slices")
      .in(kNotNegative)
      .recorded();
  table
      .add("fade", &fade, "SHARE",
           "Share of the contrast that is lost at the end farthest from the root")
      .in(NumberRange{0, 1})
      .recorded();
  table
      .add("clutter", &clutter, "LIST",
           "Structures and losses that disturb finding and are not part of the truth, such as "
           "bone,vein,streaks,stent,void")
      .recorded();
  table
      .add("without", &without, "LIST",
           "Parts that a circle of Willis lacks, such as L-P1,Acom: " + alternatives(willisParts()))
      .recorded()
      .notBeside("tree");
  addImageRows(*this, table);
  addMotionRows(*this, table);
  table.add("seed", &seed, "K", "Seed of the random numbers")
      .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})  // cases store a signed number
      .recorded("random-seed");
  table
      .choice("clicks", isCareless, carelessByName(),
              "Manner of clicking the seeds; careless clicks lie a fifth of a radius off the "
              "axis, 1.5 radii "
              "beyond the parent's wall, and state neither radius nor direction")
      .onlyWith("seeds");
  table
      .add("click-drawing", &clickDrawing, "K",
           "Number of the drawing of clicks: another number makes others on the same volume")
      .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})
      .onlyWith("seeds");
}

const std::map<std::string, bool>& carelessByName() {
  static const std::map<std::string, bool> names = {{"usual", false}, {"careless", true}};
  return names;
}

std::map<std::string, formats::ParameterValue> PhantomOptions::parameters() const {
  PhantomOptions copy = *this;
  OptionTable table;
  copy.addRows(table);
  std::map<std::string, formats::ParameterValue> parameters = table.recordedValues();
  parameters["name"] = name;
  if (sliceThickness == 0) parameters.erase("slice-thickness");
  if (clutter.empty()) parameters.erase("clutter");
  if (without.empty()) parameters.erase("without");
  if (fade == 0) parameters.erase("fade");
  if (motion == PhantomMotion::None) {
    parameters.erase("motion");
    parameters.erase("phases");
  }
  return parameters;
}

Phantom makePhantom(const PhantomOptions& options, Progress& progress) {
  return makePhantom(
      options, [](int, const Volume&) {}, progress);
}

Phantom makePhantom(const PhantomOptions& asked, const PhaseReceiver& receive, Progress& progress) {
  PhantomOptions options = asked;
  if (options.voxel == 0) options.voxel = isOrgan(options.name) ? kOrganVoxel : kUsualVoxel;
  checkOptions(options);
  PhantomScene scene =
      options.tree.empty() ? sceneOfName(options, progress) : sceneOfTree(options, progress);
  requireTree(scene, options);
  const int phases = options.motion == PhantomMotion::None ? 1 : options.phases;
  progress.begin("phantom", static_cast<std::size_t>(phases) * stepsOf(scene, options));
  Phantom phantom;
  phantom.volume = draw(scene, scene.design, options, 0, progress);
  phantom.truth = describeTruth(scene, options);
  phantom.truth.metadata.voxelSize =
      scene.slice == 1 ? options.voxel : phantom.volume.geometry.voxelSize();
  phantom.truth.metadata.source = describeSource(phantom.volume);
  if (phases > 1 || options.motion != PhantomMotion::None) {
    phantom.truth.motion = motionOf(scene, options);
    for (int phase = 1; phase < phases; ++phase)
      receive(phase,
              draw(scene, designAt(scene, *phantom.truth.motion, phase), options, phase, progress));
  }
  phantom.seeds = std::move(scene.design.seeds);
  progress.end();
  return phantom;
}

}  // namespace lumen::convert
