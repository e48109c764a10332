// SPDX-License-Identifier: Apache-2.0
// lumen convert: a volume, tracked and fitted, a centerline, fitted, or a case, as a case, a mesh
// or a centerline.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/answers/ends_answer.h"
#include "converters/engine/answers/label_answer.h"
#include "converters/engine/answers/native_answer.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/answers/track_answer.h"
#include "converters/engine/answers/volume_mesh_answer.h"
#include "converters/engine/convert_options.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/source_input.h"
#include "converters/engine/tracking_input.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/operations/case_of.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

Json replayedJson(const std::optional<convert::ReplayedEdits>& replayed) {
  if (!replayed) return nullptr;
  Json left = Json::array();
  for (const convert::LeftEdit& one : replayed->left)
    left.push_back({{"sentence", one.sentence}, {"why", one.why}});
  return {{"made", replayed->made}, {"left", std::move(left)}};
}

std::string replayedLine(const std::optional<convert::ReplayedEdits>& replayed) {
  if (!replayed) return {};
  return counted(replayed->made.size(), "correction", "corrections") + " made again, " +
         std::to_string(replayed->left.size()) + " left\n";
}

class ConvertCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "convert"; }
  [[nodiscard]] std::string summary() const override {
    return "Turn a volume, a surface, or a case, into a case or a mesh";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen convert head.nrrd head.lumen --seeds head-seeds.json\n"
           "  lumen convert head.lumen head.glb --colour radius\n"
           "  lumen convert head.lumen head.vtu --layers 5 --growth 1.2\n"
           "  lumen convert aorta.stl aorta.lumen --centerline aorta-centerline.vtp\n"
           "  lumen convert labels.nii.gz arteries.lumen --labels 1=ica,2=mca\n"
           "  lumen convert arteries.swc arteries.lumen\n"
           "  lumen convert heart.lumen systole.lumen --time 0.3";
  }

  void addRows(OptionTable& table) override {
    table.argument("INPUT", &m_input,
                   "Volume (" + formatTitles(canReadVolume) + "), surface of vessels (" +
                       formatTitles(canReadMesh) + "), centerline (" +
                       formatTitles(canReadCenterline) +
                       "; also a folder of curves or tables, or of a project) or case");
    table.argument("OUTPUT", &m_output,
                   "Case, " + formatEndings(canWriteCase) +
                       "; or mesh, which holds the surface of the " + "vessels and no more, " +
                       formatEndings(canWriteMesh) + "; or volume mesh, " +
                       formatEndings(canWriteVolumeMesh) +
                       "; or centerline, which holds the tree and its radii and no more, so no "
                       "models are fitted, " +
                       formatEndings(canWriteCenterline));
    addFormatRow(table, "from", m_from, "INPUT");
    addFormatRow(table, "to", m_to, "OUTPUT");
    m_options.addRows(table);
    addTimeRow(table, m_time).forInputs(kCases).inGroup("");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = outputFormat(m_output, m_to);
    requireInput(m_input, "input");
    const FileFormat& from = inputFormat(m_input, m_from);
    FileContents contents{inputContent(from, m_options.source.mask.isGiven()), outputContent(to),
                          m_input.name(), m_output.name()};
    const bool isCase = from.kind == FormatKind::Case;
    if (!isCase) requireInScope(*context.table, contents, context.progress);
    operations::CaseOptions options = caseOptions(from);
    requireWritable(m_output, contentKind(to));

    operations::Source source =
        isCase ? loadCase(from, to, contents, context) : loadNew(from, options, contents, context);
    const bool showsModels = (contents.output & kModelled) != 0;
    if (showsModels && (!isCase || contents.input == kUnfittedCase))
      options.models = m_options.modelOptions(source, *context.table, context.progress);
    const operations::MadeCase made =
        operations::caseOf(std::move(source), options, operationContext(context));
    context.progress.check();
    const std::optional<convert::Reach> reach = convert::measureReach(made.value, context.progress);
    convert::warnOfClosed(reach, context.progress);
    return report(made, reach,
                  to.writeCase(made.value, m_output, m_options.output, context.progress));
  }

private:
  [[nodiscard]] operations::CaseOptions caseOptions(const FileFormat& from) const {
    operations::CaseOptions options = m_options.caseOptions(from.kind);
    if (from.kind == FormatKind::Volume && !m_options.track.seeds.empty())
      options.vessels.seeds = loadSeeds(m_options.track);
    const InputFile& corrected = m_options.corrected;
    if (corrected.empty()) return options;
    requireInput(corrected, "corrected case");
    options.corrected = operations::CorrectedCase{readCase(corrected), corrected.name()};
    return options;
  }

  /// A case is made of this source. A volume may turn out to hold labels.
  operations::Source loadNew(const FileFormat& from, const operations::CaseOptions& options,
                             FileContents& contents, const RunContext& context) {
    operations::Source source = loadSource(m_input, from, m_options.source,
                                           !options.vessels.seeds.empty(), context.progress);
    if (source.labels && !m_options.source.mask.isGiven()) {
      contents.input = inputContent(from, true);
      requireInScope(*context.table, contents, context.progress);
    }
    m_options.takeCellsOf(source);
    return source;
  }

  /// The case of the input, which gets models if it has none and a mesh needs them.
  operations::Source loadCase(const FileFormat& from, const FileFormat& to, FileContents& contents,
                              const RunContext& context) const {
    // rounding and motion make another case; another encoding does not
    const bool isOther = m_time || m_options.output.encoding.pointBits != 0;
    operations::Source source;
    source.name = m_input.name();
    source.value = atTime(isOther ? readParentCase(m_input) : from.readCase(m_input), m_time,
                          m_input.name(), *context.table, context.progress);
    requireContent(*source.value, context);
    if (needsModels(to) && !source.value->models) {
      if (!source.value->points)
        throw invalidInput(m_input.name() +
                           ": this case has neither models nor wall points to fit them to, "
                           "so there is no surface to make a mesh of");
      contents.input = kUnfittedCase;
    }
    requireInScope(*context.table, contents, context.progress);
    return source;
  }

  /// Refuses to round wall points, and to leave out a motion, that a case does not have.
  void requireContent(const formats::Case& value, const RunContext& context) const {
    const std::string none = ", and " + formats::printable(m_input.name()) + " has none";
    const OptionRow& bits = *context.table->find("point-bits");
    if (bits.isGiven && (!value.points || value.points->position.empty()))
      refuseUnused(bits, "is for cases with wall points" + none, context.progress);
    const OptionRow& skin = *context.table->find("skin");
    if (skin.isGiven && !value.motion)
      refuseUnused(skin, "is for cases with a motion" + none, context.progress);
  }

  [[nodiscard]] Answer report(const operations::MadeCase& made,
                              const std::optional<convert::Reach>& reach,
                              const MeshReports& meshes) const {
    Json json = caseSummary(made.value);
    json["reachable"] = reachJson(reach);
    const std::vector<operations::OpenEnd> ends = operations::endsOf(made.value);
    json["inlets"] = inletsJson(ends, made.value.tree);
    json["surface"] = surfaceJson(meshes.surface, made.value);
    json["volume_mesh"] = volumeMeshJson(meshes.cells);
    json["mesh"] = frameJson(made.meshFrame);
    json["centerline"] = frameJson(made.centerlineFrame);
    json["repeats"] = repetitionJson(made.repetition, made.value);
    json["corrections"] = replayedJson(made.replayed);
    json["label_maps"] = inventoryJson(made.labels);
    json["unlabelled"] = unlabelledJson(made.labels);
    json["native"] = nativeJson(made.native);
    return {withRemarks(std::move(json), made.remarks),
            caseLine(m_output.name(), made.value) + replayedLine(made.replayed) +
                frameLine("mesh", made.meshFrame) + frameLine("centerline", made.centerlineFrame) +
                (reach ? convert::reachLine(reach) : "") +
                "inlets: " + inletsText(ends, made.value.tree) + "\n" +
                surfaceLines(meshes.surface, made.value) + volumeMeshLines(meshes.cells) +
                repetitionLines(made.repetition) + inventoryLines(made.labels) +
                nativeLines(made.native) + endLines(made.remarks)};
  }

  InputFile m_input;
  OutputFile m_output;
  std::string m_from, m_to;
  ConvertOptions m_options;
  std::optional<double> m_time;
};

}  // namespace

std::unique_ptr<Command> makeConvertCommand() {
  return std::make_unique<ConvertCommand>();
}

}  // namespace lumen::engine
