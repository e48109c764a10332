// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/mesh_vessels.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/warning.h"
#include "converters/geometry/far_origin.h"
#include "converters/stages/editing/further_inlets.h"
#include "converters/stages/repair/repair.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

/// The centerline beside a mesh in mm, LPS, moved as the mesh. `meshUnit`: mm in a unit of the mesh.
convert::GivenCenterline inPatientSpace(const CenterlinePart& centerline, double meshUnit,
                                        const Eigen::Vector3d& move) {
  convert::GivenCenterline given{centerline.file, formats::printable(centerline.name)};
  const double unit = given.file.unit > 0 ? given.file.unit : meshUnit;
  const bool isRas = given.file.axes == convert::CenterlineAxes::Ras;
  const Eigen::Vector3d turn(isRas ? -unit : unit, isRas ? -unit : unit, unit);
  for (convert::CenterlinePoint& point : given.file.points) {
    point.position = turn.cwiseProduct(point.position) - move;
    point.radius *= unit;
  }
  return given;
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
  convert::reportInlets(convert::beginAtFurtherInlets(made.result, isInside), progress);
}

std::string listed(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

}  // namespace

convert::UnitGuess guessUnitOf(const convert::VesselSize& size, const std::string& name,
                               bool isOfSimVascular, const Context& context) {
  convert::UnitGuess guess = convert::guessUnit(size, isOfSimVascular);
  if (const std::string warning =
          convert::unitWarning(guess, size, isOfSimVascular, context.fieldWord);
      !warning.empty())
    warn(context.progress, about(formats::printable(name), {WarningCode::MeshUnit, warning}));
  return guess;
}

MeshFrame meshFrame(const MeshPart& part, const convert::VesselSize& size, const std::string& name,
                    const std::optional<double>& unit, const Context& context) {
  const convert::MeshFile& file = part.file;
  if (unit) return {*unit, "option", file.frameStated};
  const bool isStandard = file.standardMm > 0;
  if (const double stated = isStandard ? file.standardMm : file.unitMm; stated > 0) {
    const double read = file.scaleFor(stated) / stated;  // units of the file in one of `size`
    const std::string warning = convert::statedWarning(
        {size.radius * read, size.diagonal * read}, stated,
        isStandard ? convert::UnitBy::StandardOfGltf : convert::UnitBy::File, context.fieldWord);
    if (!warning.empty())
      warn(context.progress, about(formats::printable(name), {WarningCode::MeshUnit, warning}));
    return {stated, isStandard ? "standard" : "file", file.frameStated};
  }
  const convert::UnitGuess guess = guessUnitOf(size, name, part.isOfSimVascular, context);
  return {guess.millimetres, "guess", file.frameStated};
}

formats::Case meshVessels(const Source& source, const std::optional<double>& unit, MeshFrame& frame,
                          const Context& context) {
  const std::string name = formats::printable(source.name);
  const MeshPart& part = source.mesh.value();
  Progress& progress = context.progress;
  progress.begin("repairing", 0);
  convert::TriangleMesh mesh = part.file.mesh;
  const Eigen::Vector3d back = convert::moveNear(mesh.position);
  convert::RepairResult repaired = convert::repairMesh(mesh, name, progress);
  progress.end();
  for (const std::string& note : part.file.notes)
    warn(progress, about(name, {WarningCode::FileAssumption, note}));
  if (!repaired.repairs.empty())
    warn(progress,
         about(name, {WarningCode::MeshRepaired, "repaired: " + listed(repaired.repairs)}));
  frame = meshFrame(part, convert::vesselSize(repaired.mesh), source.name, unit, context);
  const double scale = part.file.scaleFor(frame.unit);
  const Eigen::Vector3d move =
      convert::farMove(scale * (convert::lowestOf(repaired.mesh.position) + back));
  const Eigen::Vector3d shift = scale * back - move;
  for (Eigen::Vector3d& p : repaired.mesh.position) p = scale * p;
  if (!shift.isZero(0))
    for (Eigen::Vector3d& p : repaired.mesh.position) p += shift;
  std::optional<convert::GivenCenterline> centerline;
  if (source.centerline) centerline = inPatientSpace(*source.centerline, scale, move);
  convert::MeshCase made =
      convert::caseOfMesh(std::move(repaired.mesh), name, centerline, {{"unit", scale}}, progress);
  for (const std::string& note : made.notes) warn(progress, {WarningCode::MeshRepaired, note});
  beginAtFurtherInlets(made, progress);
  if (!move.isZero(0)) {
    const std::string sentence = convert::farSentence("its points are", move);
    warn(progress, about(name, {WarningCode::FileAssumption, sentence}));
    recordAssumptions(made.result.metadata.steps.back(), {sentence});
  }
  return std::move(made.result);
}

}  // namespace lumen::operations
