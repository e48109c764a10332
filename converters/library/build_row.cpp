// SPDX-License-Identifier: Apache-2.0
#include "converters/library/build_row.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <span>
#include <system_error>
#include <thread>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kLongest = 7 * 24 * 3600;  // s: a command that runs for a week hangs
constexpr std::size_t kShortDigest = 12;      // characters, in names of folders
constexpr std::string_view kError = "lumen: error: ", kWarning = "lumen: warning: ";

using Words = std::vector<std::string>;

struct Messages {
  std::string lastError;
  std::size_t warnings = 0;
};

Messages messagesOf(const fs::path& log) {
  Messages messages;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(kError)) messages.lastError = line.substr(kError.size());
    if (line.starts_with(kWarning)) ++messages.warnings;
  }
  return messages;
}

std::string endText(const ProgramResult& result) {
  switch (result.end) {
    case ProgramEnd::Crashed:
      return "crashed, or was ended for want of memory";
    case ProgramEnd::TookTooLong:
      return "did not end within a week";
    default:
      return "ended with exit code " + std::to_string(result.code);
  }
}

/// The commands of one row.
class Row {
public:
  Row(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options,
      const Progress& progress)
      : m_plan(plan), m_library(library), m_options(options), m_progress(progress) {
    m_result.line = plan.row->line;
    m_result.id = plan.id;
    m_result.log = options.work / "logs" / (plan.id + ".log");
  }

  RowResult made() {
    std::error_code error;
    fs::create_directories(m_plan.folder, error);
    if (!error) fs::create_directories(m_result.log.parent_path(), error);
    if (!error) fs::remove(m_result.log, error);
    if (error) {
      m_result.why = m_plan.folder.string() + ": " + error.message();
      return m_result;
    }
    const bool isMade = tracked() && hasAbout() && hasLibrary() && hasCase();
    const Messages messages = messagesOf(m_result.log);
    m_result.warnings = messages.warnings;
    m_result.end = isMade ? RowEnd::Made : RowEnd::Failed;
    if (!isMade && !messages.lastError.empty()) m_result.why = messages.lastError;
    return m_result;
  }

private:
  [[nodiscard]] fs::path caseFile() const { return m_plan.folder / "case.lumen"; }
  [[nodiscard]] fs::path aboutFile() const { return m_plan.folder / "about.json"; }

  bool tracked() {
    if (fs::exists(caseFile())) return true;
    Words words{"convert", fs::absolute(m_plan.row->input).string(), caseFile().string()};
    if (!m_plan.row->seeds.empty()) {
      words.emplace_back("--seeds");
      words.push_back(fs::absolute(m_plan.row->seeds).string());
    }
    for (const auto& [name, value] : m_plan.row->options) words.push_back(name + "=" + value);
    return run(std::move(words));
  }

  bool hasAbout() {
    const std::string& text = m_plan.row->about;
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(text)), aboutFile());
    if (!done) m_result.why = done.error().message;
    return static_cast<bool>(done);
  }

  bool hasLibrary() {
    if (fs::exists(m_plan.staged / kLibraryFile)) return true;
    Words words{"library",       "init",   m_plan.staged.string(), "--title",
                m_library.title, "--date", m_library.date};
    if (!m_library.licence.empty()) {
      words.emplace_back("--licence");
      words.push_back(m_library.licence);
    }
    return run(std::move(words));
  }

  bool hasCase() {
    if (isStaged(m_plan)) return true;
    Words words{
        "library", "add",     m_plan.staged.string(), caseFile().string(), "--id",
        m_plan.id, "--about", aboutFile().string(),   "--recipe",          m_plan.recipe.all};
    for (const std::string& target : m_plan.row->targets) {
      words.emplace_back("--export");
      words.push_back(target);
    }
    return run(std::move(words));
  }

  bool run(Words words) {
    const auto cores = std::max(1U, std::thread::hardware_concurrency());
    const int all = m_options.threads > 0 ? m_options.threads : static_cast<int>(cores);
    for (const std::string& word :
         {std::string("--threads"), std::to_string(std::max(1, all / m_options.jobs))})
      words.push_back(word);
    if (m_options.strict) words.emplace_back("--strict");
    ProgramCall call;
    call.program = m_options.program;
    call.arguments = std::move(words);
    call.folder = fs::current_path();
    call.seconds = kLongest;
    call.log = m_result.log;
    const auto begin = std::chrono::steady_clock::now();
    const ProgramResult result = runProgram(call, m_progress);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    m_result.seconds += took.count();
    m_result.code = result.code;
    if (result.end != ProgramEnd::Done) m_result.why = endText(result);
    return result.end == ProgramEnd::Done;
  }

  const PlannedRow& m_plan;
  const LibraryFile& m_library;
  const BuildOptions& m_options;
  const Progress& m_progress;
  RowResult m_result;
};

}  // namespace

PlannedRow planRow(const BuildRow& row, const LibraryFile& library, const BuildOptions& options,
                   const Progress& progress) {
  PlannedRow plan;
  plan.row = &row;
  plan.recipe = recipeOf(row, options.version, library.licence, progress);
  plan.id = row.id.empty() ? "case-" + plan.recipe.input.substr(0, kShortDigest) : row.id;
  plan.folder =
      fs::absolute(options.work) / (plan.id + "-" + plan.recipe.tree.substr(0, kShortDigest));
  plan.staged = plan.folder / ("library-" + plan.recipe.all.substr(0, kShortDigest));
  return plan;
}

bool isStaged(const PlannedRow& plan) {
  std::error_code ignored;
  return fs::exists(plan.staged / kLibraryFile, ignored) &&
         findCase(openLibrary(plan.staged), plan.id) != nullptr;
}

RowResult makeRow(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options,
                  const Progress& progress) {
  return Row(plan, library, options, progress).made();
}

}  // namespace lumen::convert
