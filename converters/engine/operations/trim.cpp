// SPDX-License-Identifier: Apache-2.0
// lumen trim: a case without ends that are too thin or too short.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/case_info_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/operations/trimmed.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

Json trimmedJson(const std::vector<convert::TrimmedEnd>& ends) {
  Json list = Json::array();
  for (const convert::TrimmedEnd& end : ends)
    list.push_back({{"label", end.label},
                    {"whole", end.isWhole},
                    {"nodes", end.nodes},
                    {"length_mm", jsonNumber(end.length)},
                    {"least_radius_mm", jsonNumber(end.radius)}});
  return list;
}

std::string trimmedLines(const std::vector<convert::TrimmedEnd>& ends) {
  if (ends.empty()) return Lines().add("trimmed", "nothing").text();
  std::string text;
  for (const convert::TrimmedEnd& end : ends)
    text += Lines().add("trimmed", formats::printable(convert::trimmedText(end))).text();
  return text;
}

class TrimCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "trim"; }
  [[nodiscard]] std::string summary() const override {
    return "Remove the ends of vessels that are too thin or too short";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen trim head.lumen flow.lumen --min-radius 0.4 --min-length 2";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_input, "Case");
    table.argument("OUT", &m_output,
                   "Case to write, " + formatEndings(canWriteCase) + "; may be CASE");
    table
        .add("min-radius", &m_limits.minRadius, "MM",
             "Remove the end of a vessel, from its tip to its first node of this radius, in mm")
        .in(kPositive);
    table
        .add("min-length", &m_limits.minLength, "MM",
             "Remove the end of a vessel behind its last branch if it is shorter than this, in mm")
        .in(kPositive);
    table
        .add("taper", &m_limits.taper, "SHARE",
             "Remove the tip of a vessel that is thinner than this share of the vessel's radius by "
             "it, as where a track runs out, such as 0.7")
        .in(NumberRange{0, 1});
    table
        .add("stub", &m_limits.stub, "N",
             "Remove the end of a vessel behind its last branch if it is shorter than this many of "
             "its diameters, unless it leaves the volume, such as 1")
        .in(NumberRange{0, 100});
    addFormatRow(table, "to", m_to, "OUT");
  }

  Answer run(const RunContext& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "the trimmed tree");
    requireInput(m_input, "case file");
    requireInScope(*context.table, {}, context.progress);
    if (m_limits == convert::TrimLimits{})
      throw Error(ErrorKind::Usage,
                  "nothing to trim by; expected --min-radius, --min-length, --taper or --stub");
    requireWritable(m_output, convert::ContentKind::Case);

    const operations::TrimmedCase trimmed = operations::trimmed(
        readParentCase(m_input), m_limits, m_input.name(), operationContext(context));
    const std::optional<convert::Reach> reach =
        convert::measureReach(trimmed.value, context.progress);
    convert::warnOfClosed(reach, context.progress);
    to.writeCase(trimmed.value, m_output, {}, context.progress);
    Json json = caseSummary(trimmed.value);
    json["trimmed"] = trimmedJson(trimmed.ends);
    json["reachable"] = reachJson(reach);
    return {std::move(json), caseLine(m_output.name(), trimmed.value) + trimmedLines(trimmed.ends) +
                                 convert::reachLine(reach)};
  }

private:
  InputFile m_input;
  OutputFile m_output;
  std::string m_to;
  convert::TrimLimits m_limits;
};

}  // namespace

std::unique_ptr<Command> makeTrimCommand() {
  return std::make_unique<TrimCommand>();
}

}  // namespace lumen::engine
