// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/phantom.h"

#include <algorithm>
#include <cmath>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/phantom/clutter.h"
#include "converters/stages/phantom/phantom_scene.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

constexpr int kSmallestSize = 32, kLargestSize = 1024;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void requireRange(const OptionName& option, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::Usage, "phantom: " + option.shown() + " is " + formats::shortText(value) +
                                    ", expected " + formats::shortText(low) + " to " +
                                    formats::shortText(high));
}

void checkSubject(const PhantomOptions& options) {
  if (!options.tree.empty()) {
    if (!options.name.empty())
      throw Error(ErrorKind::Usage, "phantom: has the name '" + formats::printable(options.name) +
                                        "' and " + kOption.tree.shown() + ", expected one of them");
    if (options.size != 0)
      throw Error(ErrorKind::Usage, "phantom: " + kOption.size.shown() + " is given with " +
                                        kOption.tree.shown() +
                                        ", whose box fits the tree; leave it out");
    return;
  }
  const std::vector<std::string>& names = phantomNames();
  if (std::find(names.begin(), names.end(), options.name) == names.end())
    throw Error(ErrorKind::Usage, "phantom: unknown name '" + formats::printable(options.name) +
                                      "', expected one of " + joined(names));
}

void checkOptions(const PhantomOptions& options) {
  checkSubject(options);
  if (options.size != 0) requireRange(kOption.size, options.size, kSmallestSize, kLargestSize);
  requireRange(kOption.voxel, options.voxel, 0.01, 10);
  if (options.sliceThickness != 0)
    requireRange(kOption.sliceThickness, options.sliceThickness, options.voxel,
                 100 * options.voxel);
  requireRange(kOption.noise, options.noise, 0, 2);
  requireRange(kOption.bias, options.bias, 0, 2);
  requireRange(kOption.psf, options.psf, 0, 5);
  requireRange(kOption.fade, options.fade, 0, 1);
  (void)parseClutter(options.clutter);
}

formats::Case describeTruth(const PhantomScene& scene, const PhantomOptions& options) {
  formats::Case truth;
  truth.tree = scene.design.tree;
  formats::Step step;
  step.name = "phantom";
  step.tool = "lumen " LUMEN_VERSION;
  step.parameters = options.parameters();
  if (options.tree.empty()) {
    step.parameters[kOption.size.name] = static_cast<std::int64_t>(scene.grid.size[0]);
  } else {
    step.parameters.erase("name");
    step.parameters.erase(kOption.size.name);
    step.parameters["tree-sha256"] = scene.treeSha256;
  }
  step.parameters.insert(scene.design.notes.begin(), scene.design.notes.end());
  truth.metadata.steps.push_back(step);
  return truth;
}

VolumeGeometry geometryOf(const PhantomScene& scene, const Image& image) {
  VolumeGeometry geometry = scene.grid;
  geometry.size[2] = image.size[2];
  geometry.spacing.z() *= scene.slice;
  geometry.origin.z() += 0.5 * (scene.slice - 1) * scene.grid.spacing.z();
  return geometry;
}

void addImageRows(PhantomOptions& o, OptionTable& table) {
  constexpr NumberRange kTwice{0, 2};
  table
      .add(kOption.noise.name, &o.noise, "SHARE",
           "Standard deviation of the noise, as a share of the contrast")
      .in(kTwice)
      .recorded();
  table
      .add(kOption.bias.name, &o.bias, "SHARE",
           "Amplitude of the slow bias field, as a share of the contrast")
      .in(kTwice)
      .recorded();
  table
      .add(kOption.psf.name, &o.psf, "VOXELS",
           "Standard deviation of the Gaussian point-spread function")
      .in(NumberRange{0, 5})
      .recorded();
}

}  // namespace

void PhantomOptions::addRows(OptionTable& table) {
  table.group("Phantom");
  table
      .add(kOption.size.name, &size, "N",
           "Voxels along an edge; 0: 128, or 256 for patient and willis; not with " +
               kOption.tree.shown())
      .in(WholeRange{0, kLargestSize})
      .recorded()
      .notBeside(kOption.tree.name);
  table.add(kOption.voxel.name, &voxel, "MM", "Edge of a voxel")
      .in(NumberRange{0.01, 10})
      .recorded();
  table
      .add(kOption.sliceThickness.name, &sliceThickness, "MM",
           "Thickness of a slice along z, which is the mean over it; 0: a voxel, or five for "
           "thick-slices")
      .in(kNotNegative)
      .recorded();
  table
      .add(kOption.fade.name, &fade, "SHARE",
           "Share of the contrast that is lost at the end farthest from the root")
      .in(NumberRange{0, 1})
      .recorded();
  table
      .add(kOption.clutter.name, &clutter, "LIST",
           "Structures and losses that disturb finding and are not part of the truth, such as "
           "bone,vein,streaks,stent,void")
      .recorded();
  addImageRows(*this, table);
  table.add("seed", &seed, "K", "Seed of the random numbers")
      .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})  // cases store a signed number
      .recorded("random-seed");
  table
      .choice("clicks", isCareless, carelessByName(),
              "Manner of clicking the seeds; careless clicks lie a fifth of a radius off the "
              "axis, 1.5 radii "
              "beyond the parent's wall, and state neither radius nor direction")
      .onlyWith(kOption.seeds.name);
  table
      .add("click-drawing", &clickDrawing, "K",
           "Number of the drawing of clicks: another number makes others on the same volume")
      .in(WholeRange{0, std::numeric_limits<std::int64_t>::max()})
      .onlyWith(kOption.seeds.name);
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
  if (sliceThickness == 0) parameters.erase(kOption.sliceThickness.name);
  if (clutter.empty()) parameters.erase(kOption.clutter.name);
  if (fade == 0) parameters.erase(kOption.fade.name);
  return parameters;
}

const std::vector<std::string>& phantomNames() {
  static const std::vector<std::string> names = {
      "tube",         "helix",         "bifurcation", "kissing", "aneurysm",     "stenosis",
      "dropout",      "sac-lobes",     "companion",   "hairpin", "right-angle",  "fading",
      "thick-slices", "coil",          "arc",         "cone",    "ellipse-tube", "fork",
      "sac-sphere",   "sac-ellipsoid", "sac-fork",    "willis",  "patient"};
  return names;
}

Phantom makePhantom(const PhantomOptions& options, Progress& progress) {
  checkOptions(options);
  PhantomScene scene =
      options.tree.empty() ? sceneOfName(options, progress) : sceneOfTree(options, progress);
  const std::set<Clutter> clutter = parseClutter(options.clutter);
  // drawing, two passes of the blur, and the noise each report every slice
  progress.begin("phantom", 3 * static_cast<std::size_t>(scene.grid.size[2]) +
                                static_cast<std::size_t>(scene.grid.size[1]) +
                                clutterSteps(clutter, scene.design, scene.grid));
  Image image = drawOccupancy(scene.design, scene.grid, progress);
  addClutter(clutter, scene.design, scene.grid, options.seed, image, progress);
  blur(image, options.psf, progress);
  if (scene.slice != 1) image = averageSlices(image, scene.slice);

  Phantom phantom;
  phantom.volume.geometry = geometryOf(scene, image);
  phantom.volume.voxels =
      degrade(image, options.bias, options.noise, options.seed, scene.slice, progress);
  phantom.truth = describeTruth(scene, options);
  phantom.truth.metadata.voxelSize =
      scene.slice == 1 ? options.voxel : phantom.volume.geometry.voxelSize();
  phantom.truth.metadata.source = describeSource(phantom.volume);
  phantom.seeds = std::move(scene.design.seeds);
  progress.end();
  return phantom;
}

}  // namespace lumen::convert
