// SPDX-License-Identifier: Apache-2.0
// Warnings: facts that make a result doubtful, each with a code, places and a remedy.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"

namespace lumen {

/// One kind of warning each; docs/warnings.md explains all by their names.
enum class WarningCode : std::uint8_t {
  BatchDoubt,
  CaseOtherVolume,
  CaseSeeds,
  CorrectionLeft,
  ExportLoss,
  FileAssumption,
  FilesPassedOver,
  FlowDoubt,
  FormatLoss,
  ImageMotion,
  LabelsBare,
  LabelsSettled,
  LumenClosed,
  LumenContact,
  MeshRepaired,
  MeshUnit,
  ModelsMissing,
  NativeUnmatched,
  OptionUnused,
  PersonalText,
  PictureOld,
  ReportWarnings,
  RootUnused,
  RowFailed,
  SeedInlet,
  SeedLeftOut,
  SeedPoint,
  SeedShared,
  SeedUnjoined,
  SeedUntracked,
  SeedUnused,
  SeedsContrast,
  SeedsFrame,
  SurfaceCrossing,
  SurfaceEnd,
  SurfaceHoles,
  SurfaceNone,
  SurfaceOpened,
  ViewBrowser,
  ViewUnsaved,
  VolumeDoubt
};

/// "seed-unused"
std::string_view warningName(WarningCode code);

struct Warning {
  WarningCode code;
  std::string text;         ///< a sentence without a full stop, with file and finding
  std::string remedy = {};  ///< a clause: the option or the command that helps, and its effect
  std::vector<Eigen::Vector3d> places = {};  ///< mm, LPS
};

/// One line: "text, at (1.0, 2.0, 3.0) mm; remedy [seed-unused]". Of many places it has the first and
/// their number.
std::string warningText(const Warning& warning);

/// A warning whose text begins with the name of a file, fit to print.
inline Warning about(const std::string& name, Warning warning) {
  warning.text = name + ": " + warning.text;
  return warning;
}

/// Passes the line on to a listener.
void warn(Progress& progress, const Warning& warning);

}  // namespace lumen
