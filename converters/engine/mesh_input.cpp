// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_input.h"

#include <system_error>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/stage_options.h"
#include "converters/io/centerline/centerline_readers.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

convert::CenterlineFile readCenterline(const InputFile& file) {
  const std::string name = lowerCase(file.path().filename().string());
  std::error_code ignored;
  if ((!file.isInMemory() && fs::is_directory(file.path(), ignored)) || name.ends_with(".json"))
    return convert::readCurves(file);
  if (name.ends_with(".swc")) return convert::readSwc(file);
  if (name.ends_with(".tre")) return convert::readTre(file);
  if (name.ends_with(".vtp")) return convert::readVtpCenterline(file);
  throw unsupported(formats::printable(file.name()) +
                    ": the name's ending is not that of a centerline that lumen reads, .vtp, .swc, "
                    ".tre or .mrk.json");
}

}  // namespace

std::string unitName(double millimetres) {
  for (const auto& [name, unit] : millimetresByUnit())
    if (unit == millimetres) return name;
  return {};
}

std::string unitText(const operations::MeshFrame& frame) {
  return unitName(frame.unit) + (frame.unitFrom == "file" ? ", as the file states"
                                 : frame.unitFrom == "option"
                                     ? ", as " + kOption.unit.shown() + " states"
                                     : ", by its size");
}

std::string axesText(const operations::MeshFrame& frame) {
  return frame.frameStated ? "LPS" : "not stated; taken as LPS";
}

std::string meshFrameLine(const std::optional<operations::MeshFrame>& frame) {
  if (!frame) return "";
  return "mesh read    unit " + unitText(*frame) + "; axes " + axesText(*frame) + "\n";
}

Json meshFrameJson(const std::optional<operations::MeshFrame>& frame) {
  if (!frame) return nullptr;
  return {{"unit", unitName(frame->unit)},
          {"unit_from", frame->unitFrom},
          {"frame_stated", frame->frameStated}};
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
    progress.warn(formats::printable(given.name) + ": " + remark);
  const auto& units = millimetresByUnit();
  if (const auto unit = units.find(arguments.centerlineUnit); unit != units.end())
    given.file.unit = unit->second;
  if (!arguments.centerlineFrame.empty())
    given.file.axes = arguments.centerlineFrame == "ras" ? convert::CenterlineAxes::Ras
                                                         : convert::CenterlineAxes::Lps;
  return given;
}

}  // namespace lumen::engine
