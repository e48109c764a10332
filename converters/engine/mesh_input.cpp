// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_input.h"

#include <algorithm>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/stage_options.h"
#include "converters/io/centerline/centerline_readers.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

convert::CenterlineFile readCenterline(const InputFile& file) {
  const std::string name = lowerCase(file.path().filename().string());
  std::error_code ignored;
  const bool isFolder = !file.isInMemory() && fs::is_directory(file.path(), ignored);
  // whatever .vtp or .vtk holds, it is to be a centerline
  if (name.ends_with(".vtp")) return convert::readVtpCenterline(file);
  if (name.ends_with(".vtk")) return convert::readVtkCenterline(file);
  for (const FileFormat& format : fileFormats()) {
    const bool isNamed =
        std::any_of(format.endings.begin(), format.endings.end(),
                    [&](std::string_view ending) { return name.ends_with(ending); });
    if (format.readCenterline != nullptr &&
        (isFolder ? format.holds != nullptr && format.holds(file.path()) : isNamed))
      return format.readCenterline(file);
  }
  if (isFolder || name.ends_with(".json")) return convert::readCurves(file);
  throw unsupported(
      formats::printable(file.name()) +
      ": the name's ending is not that of a centerline that lumen reads, .vtp, .vtk, " +
      formatEndings(canReadCenterline));
}

}  // namespace

std::string unitName(double millimetres) {
  for (const auto& [name, unit] : millimetresByUnit())
    if (unit == millimetres) return name;
  return {};
}

std::string unitText(const convert::ReadFrame& frame) {
  const std::string name = unitName(frame.unit);
  return (name.empty() ? shownNumber(frame.unit) + " mm" : name) +
         (frame.unitFrom == "file"       ? ", as the file states"
          : frame.unitFrom == "option"   ? ", as " + kOption.unit.shown() + " states"
          : frame.unitFrom == "standard" ? ", by the standard of glTF"
                                         : ", by its size");
}

std::string axesText(const convert::ReadFrame& frame) {
  return frame.frameStated ? "LPS" : "not stated; taken as LPS";
}

std::string frameLine(const char* what, const std::optional<convert::ReadFrame>& frame) {
  if (!frame) return "";
  return std::string(what) + " read    unit " + unitText(*frame) + "; axes " + axesText(*frame) +
         "\n";
}

Json frameJson(const std::optional<convert::ReadFrame>& frame) {
  if (!frame) return nullptr;
  return {{"unit", unitName(frame->unit)},
          {"unit_from", frame->unitFrom},
          {"frame_stated", frame->frameStated}};
}

void stateAxes(convert::MeshFile& file, const std::string& frame) {
  if (frame.empty()) return;
  file.frameStated = true;
  if ((frame == "ras") == file.isTurned) return;
  for (Eigen::Vector3d& p : file.mesh.position) p = {-p.x(), -p.y(), p.z()};
  file.isTurned = !file.isTurned;
  std::erase(file.notes, convert::kTurnedNote);  // of axes that do not count
}

bool isOfSimVascular(const InputFile& file, const convert::MeshFile& read) {
  std::error_code ignored;
  const std::string ending = lowerCase(file.path().extension().string());
  const bool hasFaceIds = (ending == ".vtp" || ending == ".vtk") && !read.groups.empty();
  return hasFaceIds ||
         (!file.isInMemory() && fs::exists(file.path().string() + ".facenames", ignored));
}

operations::MeshPart loadMesh(const InputFile& file, const FileFormat& format,
                              const SceneArguments& scene, Progress& progress) {
  operations::MeshPart part;
  progress.begin("reading", 0);
  part.file = format.readScene != nullptr ? format.readScene(file, scene) : format.readMesh(file);
  progress.end();
  part.isOfSimVascular = isOfSimVascular(file, part.file);
  return part;
}

std::optional<operations::CenterlinePart> loadGivenCenterline(const MeshArguments& arguments,
                                                              Progress& progress) {
  if (arguments.centerline.empty()) return {};
  requireInput(arguments.centerline, "centerline");
  operations::CenterlinePart given{readCenterline(arguments.centerline),
                                   arguments.centerline.name()};
  for (const std::string& remark : given.file.remarks)
    warn(progress, about(formats::printable(given.name), {WarningCode::FileAssumption, remark}));
  const auto& units = millimetresByUnit();
  if (const auto unit = units.find(arguments.centerlineUnit); unit != units.end())
    given.file.unit = unit->second;
  if (!arguments.centerlineFrame.empty())
    given.file.axes = arguments.centerlineFrame == "ras" ? convert::CenterlineAxes::Ras
                                                         : convert::CenterlineAxes::Lps;
  return given;
}

}  // namespace lumen::engine
