// SPDX-License-Identifier: Apache-2.0
// lumen fit: blobby models for a tracked case.
#include "converters/cli/command.h"
#include "converters/cli/options.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/file_access.h"
#include "converters/engine/reachable.h"
#include "converters/engine/report.h"

namespace lumen::app {

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

  void bind(CLI::App& app) override {
    addFile(app, "IN", m_input, "Case with wall points");
    addFile(app, "OUT", m_output, "Case to write, " + formatEndings(canWriteCase) + "; may be IN");
    addFitOptions(app, m_fit);
    app.add_option("--to", m_to, "Format of OUT, whatever its name")->type_name("F");
  }

  int run(Context& context) override {
    requireOrder(m_input, m_output);
    const FileFormat& to = caseOutputFormat(m_output, m_to, "what lumen fit makes");
    requireInput(m_input, "case file");
    requireWritable(m_output, ContentKind::Case);
    context.interrupts.watchOutput(m_output);

    formats::Case value = readParentCase(m_input);
    if (!value.points)
      throw invalidInput(m_input +
                         ": this case has no wall points to fit to; lumen track makes one "
                         "that has");
    convert::fit(value, m_fit.options(), context.progress);
    const std::optional<Reach> reach = reachOf(value, context.progress);
    warnOfClosed(reach, context.progress);
    to.writeCase(value, m_output, {}, context.progress);
    report(value, reach, context);
    return 0;
  }

private:
  void report(const formats::Case& value, const std::optional<Reach>& reach,
              const Context& context) const {
    if (context.common.json) {
      Json json = caseSummary(value);
      json["reachable"] = reachJson(reach);
      answerJson(json);
    } else if (!context.common.quiet) {
      answer(caseLine(m_output, value) + reachLine(reach));
    }
  }

  std::string m_input, m_output, m_to;
  FitArguments m_fit;
};

}  // namespace

std::unique_ptr<Command> makeFitCommand() {
  return std::make_unique<FitCommand>();
}

}  // namespace lumen::app
