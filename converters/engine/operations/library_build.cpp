// SPDX-License-Identifier: Apache-2.0
// lumen library build: the cases of a list, made and put into a library.
#include "converters/engine/library_build.h"

#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "converters/base/option_name.h"
#include "converters/engine/about_options.h"
#include "converters/engine/library_slurm.h"
#include "converters/engine/library_status.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"

namespace lumen::engine {

namespace {

constexpr int kLargestArray = 100000;

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

class LibraryBuildCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library build"; }
  [[nodiscard]] std::string summary() const override {
    return "Make the cases of a list, and put them into a library";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library init siphons --title \"Carotid siphons\" --licence CC-BY-4.0\n"
           "  lumen library build siphons.csv siphons --jobs 4\n"
           "  lumen library build siphons.csv siphons --slurm        # on a cluster\n"
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
    table.argument("LIBRARY", &m_slurm.library, "Library that lumen library init made");
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
    table.group("Slurm");
    table
        .flag("slurm", m_submits,
              "Submit the rows to Slurm: an array of tasks with --make-only, and a job with "
              "--collect that waits for them; --threads is the number of cores of a task [1]")
        .without("rows")
        .without("jobs")
        .without("make-only")
        .without("collect");
    table.add("array", &m_slurm.tasks, "N", "Tasks of the array, between which rows are dealt out")
        .in(WholeRange{1, kLargestArray})
        .defaults("one for each row, at most 1000")
        .onlyWith("slurm");
    table
        .flag("status", m_reports,
              "Report the state of every row, and of the jobs in Slurm; make nothing")
        .without("slurm")
        .without("jobs")
        .without(kOption.resume.name)
        .without("make-only")
        .without("collect");
  }

  Answer run(Surroundings& around) override {
    requireInScope(*around.table, {}, around.progress);
    convert::BuildList rows =
        loadBuildList(m_list, linesIn(m_lines).value_or(std::set<std::size_t>{}));
    if (m_reports) return buildStatus(rows, m_slurm.library, m_options, around);
    m_slurm.list = m_list;
    if (m_submits) return submitBuild(std::move(rows), m_slurm, m_options, around);
    if (m_makesOnly) m_options.phase = convert::BuildPhase::Make;
    if (m_collects) m_options.phase = convert::BuildPhase::Collect;
    return buildLibrary(std::move(rows), m_list, m_slurm.library, m_options, around);
  }

private:
  std::string m_list, m_lines;
  BuildArguments m_options;
  SlurmArguments m_slurm;
  bool m_makesOnly = false, m_collects = false, m_submits = false, m_reports = false;
};

}  // namespace

std::unique_ptr<Command> makeLibraryBuildCommand() {
  return std::make_unique<LibraryBuildCommand>();
}

}  // namespace lumen::engine
