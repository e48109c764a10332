// SPDX-License-Identifier: Apache-2.0
#include "converters/library/batch/batch_case.h"

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <system_error>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/options/option_name.h"
#include "converters/base/sha256.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/rows/build_row.h"
#include "converters/operations/tracked_vessels.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

/// The result of an earlier run for an input, and digests of all that it depends on.
struct Note {
  std::string recipe;  ///< of the input, its options and lumen's version
  std::string judge;   ///< of the profile, and whether a person accepted the case
  std::string made;    ///< of the case as convert wrote it
  std::string judged;  ///< of the case as it was judged
  BatchResult result;
};

BatchEnd namedEnd(const JsonPlace& place) {
  for (const BatchEnd end :
       {BatchEnd::Passed, BatchEnd::NeedsPerson, BatchEnd::NoVessels, BatchEnd::Failed})
    if (place.text() == batchWord(end)) return end;
  place.refuse("the end of an input");
}

nlohmann::ordered_json noteJson(const Note& note) {
  const BatchResult& result = note.result;
  nlohmann::ordered_json json = {
      {"recipe", note.recipe}, {"judge", note.judge},          {"made", note.made},
      {"judged", note.judged}, {"end", batchWord(result.end)}, {"why", result.why},
      {"code", result.code},   {"seconds", result.seconds},    {"warnings", result.warnings},
      {"at", result.at}};
  if (const auto& f = result.figures)
    json["figures"] = {f->vessels, f->trees, f->links, f->length, f->least, f->greatest};
  return json;
}

Note parseNote(const JsonPlace& json) {
  Note note{json.at("recipe").text(),
            json.at("judge").text(),
            json.at("made").text(),
            json.at("judged").text(),
            {}};
  BatchResult& result = note.result;
  result.end = namedEnd(json.at("end"));
  result.why = json.at("why").text();
  result.code = static_cast<int>(json.at("code").number());
  result.seconds = json.at("seconds").number();
  result.warnings = static_cast<std::size_t>(json.at("warnings").number());
  result.at = json.at("at").text();
  if (!json.has("figures")) return note;
  std::array<double, 6> f{};
  const auto values = json.at("figures").elements();
  if (values.size() != f.size()) json.at("figures").refuse("six numbers");
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = values[i].number();
  result.figures = BatchFigures{static_cast<std::size_t>(f[0]),
                                static_cast<std::size_t>(f[1]),
                                static_cast<std::size_t>(f[2]),
                                f[3],
                                f[4],
                                f[5]};
  return note;
}

class CaseMaker {
public:
  CaseMaker(const BatchInput& input, const fs::path& folder, const BuildOptions& options,
            Progress& progress)
      : m_input(input),
        m_row(input.row),
        m_folder(folder),
        m_options(options),
        m_progress(progress) {
    m_now.result.id = m_row.id;
    m_now.result.name = input.name;
  }

  BatchResult run() {
    m_now.recipe = makeRecipe(m_row, m_options.version, "", m_progress).tree;
    m_now.judge = judgeDigest();
    makeFolders();
    const RowLock lock(noteFile(), m_progress);
    m_before = earlierNote();
    if (isDone()) return kept();
    leaveBeginning();
    if (made() && described()) judge();
    std::error_code ignored;
    if (!m_isOthers && fs::exists(caseFile(), ignored)) draw();
    cleanLog();
    leaveNote();
    return m_now.result;
  }

private:
  [[nodiscard]] fs::path caseFile() const { return m_folder / batchCase(m_row.id); }
  [[nodiscard]] fs::path logFile() const { return m_folder / batchLog(m_row.id); }
  [[nodiscard]] fs::path noteFile() const { return m_folder / "rows" / (m_row.id + ".json"); }
  [[nodiscard]] bool isAccepted() const { return m_options.accepted.contains(m_row.id); }

  void makeFolders() const {
    for (const fs::path& file : {noteFile(), logFile(), m_folder / batchPicture(m_row.id)}) {
      std::error_code error;
      fs::create_directories(file.parent_path(), error);
      if (error)
        throw failed(formats::printable(file.parent_path().string()) + ": " + error.message());
    }
  }

  [[nodiscard]] std::string judgeDigest() const {
    const bool isFile = m_options.profile.ends_with(".json");
    const std::string profile =
        isFile ? readWholeFile(m_options.profile, "profile") : m_options.profile;
    return sha256(profile + (isAccepted() ? " accepted" : ""));
  }

  [[nodiscard]] std::optional<Note> earlierNote() const {
    std::error_code ignored;
    if (!fs::exists(noteFile(), ignored)) return std::nullopt;
    try {
      JsonFile read(readWholeFile(noteFile(), "note"), noteFile());
      return parseNote(JsonPlace(read));
    } catch (const Error&) {
      return std::nullopt;  // a note of another version, or of nobody: the case is made anew
    }
  }

  [[nodiscard]] std::string digestOfCase() const {
    std::error_code ignored;
    return fs::exists(caseFile(), ignored) ? digestOfFile(caseFile()).sha256 : "";
  }

  /// Whether an earlier run leaves nothing to do. A failure is tried again.
  [[nodiscard]] bool isDone() const {
    return m_before && m_before->recipe == m_now.recipe && m_before->judge == m_now.judge &&
           m_before->result.end != BatchEnd::Failed && m_before->judged == digestOfCase();
  }

  [[nodiscard]] BatchResult kept() const {
    BatchResult result = m_before->result;
    result.id = m_row.id;
    result.name = m_input.name;
    result.isKept = true;
    return result;
  }

  /// Notes that the case may be another one from now on, should this run be ended.
  void leaveBeginning() const {
    std::error_code ignored;
    fs::remove(logFile(), ignored);
    std::error_code error;
    if (!m_before && fs::exists(caseFile(), error)) return;  // somebody's
    Note begun = m_now;
    if (m_before) begun.made = m_before->made;
    if (m_before && m_before->recipe != m_now.recipe) begun.recipe.clear();
    begun.result.why = "its run was ended before it was made";
    writeNote(begun);
  }

  /// Whether there is a case of this recipe: that of an earlier run, however a person has changed
  /// it, or a new one.
  bool made() {
    std::error_code ignored;
    const bool isThere = fs::exists(caseFile(), ignored);
    if (isThere && m_before && m_before->recipe == m_now.recipe && !m_before->made.empty()) {
      m_now.made = m_before->made;
      return true;
    }
    const bool isCorrected = isThere && m_before && digestOfCase() != m_before->made;
    if (isThere && !m_before) {
      m_isOthers = true;
      end(BatchEnd::Failed, static_cast<int>(ErrorKind::Failed),
          formats::printable(batchCase(m_row.id).string()) +
              ": is there already, and no batch made it; expected a folder of batches alone");
      return false;
    }
    Operation convert{
        "convert", {fs::absolute(m_row.input).string(), fs::absolute(caseFile()).string()}, {}};
    if (!m_row.seeds.empty()) convert.with(kOption.seeds.name, fs::absolute(m_row.seeds).string());
    for (const auto& [name, value] : m_row.options) convert.with(name.substr(2), value);
    if (isCorrected) keepChanged();
    if (isCorrected && m_options.isVolume(m_row))
      convert.with("corrections", fs::absolute(caseFile()).string());
    const OperationEnd done = timed(convert);
    if (!done.isDone) {
      const bool isEmpty = done.error.find(operations::kNoVesselsFound) != std::string::npos;
      end(isEmpty ? BatchEnd::NoVessels : BatchEnd::Failed, done.code, done.error);
      if (isEmpty) fs::remove(caseFile(), ignored);
      return false;
    }
    m_now.made = digestOfCase();
    return true;
  }

  /// Copies a case that a person has changed to replaced/, as another takes its place.
  void keepChanged() const {
    constexpr std::size_t kShortDigest = 12;
    const fs::path copy = m_folder / "replaced" /
                          (m_row.id + "-" + digestOfCase().substr(0, kShortDigest) + ".lumen");
    std::error_code error;
    fs::create_directories(copy.parent_path(), error);
    if (!error) fs::copy_file(caseFile(), copy, fs::copy_options::overwrite_existing, error);
    if (error) throw failed(formats::printable(copy.string()) + ": " + error.message());
  }

  /// Reads the key figures of the case.
  bool described() {
    const OperationEnd info = timed({"info", {fs::absolute(caseFile()).string()}, {}});
    if (info.answer.empty()) {
      end(BatchEnd::Failed, info.code, info.error);
      return false;
    }
    JsonFile answer(info.answer, "answer of lumen info");
    const JsonPlace json(answer);
    const auto count = [&json](const char* key) {
      return static_cast<std::size_t>(json.at(key).number());
    };
    BatchFigures figures{json.at("branches").elements().size(),
                         count("trees"),
                         count("links"),
                         json.at("length_mm").number(),
                         0,
                         0};
    const JsonPlace radius = json.at("radius_mm");
    if (!radius.value().isNull()) {
      figures.least = radius.at("min").number();
      figures.greatest = radius.at("max").number();
    }
    m_now.result.figures = figures;
    return true;
  }

  void judge() {
    m_now.result.end = BatchEnd::Passed;
    m_now.judged = digestOfCase();
    if (isAccepted() || m_options.profile.empty() || !m_options.isVolume(m_row)) return;
    Operation check{
        "check", {fs::absolute(m_row.input).string(), fs::absolute(caseFile()).string()}, {}};
    check.with("profile", m_options.profile);
    for (const auto& [name, value] : m_row.options)
      if (m_options.checkOptions.contains(name.substr(2))) check.with(name.substr(2), value);
    const OperationEnd done = timed(check);
    if (done.answer.empty()) return end(BatchEnd::Failed, done.code, done.error);
    JsonFile answer(done.answer, "answer of lumen check");
    const JsonPlace verdict = JsonPlace(answer).at("verdict");
    if (verdict.at("passes").boolean()) return;
    std::string sentence = verdict.at("sentence").text();
    const std::string word = batchWord(BatchEnd::NeedsPerson) + std::string(": ");
    if (sentence.starts_with(word)) sentence.erase(0, word.size());
    end(BatchEnd::NeedsPerson, done.code, sentence);
    const std::vector<JsonPlace> words = verdict.at("view").elements();
    if (!words.empty()) m_now.result.at = words.back().text();
  }

  /// A picture that cannot be drawn is a warning in the log.
  void draw() {
    const fs::path picture = m_folder / batchPicture(m_row.id);
    (void)timed(Operation{
        "picture",
        {fs::absolute(caseFile()).string(), fs::absolute(picture).string()},
        {}}.with("size", kPictureSize));
  }

  void end(BatchEnd end, int code, const std::string& why) {
    m_now.result.end = end;
    m_now.result.code = code;
    m_now.result.why = shown(why);
  }

  /// A message without the folders of this machine.
  [[nodiscard]] std::string shown(std::string text) const {
    const auto replace = [&text](const std::string& part, const std::string& by) {
      if (part.empty()) return;
      for (std::size_t at = text.find(part); at != std::string::npos;
           at = text.find(part, at + by.size()))
        text.replace(at, part.size(), by);
    };
    replace(fs::absolute(m_row.input).string(), m_input.name);
    if (!m_row.seeds.empty())
      replace(fs::absolute(m_row.seeds).string(), m_row.seeds.filename().string());
    replace((fs::absolute(m_folder) / "").string(), "");
    return text;
  }

  void cleanLog() const {
    std::error_code ignored;
    if (!fs::exists(logFile(), ignored)) return;
    const std::string text = shown(readWholeFile(logFile(), "log"));
    if (text.empty())
      fs::remove(logFile(), ignored);
    else
      writeAtomically(text, logFile());
  }

  static void writeAtomically(const std::string& text, const fs::path& file) {
    const auto done = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
    if (!done) throw failed(formats::printable(file.string()) + ": " + done.error().message);
  }

  OperationEnd timed(const Operation& operation) {
    const auto begin = std::chrono::steady_clock::now();
    OperationEnd done = m_options.run(operation, logFile());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    m_now.result.seconds += took.count();
    m_now.result.warnings += done.warnings;
    return done;
  }

  void leaveNote() const {
    if (m_isOthers) return;
    writeNote(m_now);
  }

  void writeNote(const Note& note) const {
    const std::string text =
        noteJson(note).dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    writeAtomically(text, noteFile());
  }

  static constexpr const char* kPictureSize = "600x480";
  const BatchInput& m_input;
  const BuildRow& m_row;
  const fs::path& m_folder;
  const BuildOptions& m_options;
  Progress& m_progress;
  std::optional<Note> m_before;
  Note m_now;
  bool m_isOthers = false;  ///< the case under this name is no batch's
};

}  // namespace

BatchResult makeBatchCase(const BatchInput& input, const fs::path& folder,
                          const BuildOptions& options, Progress& progress) {
  return CaseMaker(input, folder, options, progress).run();
}

}  // namespace lumen::convert
