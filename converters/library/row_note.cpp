// SPDX-License-Identifier: Apache-2.0
// Declared in row_state.h.
#include <array>
#include <span>
#include <system_error>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/sha256.h"
#include "converters/library/row_state.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

using State = RowNote::State;

constexpr std::size_t kNameLength = 32;  // hexadecimal digits

struct NamedState {
  State state;
  const char* name;
};
constexpr std::array<NamedState, 5> kStates = {{{State::Running, "running"},
                                                {State::Made, "made"},
                                                {State::Kept, "kept"},
                                                {State::Failed, "failed"},
                                                {State::NeedsPerson, "needs-person"}}};

const char* stateName(State state) {
  for (const auto& [value, name] : kStates)
    if (value == state) return name;
  return "";
}

State namedState(const JsonPlace& place) {
  for (const auto& [value, name] : kStates)
    if (place.text() == name) return value;
  place.refuse("running, made, kept, failed or needs-person");
}

RowEnd endOf(State state) {
  if (state == State::Made) return RowEnd::Made;
  if (state == State::NeedsPerson) return RowEnd::NeedsPerson;
  return state == State::Kept ? RowEnd::Kept : RowEnd::Failed;
}

fs::path noteFile(const fs::path& work, const std::string& name) {
  return work / "rows" / (name + ".json");
}

RowNote parseNote(const JsonPlace& json) {
  RowNote note;
  note.state = namedState(json.at("state"));
  note.result.end = endOf(note.state);
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

}  // namespace

State RowNote::stateOf(RowEnd end) {
  switch (end) {
    case RowEnd::Made:
      return State::Made;
    case RowEnd::Kept:
      return State::Kept;
    case RowEnd::NeedsPerson:
      return State::NeedsPerson;
    case RowEnd::Failed:
      break;
  }
  return State::Failed;
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
  const nlohmann::ordered_json json = {
      {"state", stateName(note.state)},  {"id", note.result.id},
      {"seconds", note.result.seconds},  {"code", note.result.code},
      {"why", note.result.why},          {"warnings", note.result.warnings},
      {"log", note.result.log.string()}, {"view", note.result.view},
      {"recipe", note.recipe},           {"folder", note.folder},
      {"staged", note.staged},           {"place", note.place}};
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

}  // namespace lumen::convert
