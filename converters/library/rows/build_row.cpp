// SPDX-License-Identifier: Apache-2.0
#include "converters/library/rows/build_row.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/options/option_name.h"
#include "converters/base/sha256.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kShortDigest = 12;  // characters, in names of folders

/// The digest of files under their names relative to `folder`.
std::string digestOfFiles(std::vector<fs::path> files, const fs::path& folder,
                          const Progress& progress) {
  std::sort(files.begin(), files.end());
  auto list = nlohmann::json::array();
  for (const fs::path& file : files) {
    progress.check();
    list.push_back({formats::printable(file.lexically_relative(folder).generic_string()),
                    digestOfFile(file).sha256});
  }
  return sha256(list.dump());
}

template <class Iterator>
std::vector<fs::path> listFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  if (error) throw failed(formats::printable(folder.string()) + ": " + error.message());
  return files;
}

bool isHeader(const fs::path& file) {
  constexpr std::array<std::string_view, 5> kApart = {".nhdr", ".mhd", ".hdr", ".img", ".gltf"};
  return std::find(kApart.begin(), kApart.end(), lowerCase(file.extension().string())) !=
         kApart.end();
}

/// A header and the files that its voxels may be in.
std::vector<fs::path> filesOfHeader(const fs::path& header) {
  const std::string text = readWholeFile(header, "header");
  const bool isPattern = text.find('%') != std::string::npos;
  const fs::path folder = header.has_parent_path() ? header.parent_path() : fs::path(".");
  std::vector<fs::path> files = listFiles<fs::directory_iterator>(folder);
  std::erase_if(files, [&](const fs::path& file) {
    return !isPattern && file.stem() != header.stem() &&
           text.find(file.filename().string()) == std::string::npos;
  });
  return files;
}

/// The operations of one row.
class RowMaker {
public:
  RowMaker(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options)
      : m_plan(plan), m_library(library), m_options(options) {
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
    const bool isMade = tracked() && passes() && hasAbout() && hasLibrary() && hasCase();
    if (isMade) m_result.state = RowState::Made;
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
    if (m_plan.corrected.empty() || !m_options.isVolume(*m_plan.row)) return run(convert);
    const OperationEnd end =
        runTimed(convert.with("corrections", fs::absolute(m_plan.corrected).string()));
    return take(end) && noteLeft(end);
  }

  [[nodiscard]] fs::path leftFile() const { return m_plan.folder / "corrections-left.txt"; }

  /// Notes corrections that could not be made again, with the digest of the case that lacks them.
  bool noteLeft(const OperationEnd& end) {
    if (end.answer.empty()) return true;
    JsonFile answer(end.answer, "answer of lumen convert");
    std::string left;
    for (const JsonPlace& one : JsonPlace(answer).at("corrections").at("left").elements())
      left += (left.empty() ? "" : "; ") + one.at("sentence").text() + ": " + one.at("why").text();
    if (left.empty()) return true;
    const std::string note = digestOfFile(caseFile()).sha256 + "\n" + left;
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(note)), leftFile());
    if (!done) m_result.why = done.error().message;
    return static_cast<bool>(done);
  }

  /// Corrections that the case still lacks: nobody has changed it since. Empty if there are none.
  [[nodiscard]] std::string leftCorrections() const {
    std::error_code error;
    if (!fs::exists(leftFile(), error)) return {};
    const std::string note = readWholeFile(leftFile(), "note");
    const std::size_t end = note.find('\n');
    return note.substr(0, end) == digestOfFile(caseFile()).sha256 ? note.substr(end + 1) : "";
  }

  bool needsPerson(const std::string& why, int code) {
    m_result.state = RowState::NeedsPerson;
    m_result.code = code;
    m_result.why = why;
    return false;
  }

  /// Whether no correction is left, and the case keeps the thresholds of the profile, if there is
  /// one and the row is of a volume.
  bool passes() {
    const BuildRow& row = *m_plan.row;
    if (m_options.accepted.contains(m_plan.id)) return true;
    if (const std::string left = leftCorrections(); !left.empty()) {
      m_result.view = {"lumen", "view", fs::absolute(row.input).string(), caseFile().string()};
      return needsPerson("corrections no longer fit: " + left,
                         static_cast<int>(ErrorKind::InvalidInput));
    }
    if (m_options.profile.empty() || !m_options.isVolume(row)) return true;
    Operation check{"check", {fs::absolute(row.input).string(), caseFile().string()}, {}};
    check.with("profile", m_options.profile);
    for (const auto& [name, value] : row.options)
      if (m_options.checkOptions.contains(name.substr(2))) check.with(name.substr(2), value);
    const OperationEnd end = runTimed(check);
    if (end.answer.empty()) return take(end);
    JsonFile answer(end.answer, "answer of lumen check");
    const JsonPlace verdict = JsonPlace(answer).at("verdict");
    if (verdict.at("passes").boolean()) return true;
    for (const JsonPlace& word : verdict.at("view").elements())
      m_result.view.push_back(word.text());
    return needsPerson(verdict.at("sentence").text(), end.code);
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
    if (isStaged(m_plan.staged, m_plan.id)) return true;
    Operation add{"library add", {m_plan.staged.string(), caseFile().string()}, {}};
    add.with(kOption.id.name, m_plan.id)
        .with("about", aboutFile().string())
        .with("recipe", m_plan.recipe.all);
    if (!m_plan.row->targets.empty()) add.options.emplace_back("export", m_plan.row->targets);
    return run(add);
  }

  bool run(const Operation& operation) { return take(runTimed(operation)); }

  OperationEnd runTimed(const Operation& operation) {
    const auto begin = std::chrono::steady_clock::now();
    const OperationEnd end = m_options.run(operation, m_result.log);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    m_result.seconds += took.count();
    m_result.warnings += end.warnings;
    return end;
  }

  bool take(const OperationEnd& end) {
    m_result.code = end.code;
    if (!end.isDone) m_result.why = end.error;
    return end.isDone;
  }

  const PlannedRow& m_plan;
  const LibraryFile& m_library;
  const BuildOptions& m_options;
  RowResult m_result;
};

}  // namespace

std::string digestOfInput(const fs::path& input, const Progress& progress) {
  std::error_code ignored;
  if (fs::is_directory(input, ignored))
    return digestOfFiles(listFiles<fs::recursive_directory_iterator>(input), input, progress);
  if (isHeader(input)) return digestOfFiles(filesOfHeader(input), input.parent_path(), progress);
  return digestOfFile(input).sha256;
}

Recipe makeRecipe(const BuildRow& row, const std::string& version, const std::string& shared,
                  const Progress& progress) {
  Recipe recipe;
  recipe.input = digestOfInput(row.input, progress);
  const nlohmann::json tree = {
      {"version", version},
      {"input", recipe.input},
      {"seeds", row.seeds.empty() ? "" : digestOfInput(row.seeds, progress)},
      {"options", row.options}};
  recipe.tree = sha256(tree.dump());
  const nlohmann::json all = {{"tree", recipe.tree},
                              {"id", row.id},
                              {"about", row.about},
                              {"targets", row.targets},
                              {"shared", shared}};
  recipe.all = sha256(all.dump());
  return recipe;
}

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

bool isStaged(const fs::path& staged, const std::string& id) {
  std::error_code ignored;
  return fs::exists(staged / kLibraryFile, ignored) && findCase(openLibrary(staged), id) != nullptr;
}

CaseRecord recordIn(const fs::path& library, const std::string& id) {
  const fs::path file = library / kPayload / id / kRecordFile;
  return readRecord(readWholeFile(file, "record"), file);
}

bool isMadeFrom(const fs::path& folder, const LibraryFile& library, const std::string& id,
                const std::string& recipe) {
  if (recipe.empty() || findCase(library, id) == nullptr) return false;
  try {
    return recordIn(folder, id).provenance.value("recipe_sha256", "") == recipe;
  } catch (const Error&) {
    return false;
  }
}

bool isResumedRow(const BuildRow& row, const LibraryFile& library, const BuildOptions& options) {
  return options.isResumed && !row.id.empty() && findCase(library, row.id) != nullptr;
}

std::string inputIsThatOf(std::size_t line) {
  return "its input is that of line " + std::to_string(line) + ", so it needs an id of its own";
}

void warnOfRow(Progress& progress, const RowResult& result) {
  warn(progress, {WarningCode::RowFailed, "line " + std::to_string(result.line) + " (" +
                                              formats::printable(result.id) + "): " + result.why});
}

RowResult makeRow(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options) {
  return RowMaker(plan, library, options).made();
}

}  // namespace lumen::convert
