// SPDX-License-Identifier: Apache-2.0
// lumen info: what is in a case, a volume, a mesh or a centerline.
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/case_info_report.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/chunk_info.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mesh_info.h"
#include "converters/engine/report.h"
#include "converters/engine/stages.h"
#include "converters/engine/volume_info.h"

namespace lumen::app {

namespace {

class InfoCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "info"; }
  [[nodiscard]] std::string summary() const override {
    return "Tell what a case, a volume, a mesh or a centerline holds";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen info head.lumen --json | jq .radius_mm";
  }

  void bind(CLI::App& app) override {
    addFile(app, "FILE", m_input, "Case, volume, mesh or centerline");
    app.add_option("--from", m_from, "Format of FILE, whatever its name")->type_name("F");
    app.add_flag("--chunks", m_chunks, "List the chunks of a .lumen file instead");
    app.add_flag("--voxels", m_voxels,
                 "Read the voxels of a volume too, not its header only: range and digest");
    addVolumeOptions(app, m_volume);
    addCenterlineOptions(app, m_centerline);
  }

  int run(Context& context) override {
    requireInput(m_input, "case, volume, mesh or centerline");
    if (m_chunks) {
      const FileInfo info = describeChunks(m_input);
      context.common.json ? answerJson(chunkInfoJson(info)) : answer(chunkInfoText(info));
      return 0;
    }
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind == FormatKind::Volume) {
      const VolumeInfo info = describe(from, context.progress);
      context.common.json ? answerJson(volumeInfoJson(info)) : answer(volumeInfoText(info));
    } else if (from.kind == FormatKind::Mesh) {
      const MeshInfo info =
          describeMesh(from.readMesh(m_input), m_input, m_volume.unit, context.progress);
      context.common.json ? answerJson(meshInfoJson(info)) : answer(meshInfoText(info));
    } else if (from.kind == FormatKind::Centerline) {
      const LoadedCenterline loaded =
          loadCenterline(m_input, from, m_volume, m_centerline, context.progress);
      context.common.json ? answerJson(centerlineInfoJson(loaded))
                          : answer(centerlineInfoText(loaded));
    } else {
      const formats::Case value = from.readCase(m_input);
      const CaseInfo info = describeCase(value, context.progress);
      context.common.json ? answerJson(caseInfoJson(info)) : answer(caseInfoText(info));
    }
    return 0;
  }

private:
  [[nodiscard]] VolumeInfo describe(const FileFormat& from, Progress& progress) const {
    if (!m_voxels) return {loadVolumeHeader(m_input, from, m_volume, progress), {}};
    const convert::Volume volume = loadVolume(m_input, from, m_volume, progress);
    return describeVolume(from.readVolumeHeader(m_input, m_volume.options(), progress), volume,
                          progress);
  }

  std::string m_input, m_from;
  bool m_chunks = false;
  bool m_voxels = false;
  VolumeArguments m_volume;
  CenterlineArguments m_centerline;
};

}  // namespace

std::unique_ptr<Command> makeInfoCommand() {
  return std::make_unique<InfoCommand>();
}

}  // namespace lumen::app
