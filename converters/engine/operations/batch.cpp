// SPDX-License-Identifier: Apache-2.0
// lumen batch: a case, a verdict and a picture of every volume of a folder.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/batch_inputs.h"
#include "converters/engine/library_build.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

using convert::BatchEnd, convert::BatchResult;

constexpr std::array<std::pair<BatchEnd, const char*>, 4> kEnds = {
    {{BatchEnd::Passed, "passed"},
     {BatchEnd::NeedsPerson, "needs_person"},
     {BatchEnd::NoVessels, "no_vessels"},
     {BatchEnd::Failed, "failed"}}};

std::string endKey(BatchEnd end) {
  return std::find_if(kEnds.begin(), kEnds.end(), [end](const auto& e) { return e.first == end; })
      ->second;
}

Json batchFigures(const BatchResult& result) {
  if (!result.figures) return nullptr;
  const convert::BatchFigures& f = *result.figures;
  return {{"vessels", f.vessels},
          {"trees", f.trees},
          {"links", f.links},
          {"length_mm", jsonNumber(f.length)},
          {"radius_min_mm", jsonNumber(f.least)},
          {"radius_max_mm", jsonNumber(f.greatest)}};
}

Json batchRow(const BatchResult& result) {
  const bool isPassed = result.end == BatchEnd::Passed;
  return {{"id", result.id},
          {"input", formats::printable(result.name)},
          {"end", endKey(result.end)},
          {"kept", result.isKept},
          {"why", isPassed ? Json() : Json(result.why)},
          {"code", isPassed ? Json() : Json(result.code)},
          {"seconds", jsonNumber(result.seconds)},
          {"warnings", result.warnings},
          {"figures", batchFigures(result)},
          {"at", result.at.empty() ? Json(nullptr) : Json(result.at)}};
}

std::string batchText(const std::vector<BatchResult>& results) {
  std::vector<std::vector<std::string>> rows{
      {"case", "vessels", "length mm", "seconds", "warnings", ""}};
  for (const BatchResult& r : results)
    rows.push_back({r.id, r.figures ? std::to_string(r.figures->vessels) : "-",
                    r.figures ? fixedText(r.figures->length, 0) : "-",
                    r.isKept ? "kept" : fixedText(r.seconds, 1), std::to_string(r.warnings),
                    batchWord(r.end)});
  return alignColumns(std::move(rows));
}

/// A line for each case that did not pass, and the command that shows its worst place.
std::string batchReasons(const std::vector<BatchResult>& results, const fs::path& inputs,
                         const fs::path& out) {
  std::string text;
  for (const BatchResult& r : results) {
    if (r.end == BatchEnd::Passed) continue;
    text += Lines().add(formats::printable(r.name) + ": " + batchWord(r.end) + ": " + r.why).text();
    const auto view = convert::viewWords(r, (inputs / r.name).string(),
                                         (out / convert::batchCase(r.id)).string());
    if (!view.empty()) text += Lines().add("  " + convert::shellLine(view)).text();
  }
  return text;
}

/// 0 if all passed; 3 if inputs alone are to blame for those that did not; else 1.
int batchCode(const std::vector<BatchResult>& results) {
  int code = 0;
  for (const BatchResult& r : results) {
    if (r.end == BatchEnd::Passed) continue;
    const bool isOfInput = r.end != BatchEnd::Failed || r.code == kInvalidCode;
    if (!isOfInput) return static_cast<int>(ErrorKind::Failed);
    code = kInvalidCode;
  }
  return code;
}

Answer batchAnswer(const std::vector<BatchResult>& results, std::size_t passedOver,
                   const fs::path& inputs, const std::string& out) {
  Json json = Json::object();
  std::string counts;
  for (const auto& [end, key] : kEnds) {
    const auto count = std::count_if(results.begin(), results.end(),
                                     [end = end](const BatchResult& r) { return r.end == end; });
    json[key] = count;
    if (count > 0)
      counts.append(counts.empty() ? "" : ", ")
          .append(std::to_string(count) + " " + batchWord(end));
  }
  json["kept"] =
      std::count_if(results.begin(), results.end(), [](const BatchResult& r) { return r.isKept; });
  json["passed_over"] = passedOver;
  json["rows"] = Json::array();
  for (const BatchResult& result : results) json["rows"].push_back(batchRow(result));
  const int code = batchCode(results);
  return {std::move(json),
          batchText(results) + batchReasons(results, inputs, out) + formats::printable(out) + ": " +
              counted(results.size(), "input", "inputs") + ": " + counts + "; see " +
              formats::printable((fs::path(out) / "index.html").string()) + "\n",
          code, code != 0};
}

class BatchCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "batch"; }
  [[nodiscard]] std::string summary() const override {
    return "Make, judge and draw a case of every volume of a folder";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen batch scans cases\n"
           "  lumen batch scans cases --profile flow --option dark=true\n"
           "  lumen batch scans.csv cases --accept patient-07\n"
           "  lumen batch scans.csv cases --rows 2,5   # one task of many, on any machine";
  }

  void addRows(OptionTable& table) override {
    table.argument("INPUTS", &m_inputs,
                   "Folder that is searched for volumes, label maps and DICOM series, also below "
                   "it; or a list as of lumen library build: comma-separated values with input, "
                   "and maybe id, seeds and options of lumen convert such as --crop");
    table.argument("OUT", &m_out,
                   "Folder for cases, pictures, logs, cases.csv and index.html; a run goes on with "
                   "what an earlier one left");
    table
        .add("jobs", &m_arguments.jobs, "N",
             "Cases at once, where memory has room for them; --threads are shared between them. 0: "
             "as many as threads")
        .in(WholeRange{0, 256});
    table.add("profile", &m_arguments.profile, "NAME",
              "Judge the cases of volumes as lumen check --profile does; none: all cases that were "
              "made pass");
    table
        .add("accept", &m_arguments.accepted, "ID",
             "A person has looked at this case, and it passes as it is; may be repeated")
        .many()
        .checkedBy(caseIdText());
    table
        .add("option", &m_settings, "NAME=VALUE",
             "Option of lumen convert for every input whose row does not state it; may be repeated")
        .many()
        .checkedBy(pairText("NAME=VALUE, such as dark=true"));
    addLinesRow(table, m_lines, "a list").help +=
        ". The tables and the page are left to a run without this option";
  }

  Answer run(const RunContext& context) override {
    requireInScope(*context.table, {}, context.progress);
    std::error_code ignored;
    const bool isFolder = fs::is_directory(m_inputs, ignored);
    if (!isFolder && !fs::exists(m_inputs, ignored))
      throw invalidInput(formats::printable(m_inputs) + ": there is no such folder or list");
    if (fs::exists(m_out, ignored) && !fs::is_directory(m_out, ignored))
      throw Error(ErrorKind::Usage,
                  formats::printable(m_out) + ": found a file, expected a folder for the cases");
    if (isFolder && !m_lines.empty())
      refuseUnused(*context.table->find("rows"),
                   "is for lists, and " + formats::printable(m_inputs) + " is a folder",
                   context.progress);
    if (!m_lines.empty()) m_arguments.phase = convert::BuildPhase::Make;
    if (m_arguments.profile == "none") m_arguments.profile.clear();
    FoundInputs found = isFolder ? volumesBelow(m_inputs, m_out, context.progress)
                                 : inputsOfList(m_inputs, linesIn(m_lines));
    chooseJobs(found.inputs.size(), context.threads);
    const convert::BuildOptions options = buildOptions(m_out, m_arguments, context);
    completeInputs(settings(), context.engine, found.inputs, context.progress);
    for (const std::string& file : found.passedOver)
      context.progress.detail(formats::printable(file) + ": passed over, as it is no volume");
    if (!found.passedOver.empty())
      warn(context.progress, {WarningCode::FilesPassedOver,
                              counted(found.passedOver.size(), "file is", "files are") +
                                  " passed over, as no volume that can be read",
                              "--verbose names them"});
    return batchAnswer(convert::makeBatch(found.inputs, m_out, options, context.progress),
                       found.passedOver.size(),
                       isFolder ? fs::path(m_inputs) : fs::path(m_inputs).parent_path(), m_out);
  }

private:
  void chooseJobs(std::size_t inputs, int threads) {
    if (m_arguments.jobs > 0) return;
    const auto cores = std::max(1U, std::thread::hardware_concurrency());
    const auto most = threads > 0 ? static_cast<std::size_t>(threads) : std::size_t{cores};
    m_arguments.jobs = static_cast<int>(std::min(most, inputs));
  }

  [[nodiscard]] BatchDefaults settings() const {
    BatchDefaults defaults;
    for (const std::string& setting : m_settings) {
      const std::size_t at = setting.find('=');
      defaults.emplace_back(setting.substr(0, at), setting.substr(at + 1));
    }
    return defaults;
  }

  std::string m_inputs, m_out, m_lines;
  std::vector<std::string> m_settings;
  BuildArguments m_arguments = batchArguments();

  static BuildArguments batchArguments() {
    BuildArguments arguments;
    arguments.jobs = 0;
    arguments.profile = "simulator";
    return arguments;
  }
};

}  // namespace

std::unique_ptr<Command> makeBatchCommand() {
  return std::make_unique<BatchCommand>();
}

}  // namespace lumen::engine
