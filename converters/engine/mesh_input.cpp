// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_input.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/option_name.h"
#include "converters/base/text.h"
#include "converters/engine/file_access.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/io/centerline/read_curves.h"
#include "converters/io/centerline/read_swc.h"
#include "converters/io/centerline/read_tre.h"
#include "converters/io/centerline/read_vtp.h"
#include "converters/io/mesh/mesh_file.h"
#include "converters/stages/repair/mesh_report.h"
#include "converters/stages/repair/repair.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

double millimetresIn(const std::string& unit) {
  static const std::map<std::string, double> kMillimetresIn = {
      {"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}};
  const auto found = kMillimetresIn.find(unit);
  return found == kMillimetresIn.end() ? 0 : found->second;
}

convert::CenterlineFile readCenterline(const fs::path& file) {
  const std::string name = lowerCase(file.filename().string());
  std::error_code ignored;
  if (fs::is_directory(file, ignored) || name.ends_with(".json")) return convert::readCurves(file);
  if (name.ends_with(".swc")) return convert::readSwc(file);
  if (name.ends_with(".tre")) return convert::readTre(file);
  if (name.ends_with(".vtp")) return convert::readVtpCenterline(file);
  throw unsupported(formats::printable(file.string()) +
                    ": the name's ending is not that of a centerline that lumen reads, .vtp, .swc, "
                    ".tre or .mrk.json");
}

/// The centerline in mm, LPS. `meshUnit`: mm in a unit of the mesh.
std::optional<convert::GivenCenterline> givenCenterline(const MeshArguments& arguments,
                                                        double meshUnit, Progress& progress) {
  if (arguments.centerline.empty()) return {};
  requireInput(arguments.centerline, "centerline");
  convert::GivenCenterline given{readCenterline(arguments.centerline),
                                 formats::printable(arguments.centerline)};
  for (const std::string& remark : given.file.remarks) progress.warn(given.name + ": " + remark);
  double unit = millimetresIn(arguments.centerlineUnit);
  if (!(unit > 0)) unit = given.file.unit > 0 ? given.file.unit : meshUnit;
  const bool isRas = arguments.centerlineFrame.empty()
                         ? given.file.axes == convert::CenterlineAxes::Ras
                         : arguments.centerlineFrame == "ras";
  const Eigen::Vector3d turn(isRas ? -unit : unit, isRas ? -unit : unit, unit);
  for (convert::CenterlinePoint& point : given.file.points) {
    point.position = turn.cwiseProduct(point.position);
    point.radius *= unit;
  }
  return given;
}

/// The unit of a mesh whose file states none, by the mesh's size; warns where that is not mm.
std::string guessedUnit(const convert::TriangleMesh& mesh, const std::string& name,
                        Progress& progress) {
  convert::MeshReport size;
  size.low = size.high = mesh.position.front();
  for (const convert::Triangle& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.position[t[0]];
    size.area += 0.5 * (mesh.position[t[1]] - a).cross(mesh.position[t[2]] - a).norm();
  }
  for (const Eigen::Vector3d& p : mesh.position) {
    size.low = size.low.cwiseMin(p);
    size.high = size.high.cwiseMax(p);
  }
  size.volume = convert::signedVolume(mesh);
  const convert::UnitGuess guess = convert::guessUnit(size);
  const double radius = 2 * std::abs(size.volume) / size.area;
  if (!guess.plausible)
    progress.warn(name + ": taken to be in mm, although vessels of " + foundNumber(radius) +
                  " mm radius are implausible, and in cm and m, too; " + kOption.unit.shown() +
                  " states the unit");
  else if (guess.millimetres != 1)
    progress.warn(name + ": taken to be in " + guess.unit + ": in mm its vessels would have " +
                  foundNumber(radius) + " mm radius; " + kOption.unit.shown() + " states the unit");
  return guess.unit;
}

/// The unit of the mesh and its axes; warns where the unit is a guess that is not mm.
MeshFrame chooseFrame(const convert::MeshFile& file, const convert::TriangleMesh& mesh,
                      const std::string& name, const MeshArguments& arguments, Progress& progress) {
  if (millimetresIn(arguments.unit) > 0) return {arguments.unit, "option", file.frameStated};
  if (file.unitMm > 0) return {"mm", "file", file.frameStated};
  return {guessedUnit(mesh, name, progress), "guess", file.frameStated};
}

std::string listed(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

}  // namespace

std::string MeshFrame::unitText() const {
  return unit + (unitFrom == "file"     ? ", as the file states"
                 : unitFrom == "option" ? ", as " + kOption.unit.shown() + " states"
                                        : ", by its size");
}

std::string MeshFrame::axesText() const {
  return frameStated ? "LPS" : "not stated; taken as LPS";
}

std::string meshFrameLine(const std::optional<MeshFrame>& frame) {
  if (!frame) return "";
  return "mesh read    unit " + frame->unitText() + "; axes " + frame->axesText() + "\n";
}

Json meshFrameJson(const std::optional<MeshFrame>& frame) {
  if (!frame) return nullptr;
  return {
      {"unit", frame->unit}, {"unit_from", frame->unitFrom}, {"frame_stated", frame->frameStated}};
}

CaseOfMeshFile caseOfMeshFile(const fs::path& file, const FileFormat& format,
                              const MeshArguments& arguments, Progress& progress) {
  const std::string name = formats::printable(file.string());
  progress.begin("reading", 0);
  const convert::MeshFile read =
      format.readScene != nullptr ? format.readScene(file, arguments.scene) : format.readMesh(file);
  convert::RepairResult repaired = convert::repairMesh(read.mesh, name, progress);
  progress.end();
  for (const std::string& note : read.notes) progress.warn(name + ": " + note);
  if (!repaired.repairs.empty()) progress.warn(name + ": repaired: " + listed(repaired.repairs));
  const MeshFrame frame = chooseFrame(read, repaired.mesh, name, arguments, progress);
  const double unit = millimetresIn(frame.unit);
  for (Eigen::Vector3d& p : repaired.mesh.position) p *= unit;
  const auto centerline = givenCenterline(arguments, unit, progress);
  convert::MeshCase made =
      convert::caseOfMesh(std::move(repaired.mesh), name, centerline, {{"unit", unit}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  return {std::move(made.result), frame};
}

}  // namespace lumen::engine
