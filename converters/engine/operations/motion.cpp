// SPDX-License-Identifier: Apache-2.0
// lumen motion: one case with the motion of its nodes through a series of volumes.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "converters/base/options/option_name.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/stages/fitting/image/fit_to_image.h"
#include "converters/stages/motion/track_motion.h"

namespace lumen::engine {

namespace {

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
        .add("reach", &m_options.reach, "MM",
             "Longest displacement of a vessel from one phase to the next along each axis")
        .in(NumberRange{0.1, 100});
    addFormatRow(table, "from", m_from, "the phases");
    addVolumeRows(table, m_volume);
  }

  Answer run(const RunContext& context) override {
    requireInScope(*context.table, {}, context.progress);
    const FileFormat& to = caseOutputFormat(m_output, "", "the motion");
    requireInput(m_rest, "case file");
    for (const std::string& file : m_phases) requireInput(file, "volume");
    if (m_frames > 0 && m_phases.size() != 1)
      throw Error(ErrorKind::Usage, kOption.frames.shown() + ": found " +
                                        counted(m_phases.size(), "file", "files") +
                                        " of phases beside it, expected one that holds them all");
    const std::vector<double> times = phaseTimes();
    requireWritable(m_output, convert::ContentKind::Case);

    formats::Case value = readParentCase(m_rest);
    const convert::TrackedMotion tracked = track(value, times, context.progress);
    value.motion = tracked.motion;
    value.metadata.steps.push_back({"motion",
                                    "lumen " LUMEN_VERSION,
                                    {{"phases", static_cast<std::int64_t>(times.size())},
                                     {"reach", m_options.reach},
                                     {kOption.dark.name, m_options.dark}}});
    to.writeCase(value, m_output, {}, context.progress);
    return report(value, tracked);
  }

private:
  [[nodiscard]] std::size_t phaseCount() const {
    return m_frames > 0 ? static_cast<std::size_t>(m_frames) : m_phases.size();
  }
  [[nodiscard]] const std::string& fileOf(std::size_t phase) const {
    return m_phases[m_frames > 0 ? 0 : phase];
  }

  [[nodiscard]] std::vector<double> phaseTimes() const {
    const std::size_t count = phaseCount();
    std::vector<double> times;
    if (m_times.empty()) {
      for (std::size_t i = 0; i < count; ++i)
        times.push_back(m_period * static_cast<double>(i) / static_cast<double>(count));
      return times;
    }
    for (const std::string& part : m_times) {
      const auto time = parsedNumber(part);
      if (!time || (!times.empty() && *time <= times.back()))
        throw Error(ErrorKind::Usage, kOption.times.shown() + ": found '" +
                                          formats::printable(part) +
                                          "', expected seconds that ascend, such as 0,0.1,0.25");
      times.push_back(*time);
    }
    if (times.size() != count)
      throw Error(ErrorKind::Usage,
                  kOption.times.shown() + ": found " + counted(times.size(), "time", "times") +
                      " for " + counted(count, "volume", "volumes") + ", expected one for each");
    return times;
  }

  convert::TrackedMotion track(const formats::Case& rest, const std::vector<double>& times,
                               Progress& progress) {
    std::size_t current = 0;
    const auto read = [&](std::size_t phase) {
      current = phase;
      const std::string& file = fileOf(phase);
      const FileFormat& from = inputFormat(file, m_from);
      if (from.kind != FormatKind::Volume)
        throw unsupported(file + ": this is no volume; expected one for each phase");
      VolumeArguments which = m_volume;
      if (m_frames > 0) which.volumeIndex = static_cast<std::int64_t>(phase);
      convert::Volume volume = loadVolume(file, from, which, progress);
      if (phase == 0) m_options.dark = convert::recordedImageFit(rest, volume).dark;
      return volume;
    };
    try {
      return convert::trackMotion(rest, times, m_times.empty() ? m_period : 0.0, read, m_options,
                                  progress);
    } catch (const Error& error) {
      const std::string& file = fileOf(current);
      if (error.kind() != ErrorKind::InvalidInput ||
          std::string_view(error.what()).find(file) != std::string_view::npos)
        throw;
      throw invalidInput(m_rest + " and " + file + ": " + error.what());
    }
  }

  [[nodiscard]] Answer report(const formats::Case& value,
                              const convert::TrackedMotion& tracked) const {
    Json json = caseSummary(value), phases = Json::array();
    std::string text;
    for (std::size_t i = 0; i < tracked.phases.size(); ++i) {
      const convert::PhaseReport& p = tracked.phases[i];
      phases.push_back({{"time_s", jsonNumber(tracked.motion.time[i])},
                        {"farthest_mm", jsonNumber(p.farthest)},
                        {"seen", jsonNumber(p.seen)},
                        {"correction_mm", jsonNumber(p.correction)},
                        {"fitted_nodes", p.fitted}});
      text += formats::printable(fileOf(i)) +
              (m_frames > 0 ? ", volume " + std::to_string(i) : std::string()) + ": " +
              fixedText(tracked.motion.time[i], 3) + " s, moved by up to " +
              fixedText(p.farthest, 2) + " mm, " + fixedText(100 * p.seen, 1) +
              " % of the length seen\n";
    }
    json["period_s"] = jsonNumber(tracked.motion.period);
    json["phases"] = std::move(phases);
    return {std::move(json), text + caseLine(m_output, value)};
  }

  std::string m_rest, m_output, m_from;
  std::vector<std::string> m_phases, m_times;
  std::int64_t m_frames = 0;
  double m_period = 1;
  VolumeArguments m_volume;
  convert::MotionOptions m_options;
};

}  // namespace

std::unique_ptr<Command> makeMotionCommand() {
  return std::make_unique<MotionCommand>();
}

}  // namespace lumen::engine
