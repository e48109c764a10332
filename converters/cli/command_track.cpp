// SPDX-License-Identifier: Apache-2.0
// lumen track: a volume and seeds to a tree with wall points.
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/file_access.h"
#include "converters/engine/reachable.h"
#include "converters/engine/report.h"
#include "converters/engine/stages.h"
#include "converters/engine/track_report.h"

namespace lumen::app {

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

  void bind(CLI::App& app) override {
    addFile(app, "VOLUME", m_input, formatTitles(canReadVolume));
    addFile(app, "OUT", m_output, "Case to write, " + formatEndings(canWriteCase));
    addVolumeOptions(app, m_volume);
    addTrackOptions(app, m_track);
    app.add_option("--from", m_from, "Format of VOLUME, whatever its name")->type_name("F");
    app.add_option("--to", m_to, "Format of OUT, whatever its name")->type_name("F");
  }

  int run(Context& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "what lumen track makes");
    requireInput(m_input, "volume");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind != FormatKind::Volume) {
      const std::string other = notA(ContentKind::Volume, m_input);
      throw unsupported(m_input + ": " +
                        (other.empty() ? "this is not a volume, which lumen track reads" : other));
    }
    const auto seeds = loadSeeds(m_track);
    requireWritable(m_output, ContentKind::Case);
    context.interrupts.watchOutput(m_output);

    const convert::Volume volume = loadVolume(m_input, from, m_volume, context.progress);
    const convert::TrackResult tracked = trackSeeds(volume, seeds, m_track, context.progress);
    to.writeCase(tracked.result, m_output, {}, context.progress);
    report(tracked, context);
    return 0;
  }

private:
  void report(const convert::TrackResult& tracked, const Context& context) const {
    if (context.common.json) {
      Json json = caseSummary(tracked.result);
      json["reachable"] = reachJson(std::nullopt);
      answerJson(withRemarks(std::move(json), tracked));
    } else if (!context.common.quiet) {
      answer(caseLine(m_output, tracked.result) + reachLine(std::nullopt) + endLines(tracked));
    }
  }

  std::string m_input, m_output, m_from, m_to;
  VolumeArguments m_volume;
  TrackArguments m_track;
};

}  // namespace

std::unique_ptr<Command> makeTrackCommand() {
  return std::make_unique<TrackCommand>();
}

}  // namespace lumen::app
