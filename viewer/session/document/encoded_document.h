// SPDX-License-Identifier: Apache-2.0
// The document as a file to download.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/stage_options.h"
#include "viewer/session/document/document.h"
#include "viewer/session/document/one_thread.h"

namespace lumen::viewer {

// Settings of a session.

/// Settings for reading, tracking and fitting in the session; the same settings as on the command
/// line.
struct SessionOptions {
  engine::VolumeArguments volume;
  engine::MaskArguments labels;  ///< of the label map that was named
  engine::TrackArguments track;
  convert::FitOptions fit;
  /// Unsaved work of a document without any named file is kept beside this one, which need not
  /// exist.
  std::filesystem::path unnamed = "lumen";
  /// Where a page looks at first, mm, LPS; none: at the widest vessel.
  std::optional<Eigen::Vector3d> look;
  /// Time of the case's motion that a page shows first, s; none: the case at rest.
  std::optional<double> time;
  /// Given: the session starts no thread.
  std::optional<OneThread> oneThread;
};

/// Pairs of an option's name without hyphens, and its value.
using SavingOptions = std::vector<std::pair<std::string, std::string>>;

/// The case, its mesh, its centerline or the seeds in that format, as `lumen convert` with these
/// options writes it; a case without models is fitted for a mesh.
/// "TARGET.zip" is the folder of `lumen export TARGET` with its defaults.
/// Throws Error(Usage) for an unknown format or option, and as the encoders.
std::string encoded(const Document& document, const std::string& format,
                    const SavingOptions& options, const SessionOptions& settings,
                    Progress& progress);

}  // namespace lumen::viewer
