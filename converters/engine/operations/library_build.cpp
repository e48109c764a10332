// SPDX-License-Identifier: Apache-2.0
// lumen library build: the cases of a list, made and put into a library.
#include "converters/engine/library_build.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "converters/base/options/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/library/rows/row_note.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::RowState, convert::RowStatus;

constexpr std::array<RowState, 7> kStates = {
    RowState::Kept,        RowState::Made,        RowState::Running, RowState::Waiting,
    RowState::Interrupted, RowState::NeedsPerson, RowState::Failed};

std::string wordOf(RowState state) {
  return state == RowState::Kept ? "in the library" : convert::rowWord(state);
}

std::string keyOf(RowState state) {
  if (state == RowState::Kept) return "in_library";
  return state == RowState::NeedsPerson ? "needs_person" : convert::rowWord(state);
}

std::string idOf(const RowStatus& state) {
  return state.note && !state.note->result.id.empty() ? state.note->result.id : state.row->id;
}

Json stateJson(const RowStatus& state) {
  Json json{{"row", state.row->line}, {"id", idOf(state)}, {"state", keyOf(state.state)},
            {"seconds", nullptr},     {"place", nullptr},  {"why", nullptr}};
  if (!state.note) return json;
  json["seconds"] = jsonNumber(state.note->result.seconds);
  if (!state.note->place.empty()) json["place"] = state.note->place;
  if (state.state == RowState::Failed || state.state == RowState::NeedsPerson)
    json["why"] = state.note->result.why;
  return json;
}

Json faultJson(const convert::RowFault& fault) {
  return Json{{"row", fault.line},  {"id", fault.id},   {"state", keyOf(RowState::Failed)},
              {"seconds", nullptr}, {"place", nullptr}, {"why", fault.why}};
}

/// A line for each row that needs a look.
std::string linesOf(const std::vector<RowStatus>& states) {
  std::string text;
  for (const RowStatus& state : states) {
    const bool isCut = state.state == RowState::Interrupted;
    if (!isCut && state.state != RowState::Failed && state.state != RowState::NeedsPerson) continue;
    const std::string why = isCut ? state.note->place : state.note->result.why;
    text += Lines()
                .add("line " + std::to_string(state.row->line) + " (" + idOf(state) +
                     "): " + wordOf(state.state) + ": " + why)
                .text();
  }
  return text;
}

/// The state of every row, by notes and the library, without reading an input. Throws
/// Error(InvalidInput) for a folder that is no library.
Answer buildStatus(const convert::BuildList& rows, const std::string& library,
                   const BuildArguments& arguments, const RunContext& context) {
  const convert::BuildOptions options = buildOptions(library, arguments, context);
  const std::vector<RowStatus> states = rowStates(rows.rows, library, options);
  Json json = Json::object();
  std::string counts;
  for (const RowState kind : kStates) {
    auto count = std::count_if(states.begin(), states.end(),
                               [kind](const RowStatus& row) { return row.state == kind; });
    if (kind == RowState::Failed) count += static_cast<std::ptrdiff_t>(rows.faults.size());
    json[keyOf(kind)] = count;
    if (count > 0)
      counts.append(counts.empty() ? "" : ", ").append(std::to_string(count) + " " + wordOf(kind));
  }
  json["rows"] = Json::array();
  for (const RowStatus& state : states) json["rows"].push_back(stateJson(state));
  for (const convert::RowFault& fault : rows.faults) json["rows"].push_back(faultJson(fault));
  std::string text = linesOf(states);
  for (const convert::RowFault& fault : rows.faults)
    text += Lines().add("line " + std::to_string(fault.line) + ": " + fault.why).text();
  text += formats::printable(library) + ": " + counted(json["rows"].size(), "row", "rows") + ": " +
          counts + "\n";
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
    addLinesRow(table, m_lines, "LIST");
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
    convert::BuildList rows = loadBuildList(m_list, linesIn(m_lines));
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
