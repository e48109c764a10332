// SPDX-License-Identifier: Apache-2.0
#include "converters/phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "converters/common/error.h"
#include "converters/phantom/design.h"
#include "converters/phantom/render.h"
#include "converters/volume/write_volume.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

constexpr int kSmallestSize = 32, kLargestSize = 1024;
constexpr double kSmallestPatient = 25;  // mm

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void requireRange(const char* option, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::Usage, std::string("phantom: --") + option + " is " +
                                    formats::shortText(value) + ", expected " +
                                    formats::shortText(low) + " to " + formats::shortText(high));
}

void checkOptions(const PhantomOptions& options) {
  const std::vector<std::string>& names = phantomNames();
  if (std::find(names.begin(), names.end(), options.name) == names.end())
    throw Error(ErrorKind::Usage, "phantom: unknown name '" + formats::printable(options.name) +
                                      "', expected one of " + joined(names));
  if (options.size != 0) requireRange("size", options.size, kSmallestSize, kLargestSize);
  requireRange("voxel", options.voxel, 0.01, 10);
  requireRange("noise", options.noise, 0, 2);
  requireRange("bias", options.bias, 0, 2);
  requireRange("psf", options.psf, 0, 5);
}

Design makeDesign(const PhantomOptions& options, const Frame& frame, Progress& progress) {
  const std::map<std::string, std::function<Design(const Frame&)>> small = {
      {"tube", designTube},       {"helix", designHelix},       {"bifurcation", designBifurcation},
      {"kissing", designKissing}, {"aneurysm", designAneurysm}, {"stenosis", designStenosis},
      {"dropout", designDropout}};
  const auto found = small.find(options.name);
  Design design =
      found != small.end() ? found->second(frame) : designPatient(frame, options.seed, progress);
  // a stream of its own, so that the clicks do not change when the drawing does
  Random random(options.seed, 0x636c69636b73ULL);
  design.seeds = clickSeeds(design.tree, random);
  return design;
}

formats::Case describeTruth(const Design& design, const PhantomOptions& options, int size) {
  formats::Case truth;
  truth.tree = design.tree;
  truth.metadata.voxelSize = options.voxel;
  formats::Step step;
  step.name = "phantom";
  step.tool = "lumen " LUMEN_VERSION;
  step.parameters = options.parameters();
  step.parameters["size"] = static_cast<std::int64_t>(size);
  step.parameters.insert(design.notes.begin(), design.notes.end());
  truth.metadata.steps.push_back(step);
  return truth;
}

}  // namespace

std::map<std::string, formats::ParameterValue> PhantomOptions::parameters() const {
  return {{"name", name},
          {"size", static_cast<std::int64_t>(size)},
          {"voxel", voxel},
          {"noise", noise},
          {"bias", bias},
          {"psf", psf},
          {"random-seed", static_cast<std::int64_t>(seed)}};
}

const std::vector<std::string>& phantomNames() {
  static const std::vector<std::string> names = {"tube",     "helix",    "bifurcation", "kissing",
                                                 "aneurysm", "stenosis", "dropout",     "patient"};
  return names;
}

Phantom makePhantom(const PhantomOptions& options, Progress& progress) {
  checkOptions(options);
  const bool patient = options.name == "patient";
  const int size = options.size != 0 ? options.size : patient ? 256 : 128;
  const Frame frame{options.voxel, options.voxel * (size - 1)};
  if (patient && frame.extent < kSmallestPatient)
    throw Error(ErrorKind::Usage, "phantom: the volume is " + formats::shortText(frame.extent) +
                                      " mm wide, expected at least 25 mm for 'patient'");
  // drawing, two passes of the blur, and the noise each report every slice
  progress.begin("phantom", 4 * static_cast<std::size_t>(size));
  Design design = makeDesign(options, frame, progress);
  Cube cube = drawOccupancy(design, frame, size, progress);
  blur(cube, options.psf, progress);

  Phantom phantom;
  phantom.volume.geometry.size = {size, size, size};
  phantom.volume.geometry.spacing.setConstant(options.voxel);
  phantom.volume.voxels = degrade(cube, options.bias, options.noise, options.seed, progress);
  phantom.truth = describeTruth(design, options, size);
  phantom.truth.metadata.source = describeSource(phantom.volume);
  phantom.seeds = std::move(design.seeds);
  progress.end();
  return phantom;
}

}  // namespace lumen::convert
