// SPDX-License-Identifier: Apache-2.0
// lumen_patient_fits FOLDER [CASE ...]: the fit of whole vessel trees at three accuracies and three
// greatest numbers of subdivisions (Yureidini's thesis, 4.9.2, tables 4.8 to 4.11). The cases must
// have their wall points; without any, three synthetic patients are made and tracked. Writes
// patient_fits.md and patient_fits.json.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "converters/cli/terminal_progress.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "converters/stages/tracking/track_case.h"
#include "formats/case/case_file.h"
#include "implicit_surface.h"
#include "report.h"

namespace {

using namespace lumen;
using namespace lumen::reproduce;

constexpr double kThesisVoxel = 0.2;  // mm; the accuracies scale with the voxel
constexpr std::array kAccuracies = {0.2, 0.3, 0.5};
constexpr std::array kSubdivisions = {30, 50, 100};
constexpr std::array<std::uint64_t, 3> kSeeds = {11, 12, 13};
constexpr int kPatientSize = 256;
constexpr int kNeighbourhood = 2;

/// Tables 4.8, 4.10 and 4.11: share of nodes, in %, with an error of fit below half a voxel, to
/// one, to two, and beyond; blobs per node; triangles per blob, median of ten patients.
struct Published {
  std::array<double, 4> classes;
  double blobsPerNode, trianglesPerBlob;
};
constexpr double kNodes = 87564;
constexpr Published kPublished[3][3] = {{{{96.58, 3.01, 0.26, 0.14}, 766021 / kNodes, 66},
                                         {{96.96, 2.73, 0.20, 0.11}, 810056 / kNodes, 62},
                                         {{97.15, 2.60, 0.15, 0.09}, 857332 / kNodes, 58}},
                                        {{{88.54, 10.97, 0.34, 0.15}, 532831 / kNodes, 109},
                                         {{88.63, 10.96, 0.28, 0.12}, 546509 / kNodes, 107},
                                         {{88.65, 11.00, 0.25, 0.10}, 563953 / kNodes, 104}},
                                        {{{51.37, 47.61, 0.86, 0.16}, 325799 / kNodes, 244},
                                         {{51.37, 47.64, 0.85, 0.14}, 330852 / kNodes, 240},
                                         {{51.37, 47.67, 0.84, 0.12}, 339302 / kNodes, 234}}};

struct Patient {
  std::string name;
  formats::Case value;
};

/// One fit of one patient.
struct Fitted {
  double nodes = 0, blobs = 0, triangles = 0, seconds = 0;
  std::array<double, 4> classes = {};  ///< nodes
  std::vector<double> wall;            ///< bounded error of fit, voxels, ascending
};

std::vector<Patient> syntheticPatients(Progress& progress) {
  std::vector<Patient> patients;
  for (const std::uint64_t seed : kSeeds) {
    convert::PhantomOptions options;
    options.name = "patient";
    options.size = kPatientSize;
    options.seed = seed;
    const convert::Phantom phantom = convert::makePhantom(options, progress);
    patients.push_back(
        {"synthetic patient " + std::to_string(seed),
         convert::trackFromSeeds(phantom.volume, phantom.seeds, {}, progress).result});
  }
  return patients;
}

std::vector<Patient> readPatients(const std::vector<std::string>& files) {
  std::vector<Patient> patients;
  for (const std::string& file : files) {
    formats::Expected<formats::Case> value = formats::readCaseFile(file);
    if (!value) throw invalidInput(value.error().text());
    if (!value->points) throw invalidInput(file + ": has no wall points");
    if (!value->metadata.voxelSize) throw invalidInput(file + ": states no voxel size");
    patients.push_back({std::filesystem::path(file).stem().string(), *std::move(value)});
  }
  return patients;
}

double trianglesOf(const formats::Case& value, Progress& progress) {
  return static_cast<double>(convert::polygonise(value, {}, progress).surface.triangle.size());
}

Fitted fitOnce(const Patient& patient, double accuracy, int subdivisions, Progress& progress) {
  formats::Case value = patient.value;
  const double voxel = *value.metadata.voxelSize;
  convert::FitOptions options;
  options.accuracy = accuracy / kThesisVoxel * voxel;
  options.maxSubdivisions = subdivisions;
  const auto start = std::chrono::steady_clock::now();
  convert::fit(value, options, progress);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  Fitted out;
  out.seconds = taken.count();
  out.nodes = static_cast<double>(value.tree.nodeCount());
  out.blobs = static_cast<double>(value.models->width.size());
  out.triangles = trianglesOf(value, progress);
  for (const float error :
       convert::errorOfFit(value, kNeighbourhood, progress, convert::FitDistance::Taubin)) {
    const double e = error / voxel;
    out.classes[e < 0.5 ? 0 : e < 1 ? 1 : e < 2 ? 2 : 3] += 1;
  }
  for (const float error : convert::errorOfFit(value, kNeighbourhood, progress)) {
    out.wall.push_back(error / voxel);
  }
  std::sort(out.wall.begin(), out.wall.end());
  return out;
}

/// Several patients as one.
Fitted together(const std::vector<Fitted>& fits) {
  Fitted all;
  for (const Fitted& one : fits) {
    all.nodes += one.nodes;
    all.blobs += one.blobs;
    all.triangles += one.triangles;
    all.seconds += one.seconds;
    for (std::size_t k = 0; k < all.classes.size(); ++k) all.classes[k] += one.classes[k];
    all.wall.insert(all.wall.end(), one.wall.begin(), one.wall.end());
  }
  std::sort(all.wall.begin(), all.wall.end());
  return all;
}

Table emptyTable(const std::string& title) {
  return {
      title,
      {"t_g", "N_s", "< 0.5 voxel, %", "to 1, %", "to 2, %", "beyond, %", "error median",
       "error p90", "error max", "nodes", "blobs per node", "triangles per blob", "ms per node"},
      {}};
}

void addRow(double accuracy, int subdivisions, const Fitted& f, Table& table) {
  std::vector<Cell> row{accuracy, static_cast<double>(subdivisions)};
  for (const double count : f.classes) row.emplace_back(100 * count / f.nodes);
  for (const double share : {0.5, 0.9, 1.0}) row.emplace_back(quantile(f.wall, share));
  for (const double value :
       {f.nodes, f.blobs / f.nodes, f.triangles / f.blobs, 1e3 * f.seconds / f.nodes}) {
    row.emplace_back(value);
  }
  table.rows.push_back(row);
}

Table publishedTable() {
  Table table{"The thesis, 10 patients, 87564 nodes (tables 4.8, 4.10, 4.11)",
              {"t_g", "N_s", "< 0.5 voxel, %", "to 1, %", "to 2, %", "beyond, %", "blobs per node",
               "triangles per blob"},
              {}};
  for (std::size_t i = 0; i < kAccuracies.size(); ++i) {
    for (std::size_t k = 0; k < kSubdivisions.size(); ++k) {
      const Published& p = kPublished[i][k];
      table.rows.push_back({kAccuracies[i], static_cast<double>(kSubdivisions[k]), p.classes[0],
                            p.classes[1], p.classes[2], p.classes[3], p.blobsPerNode,
                            p.trianglesPerBlob});
    }
  }
  return table;
}

void run(const std::filesystem::path& folder, const std::vector<std::string>& files,
         Progress& progress) {
  const std::vector<Patient> patients =
      files.empty() ? syntheticPatients(progress) : readPatients(files);
  std::vector<Table> tables;
  for (const Patient& patient : patients) tables.push_back(emptyTable(patient.name));
  tables.push_back(emptyTable("All of them"));
  for (const double accuracy : kAccuracies) {
    for (const int subdivisions : kSubdivisions) {
      std::vector<Fitted> fits;
      for (std::size_t i = 0; i < patients.size(); ++i) {
        fits.push_back(fitOnce(patients[i], accuracy, subdivisions, progress));
        addRow(accuracy, subdivisions, fits.back(), tables[i]);
      }
      addRow(accuracy, subdivisions, together(fits), tables.back());
    }
  }
  Report report("Fit of patients");
  report.paragraph(
      "t_g in mm for voxels of 0.2 mm, scaled with the voxel of each case. The classes are of the "
      "90th percentile of Taubin's distance over a node's points, in voxels, as in the thesis; the "
      "median, 90th percentile and greatest error are of the bounded distance that `lumen info` "
      "reports, in voxels. Triangles are those of `lumen convert` at the voxel's size. The time is "
      "of the fit, with its seams, on all cores.");
  report.table(publishedTable());
  report.table(tables.back());
  tables.pop_back();
  for (const Table& table : tables) report.table(table);
  std::filesystem::create_directories(folder);
  report.write(folder, "patient_fits");
  std::fputs(report.markdown().c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: lumen_patient_fits FOLDER [CASE ...]\n", stderr);
    return 2;
  }
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, Verbosity::Normal));
  try {
    run(argv[1], {argv + 2, argv + argc}, progress);
  } catch (const std::exception& e) {
    progress.abandon();
    std::fprintf(stderr, "lumen_patient_fits: %s\n", e.what());
    return 1;
  }
  return 0;
}
