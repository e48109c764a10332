// SPDX-License-Identifier: Apache-2.0
// lumen check: the agreement of a case with its volume.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/volume/write_volume.h"
#include "converters/operations/check_of.h"

namespace lumen::engine {

namespace {

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
      throw unsupported(m_input.name() + ": this is a " +
                        (from.kind == FormatKind::Mesh ? "mesh" : "case") +
                        "; lumen check takes the volume first, then the case");
    const FileFormat* mask = m_mask.empty() ? nullptr : &volumeOutputFormat(m_mask, "the mask");
    requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input.name(), {}},
                   context.progress);
    checkOutputs();
    const formats::Case value =
        atTime(readCase(m_case), m_time, m_case.name(), *context.table, context.progress);
    if (!value.models || value.tree.nodeCount() == 0)
      throw invalidInput(
          m_case.name() +
          ": has no models, so it has no wall to check; lumen fit makes them of wall points, "
          "lumen convert of the volume and its seeds");
    const convert::Volume volume = loadVolume(m_input, from, m_volume, context.progress);
    const operations::Checked result =
        operations::checked(value, volume, convert::describeSource(volume),
                            {m_pointSpread, m_gate,
                             operations::CheckNames{m_case.name(), m_input.name(),
                                                    m_case.name() + " and " + m_input.name()}},
                            operationContext(context));
    if (mask != nullptr)
      mask->writeVolume(convert::labelVolume(volume.geometry, value.tree, result.lumen), m_mask);
    if (!m_overlay.empty())
      writeText(convert::encodePng(convert::drawOverlay(volume, value.tree, result.report)),
                m_overlay);
    Answer answer{checkJson(result.report, value.tree, result.source.word()),
                  checkText(result.report, value.tree), 0, true};
    answer.json["verdict"] = nullptr;
    if (result.verdict) addVerdict(*result.verdict, value.tree, answer);
    return answer;
  }

private:
  static std::string profileNames() {
    std::string names;
    for (const convert::GateProfile& profile : convert::gateProfiles())
      names += (names.empty() ? "" : ", ") + profile.name + " (" + profile.summary + ")";
    return names;
  }

  void addVerdict(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                  Answer& answer) const {
    const std::vector<std::string> view = viewCommand(verdict, m_input.name(), m_case.name());
    answer.json["verdict"] = verdictJson(verdict, tree, view);
    answer.text += verdictText(verdict, tree, view);
    if (!verdict.passes()) answer.code = kInvalidCode;
  }

  /// Refuses outputs that could not be written in the end, or would be lost.
  void checkOutputs() const {
    if (!m_mask.empty() && m_mask.path() == m_overlay.path())
      throw Error(ErrorKind::Usage, m_mask.name() + ": this name is given to two outputs");
    const std::pair<const OutputFile&, convert::ContentKind> outputs[] = {
        {m_overlay, convert::ContentKind::Other}, {m_mask, convert::ContentKind::Volume}};
    for (const auto& [output, kind] : outputs) {
      if (output.empty()) continue;
      std::error_code missing;
      for (const InputFile& input : {m_input, m_case})
        if (!input.isInMemory() &&
            std::filesystem::equivalent(input.path(), output.path(), missing))
          throw Error(ErrorKind::Usage,
                      output.name() + ": this is an input; lumen check would overwrite it");
      requireWritable(output, kind);
    }
  }

  InputFile m_input, m_case;
  OutputFile m_overlay, m_mask;
  std::string m_from, m_profile;
  std::optional<convert::GateProfile> m_gate;
  std::optional<double> m_pointSpread, m_time;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makeCheckCommand() {
  return std::make_unique<CheckCommand>();
}

}  // namespace lumen::engine
