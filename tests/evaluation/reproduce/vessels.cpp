// SPDX-License-Identifier: Apache-2.0
// lumen_vessels [--no-parents] [--near] [--track-only] [--tag NAME] LUMEN FOLDER CASE...: how much of
// the vessels that were clicked the program LUMEN finds. A CASE is an SWC file, drawn in voxels of
// 0.3 mm with 6 % of noise, or patient-K, the synthetic patient of random seed K. --near moves the
// clicks to one radius from where the axis begins, within the parent's lumen. FOLDER keeps the
// volumes, which are made if they are missing, and everything else that is read or written; what
// LUMEN makes of a case has NAME ("lumen") in its name. Writes NAME.md and NAME.json there.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/cli/terminal_progress.h"
#include "converters/io/seeds/seeds.h"
#include "formats/case/case_file.h"
#include "report.h"
#include "vessel_score.h"

namespace {

using namespace lumen;
using namespace lumen::reproduce;
namespace fs = std::filesystem;

/// The whole file. Throws Error(Failed).
std::string readText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw failed(file.string() + ": cannot be read");
  return text.str();
}

struct TimedRun {
  double wall = 0;       ///< seconds
  double processor = 0;  ///< seconds of its own, of all cores together
};

[[noreturn]] void become(std::vector<std::string> words, const fs::path& out, const fs::path& err) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  if (dup2(creat(out.c_str(), 0600), 1) < 0 || dup2(creat(err.c_str(), 0600), 2) < 0) _exit(126);
  execv(argv[0], argv.data());
  _exit(127);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Runs `program` with its standard output and error in files, which are overwritten. Throws
/// Error(Failed) unless it exits with 0; the message ends with what it wrote to standard error.
TimedRun runTimed(const fs::path& program, const std::vector<std::string>& arguments,
                  const fs::path& out, const fs::path& err) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) become(words, out, err);
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child)
    throw failed(program.string() + ": cannot be run");
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw failed(program.string() + " " + arguments.at(0) + ": failed: " + readText(err));
  return {wall.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

struct Arguments {
  bool parents = true;
  bool near = false;  ///< clicks one radius from where the vessel's axis begins
  bool fit = true;    ///< otherwise there is no wall, and nothing to reach
  std::string tag = "lumen";
  fs::path lumen, folder;
  std::vector<std::string> cases;
};

/// Files of one case, and what came of it.
struct Result {
  std::string name;
  bool tree = false;  ///< from an SWC file
  std::size_t clicks = 0, started = 0;
  TimedRun track, fit;
  std::set<std::string> failed;  ///< labels
  VesselScore score;
};

formats::Case readCase(const fs::path& file) {
  formats::Expected<formats::Case> value = formats::readCaseFile(file);
  if (!value) throw invalidInput(value.error().text());
  return *std::move(value);
}

/// Writes FOLDER/NAME.nrrd, NAME.json (the clicks) and NAME-t.lumen (the truth).
void makeVolume(const Arguments& arguments, const std::string& subject, const std::string& name) {
  const std::string stem = (arguments.folder / name).string();
  if (fs::exists(stem + ".nrrd") && fs::exists(stem + ".json") && fs::exists(stem + "-t.lumen"))
    return;
  std::vector<std::string> words{"phantom"};
  if (subject.ends_with(".swc"))
    words.insert(words.end(),
                 {"--tree", subject, stem + ".nrrd", "--voxel", "0.3", "--noise", "0.06"});
  else
    words.insert(words.end(),
                 {"patient", stem + ".nrrd", "--seed", subject.substr(subject.rfind('-') + 1)});
  words.insert(words.end(), {"--truth", stem + "-t.lumen", "--seeds", stem + ".json", "--quiet"});
  runTimed(arguments.lumen, words, stem + ".out", stem + ".err");
}

/// The clicks without their parents, but for aneurysms, which have to have one.
void dropParents(std::vector<convert::SeedBranch>& seeds) {
  for (convert::SeedBranch& seed : seeds)
    if (seed.kind == formats::BranchKind::Vessel) seed.parent.reset();
}

/// The clicks of children at one radius along the axis of their vessel, a fifth of it off.
void moveToTheStart(std::vector<convert::SeedBranch>& seeds, const formats::CenterlineTree& truth) {
  Random random(1, 0x6e656172ULL);
  for (convert::SeedBranch& seed : seeds) {
    if (seed.kind != formats::BranchKind::Vessel || !seed.parent) continue;
    const auto branch =
        std::find_if(truth.branches.begin(), truth.branches.end(),
                     [&](const formats::Branch& b) { return b.label == seed.label; });
    std::uint32_t node = branch->firstNode;
    const double radius = static_cast<double>(truth.radius[node]);
    const auto away = [&](std::uint32_t n) {
      return (toEigen(truth.centre[n]) - toEigen(truth.centre[branch->firstNode])).norm();
    };
    while (node + 1 < branch->firstNode + branch->nodeCount && away(node) < radius) ++node;
    const auto [u, v] = planeBasis(toEigen(truth.direction[node]).normalized());
    const double angle = 2 * std::numbers::pi * random.uniform();
    seed.points[0].position =
        toEigen(truth.centre[node]) + 0.2 * radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
}

Result runCase(const Arguments& arguments, const std::string& subject, Progress& progress) {
  Result result;
  result.name = fs::path(subject).stem().string();
  result.tree = subject.ends_with(".swc");
  makeVolume(arguments, subject, result.name);
  const std::string stem = (arguments.folder / result.name).string(),
                    own = stem + "-" + arguments.tag;
  const formats::Case truth = readCase(stem + "-t.lumen");
  std::string clicks = stem + ".json";
  std::vector<convert::SeedBranch> seeds = convert::readSeeds(clicks);
  if (arguments.near) moveToTheStart(seeds, truth.tree);
  if (!arguments.parents) dropParents(seeds);
  if (arguments.near || !arguments.parents)
    convert::writeSeeds(seeds, clicks = own + "-clicks.json");
  std::set<std::string> labels;
  for (const convert::SeedBranch& seed : seeds)
    if (seed.kind == formats::BranchKind::Vessel) labels.insert(seed.label);

  result.track = runTimed(
      arguments.lumen,
      {"track", stem + ".nrrd", own + "-track.lumen", "--seeds", clicks, "--seeds-only", "--json"},
      own + "-track.json", own + "-track.err");
  if (arguments.fit)
    result.fit = runTimed(arguments.lumen, {"fit", own + "-track.lumen", own + ".lumen", "--json"},
                          own + "-fit.json", own + "-fit.err");
  else
    fs::copy_file(own + "-track.lumen", own + ".lumen", fs::copy_options::overwrite_existing);
  fs::remove(own + "-track.lumen");
  const auto answer = nlohmann::json::parse(readText(own + "-track.json"));
  for (const auto& seed : answer.at("failed_seeds"))
    if (labels.contains(seed.at("label"))) result.failed.insert(seed.at("label"));
  result.clicks = labels.size();
  result.started = labels.size() - result.failed.size();
  result.score = scoreVessels(readCase(own + ".lumen"), truth, labels, progress);
  return result;
}

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : std::nan("");
}

std::string oneDecimal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

void addRow(const Result& r, Table& table) {
  const VesselScore& s = r.score;
  table.rows.push_back(
      {r.name, std::to_string(r.clicks), std::to_string(r.started), oneDecimal(s.clicked),
       oneDecimal(s.covered), oneDecimal(percent(s.covered, s.clicked)), oneDecimal(s.thin),
       oneDecimal(s.length), oneDecimal(s.falseLength),
       oneDecimal(percent(s.falseLength, s.length)), oneDecimal(s.reachable),
       oneDecimal(s.reachableOf), s.wallMedian, s.radiusBias, oneDecimal(r.track.wall),
       oneDecimal(r.track.processor), oneDecimal(r.fit.wall), oneDecimal(r.fit.processor)});
}

/// The sums over those whose volumes were drawn from a tree (or not); nothing of none.
void addSum(const std::string& name, const std::vector<Result>& results, bool trees, Table& table) {
  Result all;
  all.name = name;
  for (const Result& r : results) {
    if (r.tree != trees) continue;
    all.clicks += r.clicks, all.started += r.started;
    VesselScore& sum = all.score;
    sum.clicked += r.score.clicked, sum.covered += r.score.covered, sum.thin += r.score.thin;
    sum.length += r.score.length, sum.falseLength += r.score.falseLength;
    sum.reachable += r.score.reachable, sum.reachableOf += r.score.reachableOf;
    all.track.wall += r.track.wall, all.track.processor += r.track.processor;
    all.fit.wall += r.fit.wall, all.fit.processor += r.fit.processor;
  }
  all.score.wallMedian = all.score.radiusBias = std::nan("");
  if (all.clicks > 0) addRow(all, table);
}

Table overview(const std::vector<Result>& results) {
  Table table{"Cases",
              {"case", "clicks", "started", "clicked mm", "covered mm", "covered, %",
               "not covered, thin, mm", "found mm", "false mm", "false, %", "reachable mm", "of mm",
               "wall, median mm", "radius bias mm", "track s", "track, processor s", "fit s",
               "fit, processor s"},
              {}};
  for (const Result& r : results) addRow(r, table);
  addSum("all trees", results, true, table);
  addSum("all patients", results, false, table);
  return table;
}

Table places(const std::string& title, const std::vector<Result>& results,
             std::vector<AxisPiece> VesselScore::*pieces) {
  Table table{
      title,
      {"case", "branch", "its click", "from mm", "to mm", "length mm", "place", "radius mm"},
      {}};
  for (const Result& r : results)
    for (const AxisPiece& p : r.score.*pieces)
      table.rows.push_back({r.name, p.branch, r.failed.contains(p.branch) ? "failed" : "started",
                            oneDecimal(p.from), oneDecimal(p.to), oneDecimal(p.length),
                            oneDecimal(p.place.x()) + ", " + oneDecimal(p.place.y()) + ", " +
                                oneDecimal(p.place.z()),
                            p.radius});
  return table;
}

void run(const Arguments& arguments, Progress& progress) {
  fs::create_directories(arguments.folder);
  std::vector<Result> results;
  for (const std::string& subject : arguments.cases) {
    results.push_back(runCase(arguments, subject, progress));
    Report report("Clicked vessels");
    report.paragraph(
        std::string("One click to a vessel") +
        (arguments.near ? ", one radius from its beginning" : "") +
        (arguments.parents ? ", parents named." : ", no parents named.") +
        " A point of a true axis is covered if an axis of the case passes within the "
        "true radius, whatever its label; thin is what has a radius below 1.5 voxels. "
        "An axis of the case is false where it is farther than half a voxel from every "
        "true lumen. Pieces shorter than half a millimetre are not listed.");
    report.table(overview(results));
    report.table(places("Not covered", results, &VesselScore::uncovered));
    report.table(places("False", results, &VesselScore::wrong));
    report.write(arguments.folder, arguments.tag);
    if (results.size() == arguments.cases.size()) std::fputs(report.markdown().c_str(), stdout);
  }
}

Arguments parse(std::vector<std::string> words) {
  Arguments arguments;
  const auto take = [&words] {
    if (words.empty()) throw Error(ErrorKind::Usage, "");
    std::string word = words.front();
    words.erase(words.begin());
    return word;
  };
  while (!words.empty() && words.front().starts_with("--")) {
    const std::string option = take();
    if (option == "--no-parents")
      arguments.parents = false;
    else if (option == "--near")
      arguments.near = true;
    else if (option == "--track-only")
      arguments.fit = false;
    else if (option == "--tag")
      arguments.tag = take();
    else
      throw Error(ErrorKind::Usage, "");
  }
  arguments.lumen = take();
  arguments.folder = take();
  arguments.cases = words;
  if (words.empty()) throw Error(ErrorKind::Usage, "");
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, Verbosity::Quiet));
  try {
    run(parse({argv + 1, argv + argc}), progress);
  } catch (const std::exception& e) {
    progress.abandon();
    const auto* error = dynamic_cast<const Error*>(&e);
    if (error != nullptr && error->kind() == ErrorKind::Usage) {
      std::fputs(
          "usage: lumen_vessels [--no-parents] [--track-only] [--tag NAME] LUMEN FOLDER (FILE.swc "
          "| "
          "patient-K)...\n",
          stderr);
      return 2;
    }
    std::fprintf(stderr, "lumen_vessels: %s\n", e.what());
    return 1;
  }
  return 0;
}
