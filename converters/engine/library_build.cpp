// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/library_build.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/operation_process.h"
#include "converters/export/export_case.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

using convert::BuildRow, convert::RowState, convert::RowResult;

constexpr int kMostJobs = 256;

void requireTargets(const BuildRow& row) {
  std::vector<std::string> names;
  for (const convert::ExportTarget& target : convert::exportTargets())
    names.emplace_back(target.name);
  for (const std::string& target : row.targets)
    if (std::find(names.begin(), names.end(), target) == names.end())
      throw invalidInput("targets: found " + convert::quotedText(target) + ", expected some of " +
                         alternatives(names));
}

/// Options of lumen convert but those that every command has.
void requireOptions(const BuildRow& row, const OptionTable& convertOptions) {
  for (const auto& [name, value] : row.options)
    if (convertOptions.find(std::string_view(name).substr(2)) == nullptr)
      throw invalidInput(formats::printable(name) + ": lumen convert has no such option");
}

void requireAbout(const BuildRow& row, const convert::LibraryFile& library) {
  convert::CaseAbout about = convert::readAbout(row.about, "the statements about it");
  if (about.licence.empty()) about.licence = library.licence;
  if (about.title.empty()) throw invalidInput("title: is empty");
  if (const std::string missing = convert::missingStatement(about); !missing.empty())
    throw invalidInput(missing);
}

/// Machine and process: "process 12 on a".
std::string placeOfProcess() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

/// Moves rows that would only fail after work to the faults of the list.
void findFaults(convert::BuildList& list, const convert::LibraryFile& library,
                const Engine& engine) {
  const BoundCommand convertCommand = engine.find("convert");
  std::erase_if(list.rows, [&](const BuildRow& row) {
    try {
      requireTargets(row);
      requireOptions(row, *convertCommand.table);
      requireAbout(row, library);
      return false;
    } catch (const Error& error) {
      list.faults.push_back({row.line, row.id, error.what()});
      return true;
    }
  });
}

RowResult resultOf(const convert::RowFault& fault) {
  RowResult result;
  result.line = fault.line;
  result.id = fault.id;
  result.code = static_cast<int>(ErrorKind::InvalidInput);
  result.why = fault.why;
  return result;
}

std::size_t countRows(const std::vector<RowResult>& results, RowState state) {
  return static_cast<std::size_t>(std::count_if(
      results.begin(), results.end(), [state](const RowResult& r) { return r.state == state; }));
}

/// Whether the row's case is in the library.
bool isIn(const RowResult& result) {
  return result.state == RowState::Made || result.state == RowState::Kept;
}

Json resultJson(const RowResult& result) {
  Json json{{"row", result.line},
            {"id", result.id},
            {"end", convert::rowWord(result.state)},
            {"seconds", jsonNumber(result.seconds)},
            {"warnings", result.warnings},
            {"why", nullptr},
            {"code", nullptr}};
  json["view"] = result.view;
  if (!isIn(result)) {
    json["why"] = result.why;
    json["code"] = result.code;
  }
  return json;
}

/// The line below a row's reason: its log, or the command that shows its worst place.
std::string placeToLook(const RowResult& result) {
  if (!result.view.empty()) return Lines().add("  " + convert::shellLine(result.view)).text();
  return result.log.empty() ? "" : Lines().add("  see " + result.log.string()).text();
}

std::string resultTable(const std::vector<RowResult>& results) {
  std::vector<std::vector<std::string>> rows{{"case", "line", "seconds", "warnings", ""}};
  for (const RowResult& result : results)
    rows.push_back({result.id, std::to_string(result.line), fixedText(result.seconds, 1),
                    std::to_string(result.warnings), convert::rowWord(result.state)});
  std::string text = alignColumns(std::move(rows));
  for (const RowResult& result : results)
    if (!isIn(result))
      text +=
          Lines()
              .add("line " + std::to_string(result.line) + " (" + result.id + "): " + result.why)
              .text() +
          placeToLook(result);
  return text;
}

int exitCodeOf(const std::vector<RowResult>& results) {
  bool isInputAlone = true, isFailed = false;
  for (const RowResult& result : results) {
    if (isIn(result)) continue;
    isFailed = true;
    isInputAlone = isInputAlone && result.code == static_cast<int>(ErrorKind::InvalidInput);
  }
  if (!isFailed) return 0;
  return static_cast<int>(isInputAlone ? ErrorKind::InvalidInput : ErrorKind::Failed);
}

Answer makeAnswer(const std::vector<RowResult>& results, const std::string& library) {
  const std::size_t made = countRows(results, RowState::Made),
                    kept = countRows(results, RowState::Kept),
                    missing = countRows(results, RowState::Failed),
                    waiting = countRows(results, RowState::NeedsPerson);
  Json rows = Json::array();
  for (const RowResult& result : results) rows.push_back(resultJson(result));
  return {Json{{"made", made},
               {"kept", kept},
               {"failed", missing},
               {"needs_person", waiting},
               {"rows", rows}},
          resultTable(results) + formats::printable(library) + ": " +
              counted(results.size(), "row", "rows") + ": " + std::to_string(made) + " made, " +
              std::to_string(kept) + " kept, " + std::to_string(missing) + " failed" +
              (waiting > 0 ? ", " + std::to_string(waiting) + " need a person" : "") + "\n",
          exitCodeOf(results), missing + waiting > 0};
}

/// Whether a row is of a volume that shows vessels: no mask, and no labels.
bool isOfImage(const BuildRow& row) {
  for (const char* const name : {"--mask", "--label", "--labels"})
    if (row.options.contains(name)) return false;
  const auto from = row.options.find("--from");
  return inputFormat(row.input, from == row.options.end() ? "" : from->second).kind ==
         FormatKind::Volume;
}

/// Throws Error(Usage) for an unknown profile, Error(InvalidInput) for a file that is no profile.
void setGate(const BuildArguments& arguments, const Engine& engine,
             convert::BuildOptions& options) {
  options.accepted.insert(arguments.accepted.begin(), arguments.accepted.end());
  options.isVolume = isOfImage;
  if (arguments.profile.empty()) return;
  (void)convert::gateProfile(arguments.profile);
  const bool isFile = arguments.profile.ends_with(".json");
  options.profile = isFile ? fs::absolute(arguments.profile).string() : arguments.profile;
  const BoundCommand check = engine.find("check");
  for (const OptionRow& row : check.table->rows())
    if (!row.isArgument) options.checkOptions.insert(row.name);
}

/// Moves rows that would only fail after work (targets, options, statements) to the faults of the
/// list. Throws Error(InvalidInput) that names all faults, unless the arguments keep it going.
void judgeRows(convert::BuildList& rows, const std::string& list, const std::string& library,
               const BuildArguments& arguments, const Engine& engine) {
  findFaults(rows, convert::openLibrary(library), engine);
  if (!arguments.keepGoing) convert::requireNoFaults(rows.faults, list);
}

}  // namespace

std::set<std::size_t> linesIn(const std::string& text) {
  std::set<std::size_t> lines;
  const char* const last = text.data() + text.size();
  for (const char* at = text.data();; ++at) {
    std::size_t line = 0;
    const auto [end, error] = std::from_chars(at, last, line);
    if (error != std::errc{} || line == 0) return {};
    lines.insert(line);
    if (end == last) return lines;
    if (*end != ',') return {};
    at = end;
  }
}

OptionRow& addLinesRow(OptionTable& table, std::string& lines, const std::string& list) {
  return table
      .add("rows", &lines, "LINES",
           "Only the rows that begin on these lines of " + list + ", with commas between them")
      .checkedBy([](const std::string& text) {
        return linesIn(text).empty() ? foundText(text, "numbers of lines such as 2,5,9") : "";
      });
}

void addBuildRows(OptionTable& table, BuildArguments& arguments) {
  table.add("jobs", &arguments.jobs, "N", "Rows at once; --threads are shared between them")
      .in(WholeRange{1, kMostJobs});
  table
      .add("work", &arguments.work, "PATH",
           "Folder of the work in progress, from which an interrupted run continues "
           "[LIBRARY.build]")
      .checkedBy(fileName());
}

convert::BuildList loadBuildList(const std::string& file, const std::set<std::size_t>& lines) {
  return convert::readBuildList(readWholeFile(file, "list"), file, lines);
}

convert::BuildOptions buildOptions(const std::string& library, const BuildArguments& arguments,
                                   const RunContext& context) {
  const auto cores = std::max(1U, std::thread::hardware_concurrency());
  const int all = context.threads > 0 ? context.threads : static_cast<int>(cores);
  RunContext ofRow = context;
  ofRow.threads = std::max(1, all / arguments.jobs);
  convert::BuildOptions options;
  options.run = [ofRow](const Operation& operation, const fs::path& log) {
    return runApart(operation, ofRow, log);
  };
  options.version = LUMEN_VERSION;
  const std::string folder = (fs::absolute(library) / "").parent_path().string();
  options.work = arguments.work.empty() ? folder + ".build" : arguments.work;
  options.jobs = arguments.jobs;
  options.day = revisionDay("");
  options.phase = arguments.phase;
  options.isResumed = arguments.isResumed;
  options.place = placeOfProcess();
  setGate(arguments, context.engine, options);
  return options;
}

Answer buildLibrary(convert::BuildList rows, const std::string& list, const std::string& library,
                    const BuildArguments& arguments, const RunContext& context) {
  judgeRows(rows, list, library, arguments, context.engine);
  const convert::BuildOptions options = buildOptions(library, arguments, context);
  std::vector<RowResult> results;
  for (const convert::RowFault& fault : rows.faults) {
    results.push_back(resultOf(fault));
    warn(context.progress,
         {WarningCode::RowFailed, "line " + std::to_string(fault.line) + ": " + fault.why});
  }
  const fs::path folder = (fs::absolute(library) / "").parent_path();
  for (RowResult& result : convert::buildLibrary(rows.rows, folder, options, context.progress))
    results.push_back(std::move(result));
  std::sort(results.begin(), results.end(),
            [](const RowResult& a, const RowResult& b) { return a.line < b.line; });
  const bool keepsWork = arguments.phase == convert::BuildPhase::Make;
  if (!keepsWork && std::all_of(results.begin(), results.end(), isIn))
    convert::removeWorkFolder(options.work);
  return makeAnswer(results, library);
}

}  // namespace lumen::engine
