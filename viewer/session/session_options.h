// SPDX-License-Identifier: Apache-2.0
// Settings of a session.
#pragma once

#include "converters/cli/options.h"

namespace lumen::viewer {

/// How the session reads, tracks and fits; the same settings as on the command line.
struct SessionOptions {
  app::VolumeArguments volume;
  app::TrackArguments track;
  app::FitArguments fit;
};

}  // namespace lumen::viewer
