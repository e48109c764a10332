// SPDX-License-Identifier: Apache-2.0
// Memory and time that a row of a list needs, from the size of its input (docs/cohorts.md).
#pragma once

#include "converters/base/progress.h"
#include "converters/library/build_list.h"

namespace lumen::engine {

struct SlurmRequest {
  int megabytes = 0;
  int minutes = 0;  ///< on one core
};

/// Memory and time that the row's input asks for, by the header of a volume, and by the size of
/// another file. An input that cannot be read asks for the least; the row fails with the reason when
/// it is made.
SlurmRequest requestOf(const convert::BuildRow& row, const Progress& progress);

/// A request that is enough for `voxels`, which measured runs give with room to spare.
SlurmRequest requestFor(double voxels);

}  // namespace lumen::engine
