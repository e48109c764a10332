// SPDX-License-Identifier: Apache-2.0
// lumen info: the facts of a case, a volume, a mesh or a centerline.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_lines.h"
#include "converters/base/shown_text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/answers/chunk_info.h"
#include "converters/engine/answers/ends_answer.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/answers/volume_info.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_info.h"
#include "converters/engine/next_step.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/content/file_content.h"
#include "converters/io/seeds/seeds.h"
#include "converters/operations/surface_of.h"
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
    return "  lumen info head.lumen --json | jq .radius_mm\n"
           "  lumen info head.lumen --accept 'looked at: a vein beside it' --out head.lumen";
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
    table
        .add("accept", &m_accept, "REASON",
             "Record in the case why places where its lumen runs into itself may stay cut. No "
             "answer warns of them again until the case changes")
        .forInputs(kFittedCase)
        .onlyWith("out");
    table
        .file("out", m_output,
              "Case to write with that reason, " + formatEndings(canWriteCase) + "; may be FILE")
        .forInputs(kFittedCase)
        .onlyWith("accept");
    addFormatRow(table, "to", m_to, "--out");
    table.find("to")->forInputs(kFittedCase).onlyWith("out");
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
      return volumeAnswer(describeFolder(context.progress), context);
    }
    if (std::optional<Answer> other = otherThanInputs(context)) return *std::move(other);
    const FileFormat& from = inputFormat(m_input, m_from);
    requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input.name(), {}},
                   context.progress);
    if (from.kind == FormatKind::Volume)
      return volumeAnswer(describe(from, context.progress), context);
    if (from.kind == FormatKind::Mesh) {
      const MeshInfo info =
          describeMesh(readMesh(from), m_input.name(), m_volume.unit, context.progress);
      return withNext({meshInfoJson(info), meshInfoText(info), 0, true},
                      {info.file.notes, "a case, along the middle of the surface",
                       convertCommand(*context.table, m_input.name(), stem())},
                      kColumn);
    }
    if (from.kind == FormatKind::Centerline) {
      const LoadedCenterline loaded =
          loadCenterline(m_input, from, m_volume, m_frame, context.progress);
      return withNext({centerlineInfoJson(loaded), centerlineInfoText(loaded), 0, true},
                      nextOf(loaded, *context.table), kNarrowColumn);
    }
    return describeWithSurface(m_output.empty() ? from.readCase(m_input) : accepting(context),
                               context);
  }

private:
  /// The name of the input without its folder and its ending.
  [[nodiscard]] std::string stem() const {
    const std::string name =
        std::filesystem::path(m_input.name()).lexically_normal().filename().string();
    const std::size_t longest = longestEnding(name);
    return name.size() > longest && longest > 0 ? name.substr(0, name.size() - longest) : name;
  }

  [[nodiscard]] Answer volumeAnswer(const VolumeInfo& info, const RunContext& context) const {
    const bool holdsLabels = info.values && !info.values->labels.empty();
    return withNext({volumeInfoJson(info), volumeInfoText(info), 0, true},
                    {info.header.assumptions,
                     holdsLabels   ? "a case of the vessels that its labels mark"
                     : info.values ? "a case of the vessels that lumen finds in it"
                                   : "a case of the vessels in it; of a label map, of its labels",
                     convertCommand(*context.table, m_input.name(), stem())},
                    kNarrowColumn);
  }

  [[nodiscard]] NextStep nextOf(const LoadedCenterline& loaded, const OptionTable& table) const {
    if (convert::measureExtent(loaded.file).most > 0)
      return {loaded.file.remarks, "a case of its points and radii",
              convertCommand(table, m_input.name(), stem())};
    return {loaded.file.remarks, "a case of the surface that it lies in, as it has no radii",
            "lumen convert SURFACE.stl " + convert::shellWord(stem() + ".lumen") +
                " --centerline " + convert::shellWord(m_input.name())};
  }

  /// The answer about seeds, which are no input of their own; refuses a library of cases.
  [[nodiscard]] std::optional<Answer> otherThanInputs(const RunContext& context) const {
    std::error_code ignored;
    if (m_input.isFolder()) {
      if (m_input.isInMemory() ||
          !std::filesystem::exists(m_input.path() / "library.json", ignored))
        return {};
      throw unsupported(formats::printable(m_input.name()) +
                        ": this is a library of cases; lumen library verify " +
                        convert::shellWord(m_input.name()) +
                        " checks it, and lumen info describes each of the .lumen files in it");
    }
    if (!m_from.empty() || convert::detectContent(m_input).kind != convert::ContentKind::Seeds)
      return {};
    const std::vector<convert::SeedBranch> seeds = convert::readSeeds(m_input);
    if (m_input.name().ends_with(".mrk.json") && mayBeCenterline(seeds)) return {};
    constexpr ContentMask kNothing = 0;
    requireInScope(*context.table, {kNothing, kAnyContent, m_input.name(), {}}, context.progress);
    return seedsAnswer(seeds);
  }

  [[nodiscard]] static bool mayBeCenterline(const std::vector<convert::SeedBranch>& seeds) {
    return std::any_of(seeds.begin(), seeds.end(), [](const convert::SeedBranch& seed) {
      return seed.points.size() > 1 && seed.points.front().radius.has_value();
    });
  }

  [[nodiscard]] Answer seedsAnswer(const std::vector<convert::SeedBranch>& seeds) const {
    std::size_t points = 0, aneurysms = 0;
    for (const convert::SeedBranch& seed : seeds) {
      points += seed.points.size();
      aneurysms += seed.kind == formats::BranchKind::Aneurysm ? 1 : 0;
    }
    Lines lines(kNarrowColumn);
    lines.add("seeds", counted(seeds.size() - aneurysms, "vessel", "vessels") + ", " +
                           counted(aneurysms, "aneurysm", "aneurysms"));
    lines.add("points", std::to_string(points));
    const Json json = {
        {"vessels", seeds.size() - aneurysms}, {"aneurysms", aneurysms}, {"points", points}};
    return withNext({json, lines.text(), 0, true},
                    {{},
                     "a case of the vessels that begin at these places of a volume",
                     "lumen track VOLUME.nrrd " + convert::shellWord(stem() + ".lumen") +
                         " --seeds " + convert::shellWord(m_input.name())},
                    kNarrowColumn);
  }

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

  /// The case with the accepted places, which is written.
  [[nodiscard]] formats::Case accepting(const RunContext& context) const {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "the case with accepted places");
    requireWritable(m_output, convert::ContentKind::Case);
    formats::Case value = readParentCase(m_input);
    operations::acceptContacts(value.metadata, m_accept);
    to.writeCase(value, m_output, {}, context.progress);
    return value;
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
    const std::vector<operations::OpenEnd> ends = operations::endsOf(value);
    Json json = caseInfoJson(info);
    json["inlets"] = inletsJson(ends, value.tree);
    json["surface"] = surfaceJson(found.report, value);
    json["surface_warnings"] = Json::array();
    json["surface_findings"] = warningsJson(found.warnings);
    const std::optional<std::string> accepted = operations::acceptedContacts(value.metadata);
    json["contacts_accepted"] = accepted ? Json(*accepted) : Json(nullptr);
    std::string text =
        caseInfoText(info, inletsText(ends, value.tree)) + surfaceLines(found.report, value);
    for (const Warning& warning : found.warnings) {
      json["surface_warnings"].push_back(warningText(warning));
      text += "warning      " + warningText(warning) + "\n";
    }
    if (accepted)
      text +=
          "accepted     that its lumen runs into itself: " + formats::printable(*accepted) + "\n";
    const std::string name = convert::shellWord(m_input.name());
    return withNext(
        {std::move(json), std::move(text), 0, m_output.empty()},
        value.models
            ? NextStep{recordedAssumptions(value.metadata),
                       "the closed surface of its vessels, as a mesh",
                       "lumen convert " + name + " " + convert::shellWord(stem() + ".glb")}
            : NextStep{recordedAssumptions(value.metadata), "models of its vessels",
                       "lumen fit " + name + " " + convert::shellWord(stem() + "-fitted.lumen")},
        kColumn);
  }

  InputFile m_input;
  std::string m_from;
  bool m_chunks = false;
  bool m_voxels = false;
  bool m_surface = false;
  VolumeArguments m_volume;
  std::string m_frame;
  MaskArguments m_labels;
  std::string m_accept, m_to;
  OutputFile m_output;
};

}  // namespace

std::unique_ptr<Command> makeInfoCommand() {
  return std::make_unique<InfoCommand>();
}

}  // namespace lumen::engine
