// SPDX-License-Identifier: Apache-2.0
// The table of targets of `lumen export`: simulators, each of which gets a folder of files. All that the
// command line knows of one is its row.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/app/report.h"
#include "converters/common/named_file.h"
#include "converters/common/progress.h"
#include "converters/sofa/scene.h"
#include "converters/surface/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::app {

/// What targets may be asked for; each takes what concerns it.
struct ExportOptions {
  convert::SofaOptions sofa;
  convert::ClosedSurfaceOptions surface;
};

struct ExportResult {
  std::vector<NamedFile> files;
  std::optional<convert::SurfaceReport> surface;
  std::vector<std::string> remarks;  ///< sentences for the answer
};

struct ExportTarget {
  /// The files of a valid case with models. `folder`: its name, for warnings of what is lost. Throws
  /// lumen::Error.
  using Writer = ExportResult (*)(const formats::Case& value, const std::string& folder,
                                  const ExportOptions& options, Progress& progress);

  std::string_view name;                ///< as the command takes it
  std::string_view title;               ///< what reads the folder
  std::vector<std::string_view> files;  ///< that are in it
  std::string_view unit, frame;         ///< of lengths and positions
  std::string_view holds;               ///< of a case
  std::string_view lacks;
  std::vector<std::string_view> options;  ///< that it takes besides those of all
  Writer write = nullptr;
};

const std::vector<ExportTarget>& exportTargets();

/// The target of that name. Throws Error(Unsupported), with the targets that there are.
const ExportTarget& exportTarget(std::string_view name);

}  // namespace lumen::app
