// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/case_of.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/warning.h"
#include "converters/geometry/automatic_names.h"
#include "converters/geometry/far_origin.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/io/volume/write_volume.h"
#include "converters/operations/dark_seeds.h"
#include "converters/operations/hinted_vessels.h"
#include "converters/operations/label_prior.h"
#include "converters/operations/stated_vessels.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/fitting/fit.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

/// Voxels in the median radius of a tree: the fit is made for vessels of a few voxels in radius.
constexpr double kVoxelsOfRadius = 5;
/// Accuracy as a share of the median radius: given radii have no noise to stop at. With twice this
/// the volume of a narrowing is 1 % short.
constexpr double kAccuracyOfRadius = 0.005;

convert::FitOptions fitOptionsFor(const formats::Case& value, const ModelOptions& options) {
  if (value.metadata.voxelSize || value.tree.nodeCount() == 0) return options.fit;
  std::vector<float> radii = value.tree.radius;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  convert::FitOptions scaled = options.fit;
  if (!scaled.accuracy) scaled.accuracy = kAccuracyOfRadius * double{*middle};
  // Cohesion is for blobs that noise would scatter. Here it would draw the wall inwards, by .35 %
  // of the radius.
  if (!options.isCohesionStated && scaled.cohesionWeight == convert::FitOptions{}.cohesionWeight)
    scaled.cohesionWeight = 0;
  return scaled.resolved(double{*middle} / kVoxelsOfRadius);
}

/// Takes out the seeds whose names no branch has, and warns of them; `reason` comes before the vessel
/// that is there.
void warnOfLostNames(std::vector<convert::SeedBranch>& named, const formats::Case& value,
                     const VesselOptions& options, const std::string& reason,
                     const Context& context) {
  std::vector<convert::SeedFailure> lost;
  std::erase_if(named, [&](const convert::SeedBranch& seed) {
    if (convert::branchNamed(value.tree, seed.label)) return false;
    const std::string there = nearestText(value.tree, seed.points.front().position);
    lost.push_back({seed.label, reason + "; " + there});
    return true;
  });
  warnOfSeeds(formats::printable(options.seedsName),
              {WarningCode::SeedUnused, " names no vessel: "}, lost, context);
}

/// Names and selects the vessels of a case by maps.
void applyMaps(const Source& source, const std::vector<NamingMap>& naming,
               const CaseOptions& options, MadeCase& made, const Context& context) {
  std::vector<convert::SeedBranch> named = convert::seedsOf(made.value, source.name);
  std::erase_if(named, [&](const convert::SeedBranch& seed) {
    return !convert::branchNamed(made.value.tree, seed.label);
  });
  nameByMaps(naming, made.value, context);
  warnOfLostNames(named, made.value, options.vessels, "a label map names it", context);
  if (options.isOnlyLabelled) {
    leaveOutUnlabelled(naming, made.value, source.name);
    warnOfLostNames(named, made.value, options.vessels,
                    "it is left out, as it lies on no label of a vessel", context);
  }
  if (!naming.empty()) renameEnds(made.value.tree, made.remarks.ends);
  recordMaps(source.maps, made.value);
}

/// The volume less the bone of the scan without contrast, if there is one.
std::optional<convert::NativeSubtraction> withoutBone(const Source& source,
                                                      const Context& context) {
  if (!source.native) return {};
  const std::string name = formats::printable(source.native->name);
  convert::NativeSubtraction out = convert::subtractNative(
      *source.grey, formats::printable(source.name), source.native->voxels, name, context.progress);
  if (out.report.unmatched > 0)
    warn(context.progress,
         about(name, {WarningCode::NativeUnmatched,
                      fixedText(out.report.unmatched / 1000, 1) +
                          " ml of its bone match no bone of " + formats::printable(source.name) +
                          "; there the contrast alone separates vessels from bone"}));
  return out;
}

MadeCase caseOfGrey(const Source& source, const CaseOptions& options, const Context& context) {
  const std::optional<convert::NativeSubtraction> subtraction = withoutBone(source, context);
  const convert::Volume& volume = subtraction ? subtraction->volume : *source.grey;
  const std::vector<NamingMap> naming = namingMaps(source.maps, volume.geometry, source.name);
  VesselOptions vessels = options.vessels;
  convert::bringNear(volume.geometry.origin, vessels.roots);
  vessels.prior = priorOf(source.maps, volume.geometry, context.progress);
  vessels.stated = statedVessels(source.maps, context);
  convert::TrackResult tracked = trackVessels(volume, source.name, vessels, context);
  MadeCase made;
  made.value = std::move(tracked.result);
  if (subtraction) {
    made.native = subtraction->report;
    made.value.metadata.source = convert::describeSource(*source.grey);
    recordVolume("native", source.native->voxels, made.value);
  }
  made.remarks = std::move(static_cast<convert::TrackRemarks&>(tracked));
  applyMaps(source, naming, options, made, context);
  CaseSelection select;
  if (options.isOnlyLabelled)
    select = [&](formats::Case& run, const Context& within) {
      nameByMaps(naming, run, within);
      leaveOutUnlabelled(naming, run, source.name);
    };
  made.repetition =
      repeatTracks(volume, source.name, vessels, options.repeats, select, made.value, context);
  if (options.corrected) {
    made.replayed = convert::replayEdits(options.corrected->value, made.value);
    for (const convert::LeftEdit& left : made.replayed->left)
      warn(context.progress,
           about(formats::printable(options.corrected->name),
                 {WarningCode::CorrectionLeft,
                  "a correction is not made again: " + left.sentence + ": " + left.why}));
  }
  const ImageBesideMaps image{volume, vessels.prior, vessels.track.dark};
  made.labels = inventoryOf(source.maps, naming, made.value, volume.geometry, &image, context);
  return made;
}

/// The names that a label map or its table gives.
std::set<std::string> namesStated(const LabelPart& labels) {
  std::set<std::string> names;
  for (const auto& [value, name] : convert::namesOf(labels.meanings)) names.insert(name);
  return names;
}

MadeCase caseOfLabels(const Source& source, const CaseOptions& options, const Context& context) {
  const convert::VolumeGeometry& geometry = source.labels->voxels.geometry;
  const std::vector<NamingMap> naming = namingMaps(source.maps, geometry, source.name);
  MadeCase made;
  made.value = labelledVessels(*source.labels, options.chosenLabels, context);
  convert::nameAutomatically(made.value.tree, 0, namesStated(*source.labels));
  applyMaps(source, naming, options, made, context);
  applyRoots(made.value, source.name, options.vessels, context);
  made.labels = inventoryOf(source.maps, naming, made.value, geometry, nullptr, context);
  return made;
}

MadeCase caseOfMesh(const Source& source, const CaseOptions& options, const Context& context) {
  MadeCase made;
  made.meshFrame.emplace();
  made.value = meshVessels(source, options.meshUnit, *made.meshFrame, context);
  convert::nameAutomatically(made.value.tree);
  applyRoots(made.value, source.name, options.vessels, context);
  return made;
}

/// The case as its source shows it. The source goes with the call, as its voxels are large.
MadeCase caseWithoutModels(Source source, const CaseOptions& options, const Context& context) {
  if (source.grey) return caseOfGrey(source, options, context);
  if (source.labels) return caseOfLabels(source, options, context);
  if (source.mesh) return caseOfMesh(source, options, context);
  MadeCase made;
  if (source.value) {
    made.value = *std::move(source.value);
  } else {
    made.centerlineFrame = source.centerline.value().frame;
    made.value = convert::caseOfCenterline(source.centerline->file, source.name);
    recordAssumptions(made.value.metadata.steps.back(), source.centerline->file.assumptions);
    applyRoots(made.value, source.name, options.vessels, context);
  }
  return made;
}

}  // namespace

MadeCase caseOf(Source source, const CaseOptions& options, const Context& context) {
  MadeCase made = caseWithoutModels(std::move(source), options, context);
  if (options.models && !made.value.models)
    made.value = fitted(std::move(made.value), *options.models, context);
  return made;
}

formats::Case fitted(formats::Case value, const ModelOptions& options, const Context& context) {
  convert::fit(value, fitOptionsFor(value, options), context.progress);
  return value;
}

}  // namespace lumen::operations
