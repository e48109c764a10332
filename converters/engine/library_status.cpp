// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/library_status.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "converters/engine/library_slurm.h"
#include "converters/engine/slurm.h"
#include "converters/library/row_state.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

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

Json jobJson(const std::string& id, const char* task, const Progress& progress) {
  return Json{{"id", id}, {"task", task}, {"states", jobStates(id, progress)}};
}

std::string jobText(const Json& job) {
  std::string states;
  for (const auto& state : job.at("states"))
    states += (states.empty() ? "" : ", ") + state.get<std::string>();
  return "job " + job.at("id").get<std::string>() + " (" + job.at("task").get<std::string>() +
         "): " + (states.empty() ? "ended" : states);
}

Json jobsOf(const fs::path& work, const Progress& progress) {
  const SlurmJobs jobs = submittedJobs(work);
  Json list = Json::array();
  if (!jobs.array.empty()) list.push_back(jobJson(jobs.array, "make", progress));
  if (!jobs.collect.empty()) list.push_back(jobJson(jobs.collect, "collect", progress));
  return list;
}

}  // namespace

Answer buildStatus(const convert::BuildList& rows, const std::string& library,
                   const BuildArguments& arguments, const Surroundings& around) {
  const convert::BuildOptions options = buildOptions(library, arguments, around);
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
  json["jobs"] = jobsOf(options.work, around.progress);
  std::string text = linesOf(states);
  for (const convert::RowFault& fault : rows.faults)
    text += Lines().add("line " + std::to_string(fault.line) + ": " + fault.why).text();
  for (const Json& job : json["jobs"]) text += Lines().add(jobText(job)).text();
  text += formats::printable(library) + ": " + counted(json["rows"].size(), "row", "rows") + ": " +
          (counts.empty() ? "" : counts.substr(2)) + "\n";
  return {std::move(json), text, 0, true};
}

}  // namespace lumen::engine
