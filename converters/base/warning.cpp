// SPDX-License-Identifier: Apache-2.0
#include "converters/base/warning.h"

#include <algorithm>
#include <cstddef>

#include "converters/base/shown_text.h"

namespace lumen {

std::string_view warningName(WarningCode code) {
  switch (code) {
    case WarningCode::BatchDoubt:
      return "batch-doubt";
    case WarningCode::CaseOtherVolume:
      return "case-other-volume";
    case WarningCode::CaseSeeds:
      return "case-seeds";
    case WarningCode::CorrectionLeft:
      return "correction-left";
    case WarningCode::ExportLoss:
      return "export-loss";
    case WarningCode::FileAssumption:
      return "file-assumption";
    case WarningCode::FilesPassedOver:
      return "files-passed-over";
    case WarningCode::FlowDoubt:
      return "flow-doubt";
    case WarningCode::FormatLoss:
      return "format-loss";
    case WarningCode::ImageMotion:
      return "image-motion";
    case WarningCode::LabelsBare:
      return "labels-bare";
    case WarningCode::LabelsSettled:
      return "labels-settled";
    case WarningCode::LumenClosed:
      return "lumen-closed";
    case WarningCode::LumenContact:
      return "lumen-contact";
    case WarningCode::MeshRepaired:
      return "mesh-repaired";
    case WarningCode::MeshUnit:
      return "mesh-unit";
    case WarningCode::ModelsMissing:
      return "models-missing";
    case WarningCode::NativeUnmatched:
      return "native-unmatched";
    case WarningCode::OptionUnused:
      return "option-unused";
    case WarningCode::PersonalText:
      return "personal-text";
    case WarningCode::PictureOld:
      return "picture-old";
    case WarningCode::ReportWarnings:
      return "report-warnings";
    case WarningCode::RootUnused:
      return "root-unused";
    case WarningCode::RowFailed:
      return "row-failed";
    case WarningCode::SeedInlet:
      return "seed-inlet";
    case WarningCode::SeedLeftOut:
      return "seed-left-out";
    case WarningCode::SeedPoint:
      return "seed-point";
    case WarningCode::SeedShared:
      return "seed-shared";
    case WarningCode::SeedUnjoined:
      return "seed-unjoined";
    case WarningCode::SeedUntracked:
      return "seed-untracked";
    case WarningCode::SeedUnused:
      return "seed-unused";
    case WarningCode::SeedsContrast:
      return "seeds-contrast";
    case WarningCode::SeedsFrame:
      return "seeds-frame";
    case WarningCode::SurfaceCrossing:
      return "surface-crossing";
    case WarningCode::SurfaceEnd:
      return "surface-end";
    case WarningCode::SurfaceHoles:
      return "surface-holes";
    case WarningCode::SurfaceNone:
      return "surface-none";
    case WarningCode::SurfaceOpened:
      return "surface-opened";
    case WarningCode::ViewBrowser:
      return "view-browser";
    case WarningCode::ViewUnsaved:
      return "view-unsaved";
    case WarningCode::VolumeDoubt:
      return "volume-doubt";
  }
  return "";
}

std::string warningText(const Warning& warning) {
  constexpr std::size_t kMostPlaces = 3;
  std::string text = warning.text;
  const std::size_t count = warning.places.size(), shown = std::min(count, kMostPlaces);
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? ", at " : ", ") + convert::placeText(warning.places[i]);
  if (shown > 0) text += " mm";
  if (count > shown) text += " and " + std::to_string(count - shown) + " more";
  if (!warning.remedy.empty()) text += "; " + warning.remedy;
  return text + " [" + std::string(warningName(warning.code)) + "]";
}

void warn(Progress& progress, const Warning& warning) {
  progress.warn(warningText(warning));
}

}  // namespace lumen
