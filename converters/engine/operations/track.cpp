// SPDX-License-Identifier: Apache-2.0
// lumen track: a volume and seeds to a tree with wall points.
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/answers/label_answer.h"
#include "converters/engine/answers/native_answer.h"
#include "converters/engine/answers/track_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/case_of.h"

namespace lumen::engine {

namespace {

class TrackCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "track"; }
  [[nodiscard]] std::string summary() const override {
    return "Track vessels through a volume: a case with its tree and wall points";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen track head.nrrd head.lumen --seeds head-seeds.json --inlier-rate 0.6";
  }

  void addRows(OptionTable& table) override {
    table.argument("VOLUME", &m_input, formatTitles(canReadVolume));
    table.argument("OUT", &m_output, "Case to write, " + formatEndings(canWriteCase));
    addVolumeRows(table, m_volume);
    addNativeRow(table, m_native);
    addTrackRows(table, m_track);
    addLabelMapRows(table, m_labels);
    table.find("label-table")->onlyWith("label-map");
    addFormatRow(table, "from", m_from, "VOLUME");
    addFormatRow(table, "to", m_to, "OUT");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "the tracked tree");
    requireInput(m_input, "volume");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind != FormatKind::Volume) {
      const std::string other = convert::notA(convert::ContentKind::Volume, m_input);
      throw unsupported(m_input.name() + ": " +
                        (other.empty() ? "this is not a volume, which lumen track reads" : other));
    }
    requireInScope(*context.table,
                   {inputContent(from, false), outputContent(to), m_input.name(), m_output.name()},
                   context.progress);
    operations::CaseOptions options;
    options.vessels = m_track.vessels();
    if (!m_track.seeds.empty()) options.vessels.seeds = loadSeeds(m_track);
    options.repeats = m_track.repeats;
    options.isOnlyLabelled = m_labels.isOnlyLabelled;
    requireWritable(m_output, convert::ContentKind::Case);

    operations::Source source;
    source.name = m_input.name();
    source.grey = loadVolume(m_input, from, m_volume, context.progress);
    source.native = loadNative(m_native, context.progress);
    source.maps = loadLabelMaps(m_labels, &source.grey->geometry, context.progress);
    const operations::MadeCase made =
        operations::caseOf(std::move(source), options, operationContext(context));
    to.writeCase(made.value, m_output, {}, context.progress);
    Json json = caseSummary(made.value);
    json["reachable"] = reachJson(std::nullopt);
    json["repeats"] = repetitionJson(made.repetition, made.value);
    json["label_maps"] = inventoryJson(made.labels);
    json["unlabelled"] = unlabelledJson(made.labels);
    json["native"] = nativeJson(made.native);
    return {withRemarks(std::move(json), made.remarks),
            caseLine(m_output.name(), made.value) + convert::reachLine(std::nullopt) +
                repetitionLines(made.repetition) + inventoryLines(made.labels) +
                nativeLines(made.native) + endLines(made.remarks)};
  }

private:
  InputFile m_input;
  InputFile m_native;
  OutputFile m_output;
  std::string m_from, m_to;
  VolumeArguments m_volume;
  TrackArguments m_track;
  MaskArguments m_labels;
};

}  // namespace

std::unique_ptr<Command> makeTrackCommand() {
  return std::make_unique<TrackCommand>();
}

}  // namespace lumen::engine
