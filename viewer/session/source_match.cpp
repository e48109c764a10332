// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/source_match.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "converters/base/options/edit_steps.h"
#include "converters/judge/check/check.h"
#include "formats/container/printable.h"
#include "viewer/session/document/arguments.h"

namespace lumen::viewer {

namespace {

/// The step by which a case records a volume that a person has accepted, and its parameter.
constexpr const char* kAcceptStep = "accept-volume";
constexpr const char* kDigest = "sha256";

bool isAccepted(const formats::Metadata& metadata, const std::string& digest) {
  return std::any_of(metadata.steps.begin(), metadata.steps.end(),
                     [&digest](const formats::Step& step) {
                       const auto stated = step.parameters.find(kDigest);
                       return step.name == kAcceptStep && stated != step.parameters.end() &&
                              stated->second == formats::ParameterValue(digest);
                     });
}

constexpr int kAlong = 24;           // places of a volume along each of its axes
constexpr double kFewShared = 0.25;  // less is an accident of two coordinate systems more often

/// Whether a position lies in a voxel, the halves at the rim included.
bool holds(const convert::VolumeGeometry& geometry, const Eigen::Vector3d& position) {
  const Eigen::Vector3d index = geometry.indexFromWorld(position);
  for (int a = 0; a < 3; ++a)
    if (!(index[a] >= -0.5 && index[a] <= geometry.size[static_cast<std::size_t>(a)] - 0.5))
      return false;
  return true;
}

/// Share of `inner` that lies in `outer`.
double shareIn(const convert::VolumeGeometry& inner, const convert::VolumeGeometry& outer) {
  int held = 0;
  const auto place = [&](int axis, int i) {
    return (i + 0.5) / kAlong * inner.size[static_cast<std::size_t>(axis)] - 0.5;
  };
  for (int k = 0; k < kAlong; ++k)
    for (int j = 0; j < kAlong; ++j)
      for (int i = 0; i < kAlong; ++i)
        held += holds(outer, inner.worldFromIndex({place(0, i), place(1, j), place(2, k)})) ? 1 : 0;
  return double{1} * held / (kAlong * kAlong * kAlong);
}

}  // namespace

std::string shownName(const Document& document, FileRole role) {
  const std::string label = document.labelOf(role);
  return label.empty() ? "the " + roleName(role) : formats::printable(label);
}

std::optional<std::string> otherSource(const Document& document) {
  if (!document.value || !document.volumeSource || !document.value->metadata.source)
    return std::nullopt;
  const auto difference =
      convert::sourceDifference(*document.volumeSource, *document.value->metadata.source);
  if (!difference || isAccepted(document.value->metadata, document.volumeSource->sha256))
    return std::nullopt;
  const std::string which = shownName(document, FileRole::Case) +
                            " was made from another volume than " +
                            shownName(document, FileRole::Volume);
  if (difference->what == "voxels")
    return which + ", whose voxels have the same places and other values";
  return which + ": its " + difference->what + " is " + difference->expected + ", here " +
         difference->found;
}

void requireOneSource(const Document& document) {
  if (const auto other = otherSource(document))
    refuse(*other + ". Close one of them, or answer that they belong to one patient");
}

Document withAcceptedVolume(const Document& document) {
  if (!otherSource(document)) refuse("the case is not of another volume than the one that is open");
  auto value = std::make_shared<formats::Case>(*document.value);
  addStep(value->metadata,
          {kAcceptStep, "lumen " LUMEN_VERSION, {{kDigest, document.volumeSource->sha256}}});
  Document accepted = document;
  accepted.value = std::move(value);
  return accepted;
}

double sharedPart(const convert::VolumeGeometry& first, const convert::VolumeGeometry& second) {
  return std::max(shareIn(first, second), shareIn(second, first));
}

std::optional<std::string> secondDoubt(const Document& document) {
  if (!document.volume || !document.second) return std::nullopt;
  const std::string first = shownName(document, FileRole::Volume),
                    second = shownName(document, FileRole::Second);
  const double shared = sharedPart(document.volume->geometry, document.second->geometry);
  if (shared == 0)
    return second + " and " + first +
           " do not overlap: their files place them apart, as volumes of two patients or of two "
           "frames are";
  if (document.volumeSource->sha256 == document.secondSource->sha256)
    return *document.volumeSource == *document.secondSource
               ? second + " is the same volume as " + first
               : second + " has the same voxels as " + first +
                     ", at other places: one of their headers is wrong";
  if (shared < kFewShared)
    return "only " + std::to_string(std::lround(100 * shared)) + " % of " + second + " and " +
           first + " overlap: they may be of two patients, or of two frames";
  if (otherSource(document) &&
      !convert::sourceDifference(*document.secondSource, *document.value->metadata.source))
    return shownName(document, FileRole::Case) + " was made from " + second + ", and not from " +
           first + ", in which vessels would be tracked";
  return std::nullopt;
}

}  // namespace lumen::viewer
