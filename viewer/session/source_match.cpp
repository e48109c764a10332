// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/source_match.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/judge/check/check.h"
#include "formats/container/printable.h"

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
    throw Error(ErrorKind::Usage,
                *other + ". Close one of them, or answer that they belong to one patient");
}

Document withAcceptedVolume(const Document& document) {
  if (!otherSource(document))
    throw Error(ErrorKind::Usage, "the case is not of another volume than the one that is open");
  auto value = std::make_shared<formats::Case>(*document.value);
  addStep(value->metadata,
          {kAcceptStep, "lumen " LUMEN_VERSION, {{kDigest, document.volumeSource->sha256}}});
  Document accepted = document;
  accepted.value = std::move(value);
  return accepted;
}

}  // namespace lumen::viewer
