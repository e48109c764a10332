// SPDX-License-Identifier: Apache-2.0
#include "converters/library/build_row.h"

#include <chrono>
#include <span>
#include <system_error>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kShortDigest = 12;  // characters, in names of folders

/// The operations of one row.
class RowMaker {
public:
  RowMaker(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options,
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
    m_result.end = isMade ? RowEnd::Made : RowEnd::Failed;
    return m_result;
  }

private:
  [[nodiscard]] fs::path caseFile() const { return m_plan.folder / "case.lumen"; }
  [[nodiscard]] fs::path aboutFile() const { return m_plan.folder / "about.json"; }

  bool tracked() {
    if (fs::exists(caseFile())) return true;
    Operation convert{
        "convert", {fs::absolute(m_plan.row->input).string(), caseFile().string()}, {}};
    if (!m_plan.row->seeds.empty())
      convert.with(kOption.seeds.name, fs::absolute(m_plan.row->seeds).string());
    for (const auto& [name, value] : m_plan.row->options) convert.with(name.substr(2), value);
    return run(convert);
  }

  bool hasAbout() {
    const std::string& text = m_plan.row->about;
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(text)), aboutFile());
    if (!done) m_result.why = done.error().message;
    return static_cast<bool>(done);
  }

  bool hasLibrary() {
    if (fs::exists(m_plan.staged / kLibraryFile)) return true;
    Operation init{"library init", {m_plan.staged.string()}, {}};
    init.with("title", m_library.title).with("date", m_library.date);
    if (!m_library.licence.empty()) init.with("licence", m_library.licence);
    return run(init);
  }

  bool hasCase() {
    if (isStaged(m_plan)) return true;
    Operation add{"library add", {m_plan.staged.string(), caseFile().string()}, {}};
    add.with(kOption.id.name, m_plan.id)
        .with("about", aboutFile().string())
        .with("recipe", m_plan.recipe.all);
    if (!m_plan.row->targets.empty()) add.options.emplace_back("export", m_plan.row->targets);
    return run(add);
  }

  bool run(const Operation& operation) {
    const auto begin = std::chrono::steady_clock::now();
    const OperationEnd end = m_options.run(operation, m_result.log, m_progress);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    m_result.seconds += took.count();
    m_result.code = end.code;
    m_result.warnings += end.warnings;
    if (!end.isDone) m_result.why = end.error;
    return end.isDone;
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
  plan.recipe = makeRecipe(row, options.version, library.licence, progress);
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
  return RowMaker(plan, library, options, progress).made();
}

}  // namespace lumen::convert
