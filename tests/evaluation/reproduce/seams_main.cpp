// SPDX-License-Identifier: Apache-2.0
// lumen_seams CASE [FOLDER]: the jumps between adjacent models of a case, as it is and, if it has
// its wall points, as fitted anew without and with joint refinement. Prints Markdown; with a
// FOLDER, writes seams.md and seams.json there.
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "converters/cli/terminal_progress.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/case_file.h"
#include "report.h"
#include "seams.h"

namespace {

using namespace lumen;

formats::Case readCase(const std::string& file) {
  formats::Expected<formats::Case> value = formats::readCaseFile(file);
  if (!value) throw invalidInput(value.error().text());
  if (!value->metadata.voxelSize) throw invalidInput(file + ": states no voxel size");
  return *std::move(value);
}

void addRow(const std::string& name, const formats::Case& value, Progress& progress,
            reproduce::Table& table) {
  const double voxel = *value.metadata.voxelSize;
  const reproduce::SeamJumps jumps = reproduce::measureSeams(value, progress);
  const auto quantile = [&](double share) {
    return reproduce::quantile(jumps.jump, share) / voxel;
  };
  double error = std::nan("");
  if (value.points) {
    error = convert::summariseErrorOfFit(convert::errorOfFit(value, 2, progress)).median / voxel;
  }
  const double blobs =
      static_cast<double>(value.models->width.size()) / static_cast<double>(value.tree.nodeCount());
  table.rows.push_back({name, static_cast<double>(jumps.seams), quantile(0.5), quantile(0.9),
                        quantile(0.99), quantile(1), static_cast<double>(jumps.lost), error,
                        blobs});
}

void run(const std::string& file, const std::string& folder, Progress& progress) {
  formats::Case value = readCase(file);
  reproduce::Table table{"Jump between adjacent models on their radical planes, in voxels",
                         {"models", "seams", "median", "p90", "p99", "max", "lost samples",
                          "error of fit, median", "blobs per node"},
                         {}};
  if (value.models) addRow("as stored", value, progress, table);
  if (value.points) {
    convert::FitOptions alone;
    alone.seamSweeps = 0;
    convert::fit(value, alone, progress);
    addRow("fitted, no joint refinement", value, progress, table);
    convert::fit(value, {}, progress);
    addRow("fitted", value, progress, table);
  }
  if (table.rows.empty()) throw invalidInput(file + ": has neither models nor wall points");
  reproduce::Report report("Seams");
  report.table(table);
  std::fputs(report.markdown().c_str(), stdout);
  if (!folder.empty()) report.write(folder, "seams");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fputs("usage: lumen_seams CASE [FOLDER]\n", stderr);
    return 2;
  }
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, Verbosity::Normal));
  try {
    run(argv[1], argc == 3 ? argv[2] : "", progress);
  } catch (const std::exception& e) {
    progress.abandon();
    std::fprintf(stderr, "lumen_seams: %s\n", e.what());
    return 1;
  }
  return 0;
}
