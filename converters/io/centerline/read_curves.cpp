// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/folder_files.h"
#include "converters/io/centerline/join_curves.h"
#include "converters/io/seeds/seeds.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMarkups = ".mrk.json";

std::vector<InputFile> listFiles(const InputFile& input) {
  const fs::path& path = input.path();
  std::error_code error;
  if (input.isInMemory() || !fs::is_directory(path, error)) return {input};
  std::vector<InputFile> files = filesEndingIn(path, {kMarkups}, error);
  if (error)
    throw invalidInput(formats::printable(path.string()) + ": cannot be read (" + error.message() +
                       ")");
  return files;
}

// The points as their file has them, so that options may state another unit and other axes.
void restoreFrame(const SeedFrame& frame, CenterlineFile& file) {
  file.unit = frame.unit;
  if (frame.system == SeedSystem::Ras) file.axes = CenterlineAxes::Ras;
  for (CenterlinePoint& point : file.points) {
    point.position = frame.direction(point.position) / frame.unit;
    point.radius /= frame.unit;
  }
}

}  // namespace

bool hasCurves(const fs::path& folder) {
  std::error_code ignored;
  return !filesEndingIn(folder, {kMarkups}, ignored).empty();
}

CenterlineFile readCurves(const InputFile& fileOrFolder) {
  const std::string name = formats::printable(fileOrFolder.path().string());
  std::vector<CenterlineCurve> curves;
  std::size_t without = 0, short_ = 0;
  SeedReading reading;
  reading.word = [](std::string_view field, std::optional<std::size_t>) {
    return field == "seeds-unit" ? kOption.unit.shown() : kOption.frame.shown();
  };
  std::optional<SeedFrame> stated;  // of all files
  bool isOneFrame = true;
  for (const InputFile& file : listFiles(fileOrFolder)) {
    for (const SeedBranch& branch : readSeeds(file, reading)) {
      if (!stated) stated = branch.frame;
      isOneFrame =
          isOneFrame && stated->unit == branch.frame.unit && stated->system == branch.frame.system;
      CenterlineCurve curve{branch.label, {}, -1, -1};
      bool hasRadii = false;
      for (const SeedPoint& point : branch.points) {
        curve.points.push_back({point.position, point.radius.value_or(0)});
        hasRadii = hasRadii || point.radius.has_value();
      }
      if (curve.points.size() < 2)
        ++short_;
      else if (!hasRadii)
        ++without;
      else
        curves.push_back(std::move(curve));
    }
  }
  if (curves.empty())
    throw invalidInput(name + ": has no curve with radii (" + std::to_string(short_) +
                       " single points, " + std::to_string(without) +
                       " curves without the measurement \"Radius\"); expected curves as Slicer's "
                       "Extract Centerline makes them; points clicked in a volume go to " +
                       kOption.seeds.shown());
  CenterlineFile result = joinCurves(curves);
  result.unit = 1;
  result.axes = CenterlineAxes::Lps;
  if (stated && isOneFrame) restoreFrame(*stated, result);
  if (short_ > 0)
    result.remarks.push_back(std::to_string(short_) + " markups of a single point are left out");
  if (without > 0)
    result.remarks.push_back(std::to_string(without) +
                             " curves without the measurement \"Radius\" are left out");
  fillRadii(result, name, "the measurement \"Radius\" of a curve");
  return result;
}

}  // namespace lumen::convert
