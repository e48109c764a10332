// SPDX-License-Identifier: Apache-2.0
// lumen library build: the cases of a list, made and put into a library.
#include "converters/engine/library_build.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "converters/base/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/library/row_state.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

/// "2,5,9" as numbers; nothing for another text.
std::optional<std::set<std::size_t>> linesIn(const std::string& text) {
  std::set<std::size_t> lines;
  const char* const last = text.data() + text.size();
  for (const char* at = text.data();; ++at) {
    std::size_t line = 0;
    const auto [end, error] = std::from_chars(at, last, line);
    if (error != std::errc{} || line == 0) return std::nullopt;
    lines.insert(line);
    if (end == last) return lines;
    if (*end != ',') return std::nullopt;
    at = end;
  }
}

std::string lineListFault(const std::string& text) {
  return linesIn(text) ? "" : foundText(text, "numbers of lines such as 2,5,9");
}

using convert::RowState;
using Kind = convert::RowState::Kind;

constexpr std::array<Kind, 7> kKinds = {Kind::InLibrary, Kind::Made,        Kind::Running,
                                        Kind::Waiting,   Kind::Interrupted, Kind::NeedsPerson,
                                        Kind::Failed};

std::string keyOf(Kind kind) {
  std::string key = convert::stateWord(kind);
  if (kind == Kind::InLibrary) key = "in_library";
  if (kind == Kind::NeedsPerson) key = "needs_person";
  return key;
}

std::size_t countOf(const std::vector<RowState>& states, Kind kind) {
  return static_cast<std::size_t>(std::count_if(states.begin(), states.end(),
                                                [kind](const auto& s) { return s.kind == kind; }));
}

std::string idOf(const RowState& state) {
  return state.note && !state.note->result.id.empty() ? state.note->result.id : state.row->id;
}

Json stateJson(const RowState& state) {
  Json json{{"row", state.row->line}, {"id", idOf(state)}, {"state", keyOf(state.kind)},
            {"seconds", nullptr},     {"place", nullptr},  {"why", nullptr}};
  if (!state.note) return json;
  json["seconds"] = jsonNumber(state.note->result.seconds);
  if (!state.note->place.empty()) json["place"] = state.note->place;
  if (state.kind == Kind::Failed || state.kind == Kind::NeedsPerson)
    json["why"] = state.note->result.why;
  return json;
}

Json faultJson(const convert::RowFault& fault) {
  return Json{{"row", fault.line},  {"id", fault.id},   {"state", keyOf(Kind::Failed)},
              {"seconds", nullptr}, {"place", nullptr}, {"why", fault.why}};
}

/// A line for each row that needs a look.
std::string linesOf(const std::vector<RowState>& states) {
  std::string text;
  for (const RowState& state : states) {
    const bool isCut = state.kind == Kind::Interrupted;
    if (!isCut && state.kind != Kind::Failed && state.kind != Kind::NeedsPerson) continue;
    const std::string why = isCut ? state.note->place : state.note->result.why;
    text += Lines()
                .add("line " + std::to_string(state.row->line) + " (" + idOf(state) +
                     "): " + convert::stateWord(state.kind) + ": " + why)
                .text();
  }
  return text;
}

/// The state of every row, by notes and the library, without reading an input. Throws
/// Error(InvalidInput) for a folder that is no library.
Answer buildStatus(const convert::BuildList& rows, const std::string& library,
                   const BuildArguments& arguments, const RunContext& context) {
  const convert::BuildOptions options = buildOptions(library, arguments, context);
  const std::vector<RowState> states = rowStates(rows.rows, library, options);
  Json json = Json::object();
  std::string counts;
  for (const Kind kind : kKinds) {
    const std::size_t unread = kind == Kind::Failed ? rows.faults.size() : 0;
    const std::size_t count = countOf(states, kind) + unread;
    json[keyOf(kind)] = count;
    if (count > 0)
      counts += std::string(", ")
                    .append(std::to_string(count))
                    .append(" ")
                    .append(convert::stateWord(kind));
  }
  json["rows"] = Json::array();
  for (const RowState& state : states) json["rows"].push_back(stateJson(state));
  for (const convert::RowFault& fault : rows.faults) json["rows"].push_back(faultJson(fault));
  std::string text = linesOf(states);
  for (const convert::RowFault& fault : rows.faults)
    text += Lines().add("line " + std::to_string(fault.line) + ": " + fault.why).text();
  text += formats::printable(library) + ": " + counted(json["rows"].size(), "row", "rows") + ": " +
          (counts.empty() ? "" : counts.substr(2)) + "\n";
  return {std::move(json), text, 0, true};
}

class LibraryBuildCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library build"; }
  [[nodiscard]] std::string summary() const override {
    return "Make the cases of a list, and put them into a library";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library init siphons --title \"Carotid siphons\" --licence CC-BY-4.0\n"
           "  lumen library build siphons.csv siphons --jobs 4\n"
           "  lumen library build siphons.csv siphons --status\n"
           "A list begins with a row of names, such as\n"
           "  input,seeds,id,targets,title,synthetic,consent,deidentification,--crop";
  }

  void addRows(OptionTable& table) override {
    table.argument(
        "LIST", &m_list,
        "Comma-separated values: a row for each case, with input (a volume, mesh, centerline "
        "or case), seeds, id, targets of lumen export and codes (with ; between), title, "
        "description, anatomy, laterality, modality, synthetic, licence, attribution, doi, "
        "origin, consent, deidentification, and any option of lumen convert");
    table.argument("LIBRARY", &m_library, "Library that lumen library init made");
    addBuildRows(table, m_options);
    table.add(
        "profile", &m_options.profile, "NAME",
        "Judge the cases of volumes as lumen check --profile does: one that needs a person stays "
        "out of the library, and its row names the place to look at");
    table
        .add("accept", &m_options.accepted, "ID",
             "A person has looked at this case, and it goes in as it is; may be repeated")
        .many()
        .checkedBy(caseIdText());
    table.flag(
        "keep-going", m_options.keepGoing,
        "Make the other rows where some have a fault that is seen before any work, such as a "
        "missing input; otherwise nothing is made then");
    table.flag(kOption.resume.name, m_options.isResumed,
               "Keep each case that the library has by its id, without reading its inputs again");
    table
        .add("rows", &m_lines, "LINES",
             "Only the rows that begin on these lines of LIST, with commas between them")
        .checkedBy(&lineListFault);
    table.flag("make-only", m_makesOnly, "Leave the cases in the folder of the work, for --collect")
        .without("collect");
    table.flag("collect", m_collects,
               "Put the cases that --make-only left into the library, as one revision, and make "
               "none");
    table.flag("status", m_reports, "Report the state of every row; make nothing")
        .without("jobs")
        .without(kOption.resume.name)
        .without("make-only")
        .without("collect");
  }

  Answer run(const RunContext& context) override {
    requireInScope(*context.table, {}, context.progress);
    convert::BuildList rows =
        loadBuildList(m_list, linesIn(m_lines).value_or(std::set<std::size_t>{}));
    if (m_reports) return buildStatus(rows, m_library, m_options, context);
    if (m_makesOnly) m_options.phase = convert::BuildPhase::Make;
    if (m_collects) m_options.phase = convert::BuildPhase::Collect;
    return buildLibrary(std::move(rows), m_list, m_library, m_options, context);
  }

private:
  std::string m_list, m_library, m_lines;
  BuildArguments m_options;
  bool m_makesOnly = false, m_collects = false, m_reports = false;
};

}  // namespace

std::unique_ptr<Command> makeLibraryBuildCommand() {
  return std::make_unique<LibraryBuildCommand>();
}

}  // namespace lumen::engine
