// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/scope.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/named_files.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using NamedContent = std::pair<ContentMask, const char*>;

/// Names of sets, the larger ones first.
const std::vector<NamedContent> kInputNames = {
    {kCases, "cases"},
    {kVolumes, "volumes"},
    {kMeshes, "meshes"},
    {kImage, "volumes of grey values"},
    {kLabels, "volumes of labels"},
    {kDicom, "folders of DICOM"},
    {kFileVolumes, "files of volumes"},
    {kFileImage, "volumes of grey values"},
    {kFileLabels, "volumes of labels"},
    {kDicomImage, "folders of DICOM"},
    {kDicomLabels, "folders of DICOM with labels"},
    {kPlainMesh, "files of one mesh"},
    {kScene, "scenes"},
    {kCenterline, "centerlines"},
    {kUnfittedCase, "cases that get models"},
    {kFittedCase, "cases that are taken as they are"},
};
const std::vector<NamedContent> kOutputNames = {
    {kAllMeshes, "meshes"},
    {kAllSurfaces, "surfaces"},
    {kBinaryCase, ".lumen"},
    {kJsonCase, ".lumen.json"},
    {kGltf, "glTF (.glb, .gltf)"},
    {kStl, "STL"},
    {kOtherMesh, "meshes but glTF and STL"},
    {kTree, "centerlines"},
    {kCells, "volume meshes (.vtu)"},
};

std::string namesIn(ContentMask mask, const std::vector<NamedContent>& names) {
  std::vector<std::string> found;
  for (const auto& [set, name] : names) {
    if ((mask & set) != set) continue;
    found.emplace_back(name);
    mask &= ~set;
  }
  return alternatives(found);
}

bool isMet(const OptionTable& table, const OptionNeed& need) {
  const OptionRow* const row = table.find(need.option);
  if (row == nullptr || !row->isOn()) return false;
  const std::vector<std::string>& given = row->givenValues;
  return need.word.empty() || std::find(given.begin(), given.end(), need.word) != given.end();
}

/// The reason why an option would do nothing, as the end of a sentence; empty if it counts.
std::string unusedReason(const OptionTable& table, const OptionRow& row,
                         const FileContents& contents) {
  if ((row.inputs & contents.input) == 0)
    return "is for " + namesIn(row.inputs, kInputNames) + ", and " +
           formats::printable(contents.inputName) + " is none of these";
  if ((row.outputs & contents.output) == 0)
    return "is for writing " + namesIn(row.outputs, kOutputNames) + ", and " +
           formats::printable(contents.outputName) + " is none of these";
  for (const std::string& other : row.unusedWith)
    if (const OptionRow* const found = table.find(other); found != nullptr && found->isOn())
      return "does nothing with " + found->shownName();
  if (std::string reason = missingNeed(table, row.needs); !reason.empty()) return reason;
  return row.unused ? row.unused() : std::string();
}

}  // namespace

ContentMask inputContent(const FileFormat& format, bool holdsLabels) {
  switch (format.kind) {
    case FormatKind::Volume:
      if (format.endings.empty()) return holdsLabels ? kDicomLabels : kDicomImage;
      return holdsLabels ? kFileLabels : kFileImage;
    case FormatKind::Mesh:
      return format.readScene != nullptr ? kScene : kPlainMesh;
    case FormatKind::Centerline:
      return kCenterline;
    case FormatKind::VolumeMesh:
    case FormatKind::Case:
      break;
  }
  return kFittedCase;
}

ContentMask outputContent(const FileFormat& format) {
  if (format.kind == FormatKind::Centerline) return kTree;
  if (format.kind == FormatKind::VolumeMesh) return kCells;
  if (format.kind == FormatKind::Case) return format.name == "lumen" ? kBinaryCase : kJsonCase;
  if (format.name == "glb" || format.name == "gltf") return kGltf;
  return format.name == "stl" ? kStl : kOtherMesh;
}

std::string missingNeed(const OptionTable& table, const std::vector<OptionNeed>& needs) {
  std::vector<std::string> names;
  for (const OptionNeed& need : needs) {
    if (isMet(table, need)) return {};
    names.push_back("--" + need.option + (need.word.empty() ? "" : " " + need.word));
  }
  return names.empty() ? "" : "does nothing without " + alternatives(names);
}

void refuseUnused(const OptionRow& row, const std::string& reason, Progress& progress) {
  if (!row.isPreference) throw Error(ErrorKind::Usage, row.shownName() + " " + reason);
  warn(progress, {WarningCode::OptionUnused,
                  row.shownName() + " of the configuration file is left out: it " + reason});
}

void requireCompatible(const OptionTable& table) {
  for (const OptionRow& row : table.rows())
    for (const std::string& other : row.excludes)
      if (const OptionRow* found = table.find(other); row.isGiven && found && found->isGiven)
        throw Error(ErrorKind::Usage,
                    row.shownName() + " and " + found->shownName() + " exclude one another");
}

void requireInScope(const OptionTable& table, const FileContents& contents, Progress& progress) {
  std::vector<const OptionRow*> used;
  for (const OptionRow& row : table.rows()) {
    if (!row.isGiven || row.isArgument) continue;
    const std::string reason = unusedReason(table, row, contents);
    if (reason.empty())
      used.push_back(&row);
    else
      refuseUnused(row, reason, progress);
  }
  if (contents.isAllRead) return;
  for (const OptionRow* const row : used) lookAtFiles(*row);
}

}  // namespace lumen::engine
