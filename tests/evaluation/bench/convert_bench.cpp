// SPDX-License-Identifier: Apache-2.0
// lumen_convert_bench FOLDER [SIZE [ITK_SIZE]]: from a volume file to a case, by stage, on one and
// two threads and in three sizes, and beside ITK's multi-scale vesselness. Every measurement runs
// in a process of its own, one after another, so that its peak of memory is its own. Linux only.
// Writes convert.md and convert.json.
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "convert_itk.h"
#include "converters/base/files.h"
#include "converters/io/seeds/seeds.h"
#include "converters/io/volume/read_volume.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"
#include "formats/case/case_file.h"
#include "tests/evaluation/reproduce/report.h"

namespace {

using namespace lumen;
using reproduce::Table;
using Figures = std::map<std::string, double>;

constexpr double kLeastSigma = 0.25, kGreatestSigma = 2.2;  // mm: the radii of `phantom patient`
constexpr double kMebibyte = 1024.0 * 1024.0;

// ---- in a process of its own ----

/// Peak of resident memory since the last reset, MiB.
double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return std::numeric_limits<double>::quiet_NaN();
}

void resetPeak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

void print(const std::string& name, double value) {
  std::printf("%s %.9g\n", name.c_str(), value);
}

template <class Work>
void stage(const std::string& name, Work work) {
  resetPeak();
  const auto start = std::chrono::steady_clock::now();
  work();
  print(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  print(name + "_peak", peakMemory());
}

double volumeMemory(const convert::Volume& volume) {
  return std::visit(
             [](const auto& voxels) {
               return static_cast<double>(voxels.size() * sizeof(voxels[0]));
             },
             volume.voxels) /
         kMebibyte;
}

void convertOnce(const std::string& stem, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  Progress progress;
  convert::Volume volume;
  formats::Case value;
  stage("read", [&] {
    volume = convert::readVolume(stem + ".nrrd", convert::VolumeFormat::Nrrd, {}, progress);
  });
  const auto seeds = convert::readSeeds(stem + ".json");
  stage("track", [&] { value = convert::trackFromSeeds(volume, seeds, {}, progress).result; });
  stage("fit", [&] { convert::fit(value, {}, progress); });
  stage("write", [&] {
    const auto written = formats::writeCaseFile(value, stem + ".lumen");
    if (!written) throw failed(written.error().text());
  });
  print("volume", volumeMemory(volume));
  print("branches", static_cast<double>(value.tree.branches.size()));
  print("nodes", static_cast<double>(value.tree.nodeCount()));
  print("blobs", static_cast<double>(value.models->width.size()));
}

void filterOnce(const std::string& stem, int threads) {
  Progress progress;
  const convert::Volume volume =
      convert::readVolume(stem + ".nrrd", convert::VolumeFormat::Nrrd, {}, progress);
  print("volume", volumeMemory(volume));
  resetPeak();
  const bench::Vesselness out =
      bench::multiScaleVesselness(volume, kLeastSigma, kGreatestSigma, threads);
  print("seconds", out.seconds);
  print("mean", out.mean);
  print("peak", peakMemory());
}

// ---- the run of all ----

class Bench {
public:
  explicit Bench(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder);
  }

  void phantom(int size) const {
    convert::PhantomOptions options;
    options.name = "patient";
    options.size = size;
    Progress progress;
    const convert::Phantom phantom = convert::makePhantom(options, progress);
    const std::string name = stem(size) + ".nrrd";
    writeNewFile(convert::encodeVolume(phantom.volume, convert::VolumeFormat::Nrrd, true, name),
                 name);
    convert::writeSeeds(phantom.seeds, stem(size) + ".json");
  }

  /// `task` is --convert or --itk. Says on standard error what runs.
  [[nodiscard]] Figures measure(const std::string& task, int size, int threads) const {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::string command =
        "'" + self + "' " + task + " '" + stem(size) + "' " + std::to_string(threads);
    std::fprintf(stderr, "%s, %d voxels, %d threads\n", task.c_str(), size, threads);
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw failed(command + ": cannot be started");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    if (pclose(pipe) != 0) throw failed(command + ": failed");
    std::istringstream in(text);
    Figures figures;
    std::string name;
    for (double value = 0; in >> name >> value;) figures[name] = value;
    return figures;
  }

  void removeFiles(int size) const {
    for (const char* extension : {".nrrd", ".json", ".lumen"})
      std::filesystem::remove(stem(size) + extension);
  }

private:
  [[nodiscard]] std::string stem(int size) const {
    return (m_folder / ("patient" + std::to_string(size))).string();
  }
  std::filesystem::path m_folder;
};

constexpr std::array kStages = {"read", "track", "fit", "write"};

double total(const Figures& f) {
  double sum = 0;
  for (const char* name : kStages) sum += f.at(name);
  return sum;
}

void addRow(int size, int threads, const Figures& f, Table& times, Table& memory) {
  times.rows.push_back({static_cast<double>(size), static_cast<double>(threads), f.at("branches"),
                        f.at("nodes"), f.at("blobs") / f.at("nodes"), f.at("read"), f.at("track"),
                        f.at("fit"), f.at("write"), total(f), 1e3 * f.at("track") / f.at("nodes"),
                        1e3 * f.at("fit") / f.at("nodes")});
  std::vector<reproduce::Cell> row = {static_cast<double>(size), static_cast<double>(threads),
                                      f.at("volume")};
  for (const char* name : kStages)
    row.emplace_back(f.at(std::string(name) + "_peak") - f.at("volume"));
  memory.rows.push_back(std::move(row));
}

void run(const std::filesystem::path& folder, int size, int itkSize) {
  const Bench bench(folder);
  Table times{"Time",
              {"size", "threads", "branches", "nodes", "blobs per node", "read s", "track s",
               "fit s", "write s", "total s", "track ms per node", "fit ms per node"},
              {}};
  Table memory{"Peak of resident memory above the volume, MiB",
               {"size", "threads", "volume", "read", "track", "fit", "write"},
               {}};
  std::map<std::pair<int, int>, Figures> all;
  for (const auto& [edge, threads] :
       std::vector<std::pair<int, int>>{{size / 4, 2}, {size / 2, 2}, {size, 2}, {size, 1}}) {
    if (threads == 2) bench.phantom(edge);
    const Figures figures = bench.measure("--convert", edge, threads);
    addRow(edge, threads, figures, times, memory);
    all[{edge, threads}] = figures;
  }
  if (!all.contains({itkSize, 2})) {
    bench.phantom(itkSize);
    all[{itkSize, 2}] = bench.measure("--convert", itkSize, 2);
  }
  Table ratio{
      "Beside ITK's MultiScaleHessianBasedMeasureImageFilter, 5 scales, 2 threads",
      {"size", "ITK s", "ITK peak MiB above the volume", "lumen, file to file s", "ITK / lumen"},
      {}};
  const Figures itk = bench.measure("--itk", itkSize, 2);
  const double own = total(all[{itkSize, 2}]);
  ratio.rows.push_back({static_cast<double>(itkSize), itk.at("seconds"),
                        itk.at("peak") - itk.at("volume"), own, itk.at("seconds") / own});
  for (const auto& entry : all) bench.removeFiles(entry.first.first);

  reproduce::Report report("From a volume to a case");
  report.paragraph(
      "`phantom patient`, voxels of 0.2 mm. Times are of one run on a machine that may "
      "have had other work; only ratios within it mean anything.");
  report.table(times);
  report.table(memory);
  report.table(ratio);
  report.write(folder, "convert");
  std::fputs(report.markdown().c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 3 && arguments[0] == "--convert")
      convertOnce(arguments[1], std::stoi(arguments[2]));
    else if (arguments.size() == 3 && arguments[0] == "--itk")
      filterOnce(arguments[1], std::stoi(arguments[2]));
    else if (!arguments.empty() && arguments.size() <= 3)
      run(arguments[0], arguments.size() > 1 ? std::stoi(arguments[1]) : 512,
          arguments.size() > 2 ? std::stoi(arguments[2]) : 256);
    else {
      std::fputs("usage: lumen_convert_bench FOLDER [SIZE [ITK_SIZE]]\n", stderr);
      return 2;
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lumen_convert_bench: %s\n", e.what());
    return 1;
  }
  return 0;
}
