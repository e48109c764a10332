// SPDX-License-Identifier: Apache-2.0
// lumen info: the facts of a case, a volume, a mesh or a centerline.
#include <string>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/answers/chunk_info.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/answers/volume_info.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_info.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class InfoCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "info"; }
  [[nodiscard]] std::string summary() const override {
    return "Print the content of a case, a volume, a mesh or a centerline";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen info head.lumen --json | jq .radius_mm";
  }

  void addRows(OptionTable& table) override {
    table.argument("FILE", &m_input, "Case, volume, mesh or centerline");
    addFormatRow(table, "from", m_from, "FILE");
    table.flag("chunks", m_chunks, "List the chunks of a .lumen file instead");
    table
        .flag("voxels", m_voxels,
              "Read the voxels of a volume too, not its header only: range and digest")
        .forInputs(kVolumes);
    table
        .flag(
            "surface", m_surface,
            "Also make the closed surface that lumen convert makes of a case: its triangles, ends "
            "and overlaps, and its warnings. It takes as long as the mesh: seconds for most cases")
        .forInputs(kFittedCase);
    addVolumeRows(table, m_volume);
    addFrameRow(table, m_frame);
    table.group("Labels");
    addLabelTableRows(table, m_labels);
    for (const char* const option : {"label-table", "role"})
      table.find(option)->forInputs(kVolumes).onlyWith("voxels");
    table.group("");
    for (OptionRow& row : table.rows())
      if (!row.isArgument && row.name != "chunks") row.notBeside("chunks");
  }

  Answer run(const RunContext& context) override {
    requireInput(m_input, "case, volume, mesh or centerline");
    if (m_chunks) {
      requireInScope(*context.table, {kFittedCase, kAnyContent, m_input.name(), {}},
                     context.progress);
      const FileInfo info = describeChunks(readCaseBytes(m_input), m_input.name());
      return {chunkInfoJson(info), chunkInfoText(info), 0, true};
    }
    if (m_from.empty() && convert::isLabelFolder(m_input)) {
      requireInScope(*context.table, {kFileLabels, kAnyContent, m_input.name(), {}},
                     context.progress);
      const VolumeInfo info = describeFolder(context.progress);
      return {volumeInfoJson(info), volumeInfoText(info), 0, true};
    }
    const FileFormat& from = inputFormat(m_input, m_from);
    requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input.name(), {}},
                   context.progress);
    if (from.kind == FormatKind::Volume) {
      const VolumeInfo info = describe(from, context.progress);
      return {volumeInfoJson(info), volumeInfoText(info), 0, true};
    }
    if (from.kind == FormatKind::Mesh) {
      const MeshInfo info =
          describeMesh(readMesh(from), m_input.name(), m_volume.unit, context.progress);
      return {meshInfoJson(info), meshInfoText(info), 0, true};
    }
    if (from.kind == FormatKind::Centerline) {
      const LoadedCenterline loaded =
          loadCenterline(m_input, from, m_volume, m_frame, context.progress);
      return {centerlineInfoJson(loaded), centerlineInfoText(loaded), 0, true};
    }
    return describeWithSurface(from.readCase(m_input), context);
  }

private:
  [[nodiscard]] convert::MeshFile readMesh(const FileFormat& from) const {
    convert::MeshFile file = from.readScene != nullptr
                                 ? from.readScene(m_input, {{}, m_volume.allowDetached})
                                 : from.readMesh(m_input);
    stateAxes(file, m_frame);
    return file;
  }

  [[nodiscard]] VolumeInfo describe(const FileFormat& from, Progress& progress) const {
    if (!m_voxels) return {loadVolumeHeader(m_input, from, m_volume, progress), {}};
    convert::Volume volume = loadVolume(m_input, from, m_volume, progress);
    VolumeInfo info = describeVolume(from.readVolumeHeader(m_input, m_volume.options(), progress),
                                     volume, progress);
    std::optional<convert::SettledLabels> settled = convert::settleLabels(volume, {});
    if (!convert::holdsLabels(settled ? settled->voxels : volume)) return info;
    if (settled) volume = takeSettled(*std::move(settled), m_input.name(), progress);
    const std::int64_t layer = m_volume.volumeIndex.value_or(0);
    info.values->labels =
        describeLabelled(std::move(volume), m_labels.table(m_input, progress, layer));
    return info;
  }

  [[nodiscard]] VolumeInfo describeFolder(Progress& progress) const {
    if (!m_labels.labelTable.empty()) refuseTableOfFolder();
    convert::FolderMap map = loadLabelFolder(m_input, m_volume.options(), progress);
    VolumeInfo info = describeVolume(map.header, map.voxels, progress);
    info.values->labels = describeLabelled(std::move(map.voxels), map.table);
    return info;
  }

  [[nodiscard]] CountedLabels describeLabelled(convert::Volume volume,
                                               const convert::LabelTable& table) const {
    std::vector<operations::LabelPart> maps;
    maps.push_back(labelPart(std::move(volume), m_input.name(), table));
    stateRoles(m_labels.roles, maps);
    return describeLabels(maps.front());
  }

  [[nodiscard]] Answer describeWithSurface(const formats::Case& value,
                                           const RunContext& context) const {
    if (m_surface && !value.models)
      refuseUnused(
          *context.table->find("surface"),
          "is for cases with models, and " + formats::printable(m_input.name()) + " has none",
          context.progress);
    const convert::CaseInfo info = convert::describeCase(value, context.progress);
    const SurfaceFindings found =
        m_surface ? examineSurface(value, context.progress) : SurfaceFindings{};
    Json json = caseInfoJson(info);
    json["surface"] = surfaceJson(found.report, value);
    json["surface_warnings"] = found.warnings;
    std::string text = caseInfoText(info) + surfaceLines(found.report, value);
    for (const std::string& sentence : found.warnings) text += "warning      " + sentence + "\n";
    return {std::move(json), std::move(text), 0, true};
  }

  InputFile m_input;
  std::string m_from;
  bool m_chunks = false;
  bool m_voxels = false;
  bool m_surface = false;
  VolumeArguments m_volume;
  std::string m_frame;
  MaskArguments m_labels;
};

}  // namespace

std::unique_ptr<Command> makeInfoCommand() {
  return std::make_unique<InfoCommand>();
}

}  // namespace lumen::engine
