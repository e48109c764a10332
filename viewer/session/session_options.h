// SPDX-License-Identifier: Apache-2.0
// Settings of a session.
#pragma once

#include "converters/engine/stage_options.h"

namespace lumen::viewer {

/// How the session reads, tracks and fits; the same settings as on the command line.
struct SessionOptions {
  engine::VolumeArguments volume;
  engine::TrackArguments track;
  convert::FitOptions fit;
};

}  // namespace lumen::viewer
