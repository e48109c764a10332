// SPDX-License-Identifier: Apache-2.0
#include "converters/library/rows/row_note.h"

#include <algorithm>
#include <array>
#include <span>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/sha256.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/rows/build_row.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kNameLength = 32;  // hexadecimal digits

constexpr std::array<const char*, 7> kRowWords = {"waiting", "running", "interrupted",   "made",
                                                  "kept",    "failed",  "needs a person"};

RowState namedState(const JsonPlace& place) {
  const auto word = std::find(kRowWords.begin(), kRowWords.end(), place.text());
  if (word == kRowWords.end()) place.refuse("the state of a row");
  return static_cast<RowState>(word - kRowWords.begin());
}

fs::path noteFile(const fs::path& work, const std::string& name) {
  return work / "rows" / (name + ".json");
}

RowNote parseNote(const JsonPlace& json) {
  RowNote note;
  note.result.state = namedState(json.at("state"));
  note.result.id = json.at("id").text();
  note.result.seconds = json.at("seconds").number();
  note.result.code = static_cast<int>(json.at("code").number());
  note.result.why = json.at("why").text();
  note.result.warnings = static_cast<std::size_t>(json.at("warnings").number());
  note.result.log = json.at("log").text();
  for (const JsonPlace& word : json.at("view").elements()) note.result.view.push_back(word.text());
  note.recipe = json.at("recipe").text();
  note.folder = json.at("folder").text();
  note.staged = json.at("staged").text();
  note.place = json.at("place").text();
  return note;
}

RowState stateOfRow(const BuildRow& row, const std::optional<RowNote>& note, const fs::path& folder,
                    const LibraryFile& library, const fs::path& work) {
  if (!note) {
    const bool isThere = !row.id.empty() && findCase(library, row.id) != nullptr;
    return isThere ? RowState::Kept : RowState::Waiting;
  }
  const RowState noted = note->result.state;
  if (noted == RowState::Running)
    return RowLock::isHeld(work / note->folder) ? RowState::Running : RowState::Interrupted;
  if (noted != RowState::Made && noted != RowState::Kept) return noted;
  // its case is in one of two places, or gone
  if (!note->staged.empty() && isStaged(work / note->folder / note->staged, note->result.id))
    return RowState::Made;
  return isMadeFrom(folder, library, note->result.id, note->recipe) ? RowState::Kept
                                                                    : RowState::Waiting;
}

}  // namespace

const char* rowWord(RowState state) {
  return kRowWords.at(static_cast<std::size_t>(state));
}

std::string noteName(const BuildRow& row, const std::string& version, const std::string& shared) {
  const auto placeOf = [](const fs::path& path) {
    return path.empty() ? "" : fs::absolute(path).lexically_normal().string();
  };
  const nlohmann::json all = {{"version", version},
                              {"shared", shared},
                              {"input", formats::printable(placeOf(row.input))},
                              {"seeds", formats::printable(placeOf(row.seeds))},
                              {"id", row.id},
                              {"targets", row.targets},
                              {"options", row.options},
                              {"about", row.about}};
  return sha256(all.dump()).substr(0, kNameLength);
}

void writeNote(const fs::path& work, const std::string& name, const RowNote& note) {
  const nlohmann::ordered_json json = {{"state", rowWord(note.result.state)},
                                       {"id", note.result.id},
                                       {"seconds", note.result.seconds},
                                       {"code", note.result.code},
                                       {"why", note.result.why},
                                       {"warnings", note.result.warnings},
                                       {"log", note.result.log.string()},
                                       {"view", note.result.view},
                                       {"recipe", note.recipe},
                                       {"folder", note.folder},
                                       {"staged", note.staged},
                                       {"place", note.place}};
  const fs::path file = noteFile(work, name);
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) throw failed(formats::printable(file.parent_path().string()) + ": " + error.message());
  const std::string text =
      json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  const auto done = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
  if (!done) throw failed(formats::printable(file.string()) + ": " + done.error().message);
}

std::optional<RowNote> readNote(const fs::path& work, const std::string& name) {
  const fs::path file = noteFile(work, name);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  try {
    JsonFile read(readWholeFile(file, "note"), file);
    return parseNote(JsonPlace(read));
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<RowStatus> rowStates(const std::vector<BuildRow>& rows, const fs::path& library,
                                 const BuildOptions& options) {
  const LibraryFile file = openLibrary(library);
  std::vector<RowStatus> states;
  states.reserve(rows.size());
  for (const BuildRow& row : rows) {
    auto note = readNote(options.work, noteName(row, options.version, file.licence));
    const RowState state = stateOfRow(row, note, library, file, options.work);
    states.push_back({state, &row, std::move(note)});
  }
  return states;
}

}  // namespace lumen::convert
