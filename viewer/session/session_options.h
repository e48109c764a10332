// SPDX-License-Identifier: Apache-2.0
// Settings of a session.
#pragma once

#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "converters/engine/stage_options.h"

namespace lumen::viewer {

/// Settings for reading, tracking and fitting in the session; the same settings as on the command
/// line.
struct SessionOptions {
  engine::VolumeArguments volume;
  engine::TrackArguments track;
  convert::FitOptions fit;
  /// Unsaved work of a document without any named file is kept beside this one, which need not
  /// exist.
  std::filesystem::path unnamed = "lumen";
  /// Where a page looks at first, mm, LPS; none: at the widest vessel.
  std::optional<Eigen::Vector3d> look;
  /// Time of the case's motion that a page shows first, s; none: the case at rest.
  std::optional<double> time;
};

}  // namespace lumen::viewer
