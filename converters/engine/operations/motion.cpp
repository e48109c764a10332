// SPDX-License-Identifier: Apache-2.0
// lumen motion: one case with the motion of its nodes through a series of volumes.
#include <string>
#include <utility>
#include <vector>

#include "converters/base/options/option_name.h"
#include "converters/base/options/parsed_number.h"
#include "converters/engine/answers/motion_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/moved.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

/// Seconds of phases that lie evenly in a cycle.
std::vector<double> evenTimes(double period, std::size_t count) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i)
    times.push_back(period * static_cast<double>(i) / static_cast<double>(count));
  return times;
}

/// Seconds of as many phases, as --times states them.
std::vector<double> parseTimes(const std::vector<std::string>& texts, std::size_t count) {
  std::vector<double> times;
  for (const std::string& text : texts) {
    const auto time = parsedNumber(text);
    if (!time || (!times.empty() && *time <= times.back()))
      throw Error(ErrorKind::Usage, kOption.times.shown() + ": found '" + formats::printable(text) +
                                        "', expected seconds that ascend, such as 0,0.1,0.25");
    times.push_back(*time);
  }
  if (times.size() != count)
    throw Error(ErrorKind::Usage,
                kOption.times.shown() + ": found " + counted(times.size(), "time", "times") +
                    " for " + counted(count, "volume", "volumes") + ", expected one for each");
  return times;
}

class MotionCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "motion"; }
  [[nodiscard]] std::string summary() const override {
    return "Follow the vessels of a case through the phases of a heartbeat or a breath";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen motion rest.lumen phase-*.nrrd --out beating.lumen --period 0.8\n"
           "  lumen motion rest.lumen in.nrrd out.nrrd --out breath.lumen --times 0,1.5";
  }

  void addRows(OptionTable& table) override {
    table.argument("REST", &m_rest, "Case of the vessels at rest");
    table
        .argument("PHASE", &m_phases,
                  "Volumes of the phases in the order of time, in the frame of the case")
        .many();
    table
        .file("out", m_output,
              "Case to write, " + formatEndings(canWriteCase) + ": that at rest, with its motion")
        .isRequired = true;
    table
        .add(kOption.period.name, &m_period, "S",
             "Seconds of a cycle, over which the phases lie evenly from 0 on")
        .in(NumberRange{1e-3, 1e6})
        .notBeside(kOption.times.name);
    table
        .add(kOption.times.name, &m_times, "LIST",
             "Seconds of the phases, ascending, with commas between them: a motion that does not "
             "come back")
        .many()
        .delimiter = ',';
    table
        .add(kOption.frames.name, &m_frames, "N",
             "Take the first N volumes of one PHASE that holds several, such as a 4-D NIfTI")
        .in(WholeRange{1, 4096})
        .notBeside(kOption.volumeIndex.name);
    table
        .add("reach", &m_reach, "MM",
             "Longest displacement of a vessel from one phase to the next along each axis")
        .in(NumberRange{0.1, 100});
    addFormatRow(table, "from", m_from, "the phases");
    addVolumeRows(table, m_volume);
  }

  Answer run(const RunContext& context) override {
    requireInScope(*context.table, {}, context.progress);
    const FileFormat& to = caseOutputFormat(m_output, "", "the motion");
    requireInput(m_rest, "case file");
    for (const InputFile& file : m_phases) requireInput(file, "volume");
    if (m_frames > 0 && m_phases.size() != 1)
      throw Error(ErrorKind::Usage, kOption.frames.shown() + ": found " +
                                        counted(m_phases.size(), "file", "files") +
                                        " of phases beside it, expected one that holds them all");
    const operations::PhaseSeries series = phases(context);
    requireWritable(m_output, convert::ContentKind::Case);
    for (std::size_t phase = 0; phase < series.times.size(); ++phase) lookAtPhase(phase);

    const operations::MovedCase moved =
        operations::moved(readParentCase(m_rest), m_rest.name(), series, operationContext(context));
    to.writeCase(moved.value, m_output, {}, context.progress);
    Json json = caseSummary(moved.value);
    json["period_s"] = jsonNumber(moved.value.motion->period);
    json["phases"] = phasesJson(moved);
    return {std::move(json),
            phaseLines(moved, phaseNames()) + caseLine(m_output.name(), moved.value)};
  }

private:
  [[nodiscard]] const InputFile& fileOf(std::size_t phase) const {
    return m_phases[m_frames > 0 ? 0 : phase];
  }

  [[nodiscard]] std::vector<std::string> phaseNames() const {
    std::vector<std::string> names;
    if (m_frames == 0)
      for (const InputFile& file : m_phases) names.push_back(file.name());
    for (std::int64_t i = 0; i < m_frames; ++i)
      names.push_back(m_phases.front().name() + ", volume " + std::to_string(i));
    return names;
  }

  [[nodiscard]] operations::PhaseSeries phases(const RunContext& context) const {
    const std::size_t count = m_frames > 0 ? static_cast<std::size_t>(m_frames) : m_phases.size();
    operations::PhaseSeries series;
    series.times = m_times.empty() ? evenTimes(m_period, count) : parseTimes(m_times, count);
    series.period = m_times.empty() ? m_period : 0.0;
    series.reach = m_reach;
    series.name = [this](std::size_t phase) { return fileOf(phase).name(); };
    series.read = [this, &progress = context.progress](std::size_t phase) {
      return loadVolume(fileOf(phase), formatOf(phase), argumentsOf(phase), progress);
    };
    return series;
  }

  [[nodiscard]] const FileFormat& formatOf(std::size_t phase) const {
    const FileFormat& from = inputFormat(fileOf(phase), m_from);
    if (from.kind != FormatKind::Volume)
      throw unsupported(fileOf(phase).name() + ": this is no volume; expected one for each phase");
    return from;
  }

  [[nodiscard]] VolumeArguments argumentsOf(std::size_t phase) const {
    VolumeArguments which = m_volume;
    if (m_frames > 0) which.volumeIndex = static_cast<std::int64_t>(phase);
    return which;
  }

  /// Refuses a phase whose header cannot be read before the first one is followed.
  void lookAtPhase(std::size_t phase) const {
    Progress silent;
    loadVolumeHeader(fileOf(phase), formatOf(phase), argumentsOf(phase), silent);
  }

  InputFile m_rest;
  std::vector<InputFile> m_phases;
  OutputFile m_output;
  std::string m_from;
  std::vector<std::string> m_times;
  std::int64_t m_frames = 0;
  double m_period = 1;
  VolumeArguments m_volume;
  double m_reach = operations::PhaseSeries{}.reach;
};

}  // namespace

std::unique_ptr<Command> makeMotionCommand() {
  return std::make_unique<MotionCommand>();
}

}  // namespace lumen::engine
