// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/mesh_input.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/engine/file_access.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/stages/editing/inlets.h"
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

/// Whether the file is a model of SimVascular, which names its faces in an array or beside it.
bool isOfSimVascular(const fs::path& file, const convert::MeshFile& read) {
  std::error_code ignored;
  const std::string ending = lowerCase(file.extension().string());
  const bool hasFaceIds = (ending == ".vtp" || ending == ".vtk") && !read.groups.empty();
  return hasFaceIds || fs::exists(file.string() + ".facenames", ignored);
}

/// The unit of the mesh and its axes; warns as guessUnitOf().
MeshFrame chooseFrame(const convert::MeshFile& read, const convert::TriangleMesh& mesh,
                      const fs::path& file, const MeshArguments& arguments, Progress& progress) {
  if (millimetresIn(arguments.unit) > 0) return {arguments.unit, "option", read.frameStated};
  if (read.unitMm > 0) return {"mm", "file", read.frameStated};
  return {guessUnitOf(convert::vesselSize(mesh), file, read, progress).unit, "guess",
          read.frameStated};
}

/// Begins trees at the openings through which blood comes in besides the widest one.
void beginAtFurtherInlets(convert::MeshCase& made, Progress& progress) {
  constexpr double kBeyondRadii = 3;  // behind an opening, within these multiples of its radius
  const auto isInside = [&](const Eigen::Vector3d& point) {
    return std::none_of(made.openings.begin(), made.openings.end(), [&](const auto& end) {
      return (point - end.centre).dot(end.normal) > 0 &&
             (point - end.centre).norm() < kBeyondRadii * end.radius;
    });
  };
  const std::vector<Eigen::Vector3d> inlets = convert::furtherInlets(made.result.tree, isInside);
  convert::beginAt(made.result, inlets);
  for (const Eigen::Vector3d& place : inlets)
    progress.detail("blood comes in at " + convert::vectorText(place) + " mm, too");
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

convert::UnitGuess guessUnitOf(const convert::VesselSize& size, const fs::path& file,
                               const convert::MeshFile& read, Progress& progress) {
  const bool isSimVascular = isOfSimVascular(file, read);
  convert::UnitGuess guess = convert::guessUnit(size, isSimVascular);
  if (const std::string warning = convert::unitWarning(guess, size, isSimVascular);
      !warning.empty())
    progress.warn(formats::printable(file.string()) + ": " + warning);
  return guess;
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
  const MeshFrame frame = chooseFrame(read, repaired.mesh, file, arguments, progress);
  const double unit = millimetresIn(frame.unit);
  for (Eigen::Vector3d& p : repaired.mesh.position) p *= unit;
  const auto centerline = givenCenterline(arguments, unit, progress);
  convert::MeshCase made =
      convert::caseOfMesh(std::move(repaired.mesh), name, centerline, {{"unit", unit}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  beginAtFurtherInlets(made, progress);
  return {std::move(made.result), frame};
}

}  // namespace lumen::engine
