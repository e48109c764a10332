// SPDX-License-Identifier: Apache-2.0
// lumen fit: blobby models for a tracked case.
#include "converters/stages/fitting/fit.h"

#include "converters/engine/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/reachable_answer.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"

namespace lumen::engine {

namespace {

class FitCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "fit"; }
  [[nodiscard]] std::string summary() const override {
    return "Fit blobby models to the wall points of a tracked case";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen fit tracked.lumen fitted.lumen --accuracy 0.2";
  }

  [[nodiscard]] std::vector<std::string> addressRows() const override { return {"IN"}; }
  void addRows(OptionTable& table) override {
    table.argument("IN", &m_input, "Case with wall points");
    table.argument("OUT", &m_output,
                   "Case to write, " + formatEndings(canWriteCase) + "; may be IN");
    addFitRows(table, m_fit);
    addFormatRow(table, "to", m_to, "OUT");
  }

  Answer run(Surroundings& around) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "the fitted tree");
    requireInput(m_input, "case file");
    requireInScope(*around.table, {}, around.progress);
    requireWritable(m_output, convert::ContentKind::Case);
    around.willWrite(m_output);

    formats::Case value = readParentCase(m_input);
    if (!value.points)
      throw invalidInput(m_input +
                         ": this case has no wall points to fit to; lumen track makes one "
                         "that has");
    convert::fit(value, m_fit, around.progress);
    const std::optional<convert::Reach> reach = convert::measureReach(value, around.progress);
    convert::warnOfClosed(reach, around.progress);
    to.writeCase(value, m_output, {}, around.progress);
    Json json = caseSummary(value);
    json["reachable"] = reachJson(reach);
    return {std::move(json), caseLine(m_output, value) + convert::reachLine(reach)};
  }

private:
  std::string m_input, m_output, m_to;
  convert::FitOptions m_fit;
};

}  // namespace

std::unique_ptr<Command> makeFitCommand() {
  return std::make_unique<FitCommand>();
}

}  // namespace lumen::engine
