// SPDX-License-Identifier: Apache-2.0
// The surface of a case in several ways: time, triangles, and error. Arguments: the case, a .lumen file, and for one of the ways
// alone its name.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/case_file.h"

namespace {

using namespace lumen;

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void measure(const formats::Case& source, const std::string& name,
             const convert::ClosedSurfaceOptions& options) {
  Progress silent;
  const auto begin = std::chrono::steady_clock::now();
  const double processor = processorSeconds();
  const convert::SurfaceReport report = convert::closedSurface(source, options, silent).report;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const double used = processorSeconds() - processor;
  const convert::FieldError error = report.fieldError.value_or(convert::FieldError{});
  std::printf("%-16s %9zu %8.2f %7.2f %9.0f %7.3f %7.3f %6zu %9.1f %5zu\n", name.c_str(),
              report.triangles, used, wall.count(), static_cast<double>(report.triangles) / used,
              error.ninetieth, error.greatest, error.beyond, report.volume, report.crossings);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 3) {
    std::fprintf(stderr, "Usage: surface_bench CASE [NAME]\n");
    return 2;
  }
  const auto source = formats::readCaseFile(arguments[1]);
  if (!source) {
    std::fprintf(stderr, "%s cannot be read\n", arguments[1]);
    return 3;
  }
  std::printf("%-16s %9s %8s %7s %9s %7s %7s %6s %9s %5s\n", "", "triangles", "cpu s", "wall s",
              "per cpu s", "90 % mm", "max mm", "beyond", "mm3", "cross");
  const auto run = [&](const std::string& name, const convert::ClosedSurfaceOptions& options) {
    if (count == 2 || name == arguments[2]) measure(*source, name, options);
  };
  const auto ofError = [](const convert::SurfaceError& error) {
    convert::ClosedSurfaceOptions options;
    options.maxError = error;
    return options;
  };
  run("edges of 0.25r", {});
  run("usual error", ofError(convert::kUsualSurfaceError));
  run("0.05 voxels", ofError({.voxels = 0.05}));
  run("0.1 radii", ofError({.radii = 0.1}));
  convert::ClosedSurfaceOptions budget;
  budget.maxTriangles = 20000;
  run("20,000", budget);
}
