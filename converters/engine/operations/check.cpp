// SPDX-License-Identifier: Apache-2.0
// lumen check: the agreement of a case with its volume.
#include "converters/judge/check/check.h"

#include <algorithm>
#include <cmath>

#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/volume/write_volume.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using formats::printable;

constexpr std::size_t kPlacesShown = 10;  // places of each kind; --json has all

std::vector<std::string> offsetsRow(const std::string& label, const convert::Offsets& o,
                                    double voxel) {
  return {label,
          std::to_string(o.samples),
          fixedText(o.median, 3),
          fixedText(o.median / voxel, 2),
          fixedText(o.absoluteMedian / voxel, 2),
          fixedText(o.absoluteP90 / voxel, 2),
          convert::percentText(o.beyondVoxel),
          convert::percentText(o.noEdge),
          convert::percentText(o.wrongPolarity),
          std::to_string(o.beside)};
}

/// The lines of the first kPlacesShown of `list`, and how many more there are.
template <class List, class Line>
std::string firstLines(const List& list, const std::string& singular, const std::string& plural,
                       Line&& line) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kPlacesShown, list.size()); ++i)
    text += line(list[i]) + "\n";
  if (list.size() > kPlacesShown)
    text += counted(list.size() - kPlacesShown, singular, plural) + "; " + kOption.json.shown() +
            " lists them\n";
  return text;
}

/// "1.5 mm3 ", "1520 mm3"
std::string volumeText(double mm3) {
  return fixedText(mm3, mm3 < 100 ? 1 : 0) + " mm3";
}

std::string darkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  return convert::percentText(convert::share(report.dark.volume, report.lumenVolume)) +
         " of the lumen's volume is dark and farther than a voxel from its wall\n" +
         firstLines(report.dark.regions, "smaller dark place", "smaller dark places",
                    [&](const convert::Region& region) {
                      return "the lumen of " + printable(convert::labelOf(tree, region.node)) +
                             " at " + convert::placeText(region.position) + " is dark over " +
                             volumeText(region.volume);
                    });
}

std::string endsText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  const std::vector<convert::OpenEnd> onward = convert::endsThatStopShort(report);
  return counted(report.ends.size() - onward.size(), "open end", "open ends") + " of " +
         std::to_string(report.ends.size()) + " reach as far as the volume shows their vessel\n" +
         firstLines(onward, "more end stops short", "more ends stop short",
                    [&](const convert::OpenEnd& end) {
                      return printable(convert::labelOf(tree, end.node)) +
                             (end.first ? " begins at " : " ends at ") +
                             convert::placeText(toEigen(tree.centre[end.node])) +
                             ", and the vessel goes on for about " + fixedText(end.goesOn, 0) +
                             " mm";
                    });
}

std::string missingText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  const double missing = report.missingLength(), whole = report.shownLength + missing;
  return "the case has " + fixedText(report.shownLength, 1) + " of " + fixedText(whole, 1) +
         " mm (" + convert::percentText(convert::share(report.shownLength, whole)) +
         ") of the vessels that are connected with it in the volume\n" +
         firstLines(report.missing.vessels, "shorter vessel is not in the case",
                    "shorter vessels are not in the case",
                    [&](const convert::MissingVessel& vessel) {
                      return "a vessel of " + fixedText(vessel.length, 1) + " mm and radius " +
                             fixedText(vessel.radius, 1) + " mm at " +
                             convert::placeText(convert::middleOf(vessel)) + ", beside " +
                             printable(convert::labelOf(tree, vessel.path.front().node)) +
                             ", is not in the case";
                    }) +
         firstLines(report.missing.wide.regions, "smaller wide region", "smaller wide regions",
                    [&](const convert::Region& region) {
                      return "a bright region of " + volumeText(region.volume) + " at " +
                             convert::placeText(region.position) + ", beside " +
                             printable(convert::labelOf(tree, region.node)) +
                             ", is wider than every vessel of the case";
                    });
}

std::string checkText(const convert::CheckReport& report, const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"branch", "samples", "offset", "voxels", "median", "p90", "beyond", "no edge",
                  "reversed", "beside"});
  for (const auto& branch : report.branches)
    rows.push_back(offsetsRow(printable(branch.label), branch.offsets, report.voxelSize));
  rows.push_back(offsetsRow("(all)", report.offsets, report.voxelSize));
  return alignColumns(rows) +
         "\noffset of the wall from the half-maximum edge: median in mm and voxels, positive where "
         "the model\nis too wide; median and 90th percentile of its size in voxels. Shares of the "
         "samples: farther than\na voxel, without an edge, dark inside and bright outside. Beside: "
         "samples where another part of the\ntree begins, not judged. One voxel is " +
         fixedText(report.voxelSize, 3) + " mm; blur taken as " +
         fixedText(report.options.pointSpread, 3) + " mm.\n\n" + darkText(report, tree) +
         endsText(report, tree) + missingText(report, tree);
}

class CheckCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "check"; }
  [[nodiscard]] std::string summary() const override {
    return "Agreement of a case with its volume: wall, dark lumen, missing vessels";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen check head.nrrd head.lumen --overlay head.png --mask head-lumen.nrrd\n"
           "  lumen check head.nrrd head.lumen --profile simulator   # exit code 3: needs a person";
  }

  void addRows(OptionTable& table) override {
    table.argument("VOLUME", &m_input, formatTitles(canReadVolume));
    table.argument("CASE", &m_case, "The case that was made from it");
    addVolumeRows(table, m_volume);
    table.file("overlay", m_overlay, "Also write projections of the volume with the tree, as PNG");
    table.file("mask", m_mask,
               "Also write the lumen as a volume of labels, 1 for the first branch: " +
                   formatEndings(canWriteVolume));
    table
        .add("point-spread", &m_pointSpread, "MM",
             "Blur of the volume, a standard deviation in mm: it displaces the edges of thin "
             "vessels; 0 takes them as they are seen [what the case records, else 0]")
        .in(NumberRange{0, 1000});
    addTimeRow(table, m_time);
    table.add("profile", &m_profile, "NAME",
              "Also judge the case by thresholds, and exit with 3 if it needs a person: " +
                  profileNames() + ", or a FILE.json of one's own");
    addFormatRow(table, "from", m_from, "VOLUME");
  }

  Answer run(const RunContext& context) override {
    if (!m_profile.empty()) m_gate = convert::gateProfile(m_profile);
    requireInput(m_input, "volume");
    const FileFormat& from = inputFormat(m_input, m_from);
    if (from.kind != FormatKind::Volume)
      throw unsupported(m_input + ": this is a " +
                        (from.kind == FormatKind::Mesh ? "mesh" : "case") +
                        "; lumen check takes the volume first, then the case");
    const FileFormat* mask = m_mask.empty() ? nullptr : &volumeOutputFormat(m_mask, "the mask");
    requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input, {}},
                   context.progress);
    checkOutputs();
    const formats::Case value =
        atTime(readCase(m_case), m_time, m_case, *context.table, context.progress);
    if (!value.models || value.tree.nodeCount() == 0)
      throw invalidInput(
          m_case +
          ": has no models, so it has no wall to check; lumen fit makes them of wall points, "
          "lumen convert of the volume and its seeds");
    const convert::Volume volume = loadVolume(m_input, from, m_volume, context.progress);
    const convert::SourceRelation source =
        convert::sourceRelation(convert::describeSource(volume), value.metadata);
    if (const auto text = source.warning(m_input)) context.progress.warn(m_case + ": " + *text);

    convert::EdgeOptions options = convert::recordedEdgeOptions(value);
    if (m_pointSpread) options.pointSpread = *m_pointSpread;
    const convert::CheckResult result = checked(volume, value, options, context);
    if (const auto text = convert::outsideWarning(result.report, m_input))
      context.progress.warn(m_case + ": " + *text);
    if (mask != nullptr)
      mask->writeVolume(convert::labelVolume(volume.geometry, value.tree, result.lumen), m_mask);
    if (!m_overlay.empty())
      writeText(convert::encodePng(convert::drawOverlay(volume, value.tree, result.report)),
                m_overlay);
    Answer answer{checkJson(result.report, value.tree, source.word()),
                  checkText(result.report, value.tree), 0, true};
    answer.json["verdict"] = nullptr;
    if (m_gate) addVerdict(value, result.report, answer, context.progress);
    return answer;
  }

private:
  static std::string profileNames() {
    std::string names;
    for (const convert::GateProfile& profile : convert::gateProfiles())
      names += (names.empty() ? "" : ", ") + profile.name + " (" + profile.summary + ")";
    return names;
  }

  void addVerdict(const formats::Case& value, const convert::CheckReport& report, Answer& answer,
                  const Progress& progress) const {
    const convert::GateVerdict verdict =
        convert::judgeCase(*m_gate, value, report, convert::measureReach(value, progress));
    const std::vector<std::string> view = viewCommand(verdict, m_input, m_case);
    answer.json["verdict"] = verdictJson(verdict, value.tree, view);
    answer.text += verdictText(verdict, value.tree, view);
    if (!verdict.passes()) answer.code = kInvalidCode;
  }

  /// Refuses outputs that could not be written in the end, or would be lost.
  void checkOutputs() const {
    if (!m_mask.empty() && m_mask == m_overlay)
      throw Error(ErrorKind::Usage, m_mask + ": this name is given to two outputs");
    const std::pair<const std::string&, convert::ContentKind> outputs[] = {
        {m_overlay, convert::ContentKind::Other}, {m_mask, convert::ContentKind::Volume}};
    for (const auto& [output, kind] : outputs) {
      if (output.empty()) continue;
      std::error_code missing;
      for (const std::string& input : {m_input, m_case})
        if (std::filesystem::equivalent(input, output, missing))
          throw Error(ErrorKind::Usage,
                      output + ": this is an input; lumen check would overwrite it");
      requireWritable(output, kind);
    }
  }

  convert::CheckResult checked(const convert::Volume& volume, const formats::Case& value,
                               const convert::EdgeOptions& options,
                               const RunContext& context) const {
    try {
      return convert::checkCase(volume, value, options, context.progress);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      throw invalidInput(m_case + " and " + m_input + ": " + error.what());
    }
  }

  std::string m_input, m_case, m_overlay, m_mask, m_from, m_profile;
  std::optional<convert::GateProfile> m_gate;
  std::optional<double> m_pointSpread, m_time;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makeCheckCommand() {
  return std::make_unique<CheckCommand>();
}

}  // namespace lumen::engine
