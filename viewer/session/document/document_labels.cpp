// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/document_labels.h"

#include <algorithm>
#include <string>
#include <utility>

#include "converters/base/text.h"
#include "converters/engine/answers/label_answer.h"
#include "converters/operations/label_maps.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/container/printable.h"

namespace lumen::viewer {

namespace {

constexpr const char* kFromPage = "the page";  // source of a role that a person chose

}  // namespace

std::shared_ptr<const OpenLabels> openLabels(std::vector<operations::LabelPart> maps,
                                             const Document& document) {
  operations::namingMaps(maps, document.volume->geometry, document.labelOf(FileRole::Volume));
  auto open = std::make_shared<OpenLabels>();
  open->labels = engine::describeLabels(maps.front());
  open->voxels = std::make_shared<const convert::Volume>(std::move(maps.front().voxels));
  return open;
}

std::vector<operations::LabelPart> mapsOf(const Document& document) {
  if (!document.labels) return {};
  operations::LabelPart map{*document.labels->voxels, document.labelOf(FileRole::Labels), {}};
  for (const auto& [meaning, voxels] : document.labels->labels) map.meanings.push_back(meaning);
  return {std::move(map)};
}

convert::Volume placesOf(const OpenLabels& labels) {
  convert::LabelMask mask = convert::makeLabelMask(*labels.voxels, {}, "the label map");
  convert::Volume places;
  places.geometry = mask.geometry;
  places.voxels = std::move(mask.label);
  return places;
}

ChangedRole withRole(const Document& document, const Arguments& request) {
  const std::int64_t value = request.whole("label");
  const std::string word = request.text("role");
  const auto role = convert::roleOfWord(word);
  if (!role)
    refuse("a label has no role " + formats::printable(word) + "; expected " +
           alternatives(convert::roleWords()));
  if (!document.labels) refuse("there is no label map whose labels could have roles");
  auto changed = std::make_shared<OpenLabels>(*document.labels);
  const auto found = std::find_if(changed->labels.begin(), changed->labels.end(),
                                  [&](const auto& label) { return label.first.value == value; });
  if (found == changed->labels.end())
    refuse("no voxel of the label map has the label " + std::to_string(value));
  convert::LabelMeaning& meaning = found->first;
  meaning.role = *role;
  meaning.roleFrom = kFromPage;
  meaning.isStated = true;
  const std::string name = meaning.name.empty() ? "label " + std::to_string(value) : meaning.name;
  ChangedRole out{document, "role of " + formats::printable(name) + ": " + word};
  out.document.labels = std::move(changed);
  return out;
}

Json labelsJson(const Document& document) {
  if (!document.labels) return nullptr;
  return {{"name", document.labelOf(FileRole::Labels)},
          {"roles", convert::roleWords()},
          {"list", engine::labelsJson(document.labels->labels)}};
}

}  // namespace lumen::viewer
