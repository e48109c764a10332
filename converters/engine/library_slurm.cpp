// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/library_slurm.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operation_process.h"
#include "converters/engine/slurm.h"
#include "converters/engine/slurm_request.h"
#include "converters/library/row_state.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

using convert::BuildOptions, convert::BuildRow, convert::RowsToMake;

constexpr int kMostTasks = 1000;  // Slurm's MaxArraySize is 1001 unless a cluster sets another
constexpr const char* kJobsFile = "jobs.json";
// a collection reads the records and copies the files of all cases of the library
constexpr int kCollectMegabytes = 2000, kCollectMinutes = 240;

fs::path slurmFolder(const fs::path& work) {
  return work / kSlurmFolder;
}

/// A file name as Slurm's --output takes it.
std::string outputPattern(const fs::path& folder, const std::string& pattern) {
  std::string name;
  for (const char c : folder.string()) name += c == '%' ? std::string("%%") : std::string(1, c);
  return name + "/" + pattern;
}

/// The jobs of one submission.
class Submission {
public:
  Submission(const SlurmArguments& slurm, const BuildArguments& arguments, BuildOptions options,
             const Surroundings& around)
      : m_slurm(slurm),
        m_arguments(arguments),
        m_options(std::move(options)),
        m_around(around),
        m_folder(slurmFolder(fs::absolute(m_options.work))) {}

  Answer run(const std::vector<BuildRow>& rows) {
    refuseSecond();
    convert::claimWorkFolder(m_options.work);
    const RowsToMake found = findRowsToMake(rows, m_slurm.library, m_options, m_around.progress);
    if (found.lines.empty() && found.staged == 0) {
      convert::removeWorkFolder(m_options.work);
      return answer(found, 0);
    }
    std::error_code error;
    fs::create_directories(m_folder, error);
    if (error) throw failed(formats::printable(m_folder.string()) + ": " + error.message());
    const int most = m_slurm.tasks > 0 ? m_slurm.tasks : kMostTasks;
    const int tasks = std::min(most, static_cast<int>(found.lines.size()));
    if (tasks > 0) submitArray(rows, found, tasks);
    submitCollection();
    writeText(Json{{"array", m_jobs.array}, {"collect", m_jobs.collect}}.dump() + "\n",
              m_folder / kJobsFile);
    return answer(found, tasks);
  }

private:
  void refuseSecond() const {
    const SlurmJobs before = submittedJobs(m_options.work);
    for (const std::string& id : {before.array, before.collect})
      if (!id.empty() && !jobStates(id, m_around.progress).empty())
        throw failed(formats::printable(m_slurm.library) + ": job " + id +
                     " of the last submission is in Slurm's queue still; scancel " + id +
                     " ends it");
  }

  /// The command that both scripts run, but for its own options.
  [[nodiscard]] std::string command() const {
    const auto word = [](const fs::path& path) { return shellWord(fs::absolute(path).string()); };
    std::string text = "exec " + shellWord(thisProgram().string()) + " library build " +
                       word(m_slurm.list) + " " + word(m_slurm.library) + " --work " +
                       word(m_options.work) + " --json";
    if (m_arguments.isResumed) text += " --resume";
    if (m_arguments.keepGoing) text += " --keep-going";
    if (!m_options.profile.empty()) text += " --profile " + shellWord(m_options.profile);
    for (const std::string& id : m_arguments.accepted) text += " --accept " + shellWord(id);
    if (m_around.strict) text += " --strict";
    return text;
  }

  [[nodiscard]] static std::string header(const SlurmRequest& request, int cores) {
    return "#!/bin/sh\n"
           "# lumen library build wrote this script and submitted it.\n"
           "#SBATCH --cpus-per-task=" +
           std::to_string(cores) + "\n#SBATCH --mem=" + std::to_string(request.megabytes) +
           "M\n#SBATCH --time=" + std::to_string(request.minutes) +
           "\n#SBATCH --requeue\n#SBATCH --open-mode=append\n";
  }

  void submitArray(const std::vector<BuildRow>& rows, const RowsToMake& found, int tasks) {
    const int cores = std::max(1, m_around.threads);
    const fs::path lines = m_folder / "lines";
    writeText(linesOfTasks(found, tasks), lines);
    writeText(header(requestOfTask(rows, found, tasks), cores) + command() +
                  " --make-only --threads " + std::to_string(cores) + " --rows \"$(sed -n " +
                  "\"${SLURM_ARRAY_TASK_ID}p\" " + shellWord(lines.string()) + ")\"\n",
              m_folder / "make.sh");
    m_jobs.array = submitJob({"--array=1-" + std::to_string(tasks), "--job-name=lumen-make",
                              "--output=" + outputPattern(m_folder, "make-%A_%a.txt")},
                             m_folder / "make.sh", m_around.progress);
  }

  void submitCollection() {
    writeText(header({kCollectMegabytes, kCollectMinutes}, 1) + command() + " --collect\n",
              m_folder / "collect.sh");
    std::vector<std::string> options = {"--job-name=lumen-collect",
                                        "--output=" + outputPattern(m_folder, "collect-%j.txt")};
    if (!m_jobs.array.empty()) options.push_back("--dependency=afterany:" + m_jobs.array);
    try {
      m_jobs.collect = submitJob(options, m_folder / "collect.sh", m_around.progress);
    } catch (const Error&) {
      if (!m_jobs.array.empty()) cancelJob(m_jobs.array, m_around.progress);
      throw;
    }
  }

  /// A line for each task: the rows that it makes, dealt out like cards.
  [[nodiscard]] static std::string linesOfTasks(const RowsToMake& found, int tasks) {
    const auto step = static_cast<std::size_t>(tasks);
    std::string text;
    for (std::size_t task = 0; task < step; ++task) {
      std::string line;
      for (std::size_t i = task; i < found.lines.size(); i += step)
        line += (line.empty() ? "" : ",") + std::to_string(found.lines[i]);
      text += line + "\n";
    }
    return text;
  }

  /// Memory of the largest row, and time of the slowest for each row of a task.
  [[nodiscard]] SlurmRequest requestOfTask(const std::vector<BuildRow>& rows,
                                           const RowsToMake& found, int tasks) const {
    const std::set<std::size_t> lines(found.lines.begin(), found.lines.end());
    SlurmRequest all;
    for (const BuildRow& row : rows) {
      if (!lines.contains(row.line)) continue;
      const SlurmRequest one = requestOf(row, m_around.progress);
      all.megabytes = std::max(all.megabytes, one.megabytes);
      all.minutes = std::max(all.minutes, one.minutes);
    }
    const auto perTask = (found.lines.size() + static_cast<std::size_t>(tasks) - 1) /
                         static_cast<std::size_t>(tasks);
    all.minutes *= static_cast<int>(perTask);
    return all;
  }

  [[nodiscard]] Answer answer(const RowsToMake& found, int tasks) const {
    const auto orNull = [](const std::string& id) { return id.empty() ? Json() : Json(id); };
    const std::string name = formats::printable(m_slurm.library) + ": ";
    std::string text = name + counted(found.lines.size(), "row", "rows") + " to make, " +
                       std::to_string(found.staged) + " made, " + std::to_string(found.kept) +
                       " in the library\n";
    if (m_jobs.collect.empty()) text += name + "nothing to do, so nothing was submitted\n";
    if (!m_jobs.array.empty())
      text += name + "job " + m_jobs.array + " makes them in " +
              counted(static_cast<std::size_t>(tasks), "task", "tasks") + "\n";
    if (!m_jobs.collect.empty())
      text += name + "job " + m_jobs.collect +
              " collects; lumen library build LIST LIBRARY --status reports, and scripts and "
              "outputs are in " +
              formats::printable(m_folder.string()) + "\n";
    return {Json{{"array", orNull(m_jobs.array)},
                 {"collect", orNull(m_jobs.collect)},
                 {"tasks", tasks},
                 {"to_make", found.lines.size()},
                 {"made", found.staged},
                 {"in_library", found.kept}},
            text};
  }

  const SlurmArguments& m_slurm;
  const BuildArguments& m_arguments;
  BuildOptions m_options;
  const Surroundings& m_around;
  fs::path m_folder;
  SlurmJobs m_jobs;
};

}  // namespace

SlurmJobs submittedJobs(const fs::path& work) {
  const fs::path file = slurmFolder(work) / kJobsFile;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  convert::JsonFile read(readWholeFile(file, "jobs"), file);
  const convert::JsonPlace json(read);
  return {json.at("array").text(), json.at("collect").text()};
}

Answer submitBuild(convert::BuildList rows, const SlurmArguments& slurm,
                   const BuildArguments& arguments, const Surroundings& around) {
  judgeRows(rows, slurm.list, slurm.library, arguments, around.engine);
  for (const convert::RowFault& fault : rows.faults)
    around.progress.warn("line " + std::to_string(fault.line) + ": " + fault.why);
  return Submission(slurm, arguments, buildOptions(slurm.library, arguments, around), around)
      .run(rows.rows);
}

}  // namespace lumen::engine
