// SPDX-License-Identifier: Apache-2.0
// lumen ends: the open ends of a case, and the ends at which blood comes in.
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/ends_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/judge/facts/reachable.h"
#include "converters/operations/ends_of.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using operations::OpenEnd;

class EndsCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "ends"; }
  [[nodiscard]] std::string summary() const override {
    return "List the open ends of a case, and state at which of them blood comes in";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen ends head.lumen\n"
           "  lumen ends head.lumen --root 1 --root 2 --out rooted.lumen   # ends by their numbers";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_input, "Case");
    table
        .file("out", m_output,
              "Case to write with other inlets, " + formatEndings(canWriteCase) + "; may be CASE")
        .onlyWith(kOption.root.name);
    table
        .add(kOption.root.name, &m_roots, "N",
             "Number of an end, as listed, at which blood comes in; may be repeated. A tree with "
             "several is divided at its narrowest place between them, and a link joins the parts")
        .many()
        .checkedBy(&numberFault)
        .onlyWith("out");
    addFormatRow(table, "to", m_to, "--out");
    table.find("to")->onlyWith("out");
  }

  Answer run(const RunContext& context) override {
    requireInput(m_input, "case file");
    requireInScope(*context.table, {}, context.progress);
    const FileFormat* to = nullptr;
    if (!m_output.empty()) {
      requireOrder(m_input, m_output);
      to = &caseOutputFormat(m_output, m_to, "the case with other inlets");
      requireWritable(m_output, convert::ContentKind::Case);
    }
    formats::Case value = to == nullptr ? readCase(m_input) : readParentCase(m_input);
    std::vector<OpenEnd> ends = operations::endsOf(value);
    bool isFitted = false;
    if (to != nullptr) {
      operations::RootedCase rooted =
          operations::rootedAt(std::move(value), chosen(ends), operationContext(context));
      value = std::move(rooted.value);
      isFitted = rooted.isFitted;
      to->writeCase(value, m_output, {}, context.progress);
      ends = operations::endsOf(value);
    }
    Json json = caseSummary(value);
    json["trees"] = convert::countTrees(value.tree);
    json["links"] = value.tree.links.size();
    json["fitted"] = isFitted;
    json["ends"] = openEndsJson(ends, value.tree);
    const std::string line = to == nullptr ? "" : caseLine(m_output.name(), value);
    return {std::move(json), endTable(ends, value.tree) + line, 0, to == nullptr};
  }

private:
  static std::string numberFault(const std::string& text) {
    const bool isNumber = !text.empty() && text.size() < 10 &&
                          text.find_first_not_of("0123456789") == std::string::npos &&
                          text.find_first_not_of('0') != std::string::npos;
    return isNumber ? "" : foundText(text, "the number of an end, as lumen ends lists them");
  }

  [[nodiscard]] std::vector<OpenEnd> chosen(const std::vector<OpenEnd>& ends) const {
    std::vector<OpenEnd> inlets;
    for (const std::string& text : m_roots) {
      const auto number = static_cast<std::size_t>(std::stoul(text));
      if (number > ends.size())
        throw Error(ErrorKind::Usage, kOption.root.shown() + ": found " + text +
                                          ", expected the number of an end, 1 to " +
                                          std::to_string(ends.size()));
      inlets.push_back(ends[number - 1]);
    }
    return inlets;
  }

  InputFile m_input;
  OutputFile m_output;
  std::string m_to;
  std::vector<std::string> m_roots;
};

}  // namespace

std::unique_ptr<Command> makeEndsCommand() {
  return std::make_unique<EndsCommand>();
}

}  // namespace lumen::engine
