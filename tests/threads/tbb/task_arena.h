// SPDX-License-Identifier: Apache-2.0
// See parallel_for.h.
#pragma once

#include <tbb/global_control.h>

namespace tbb::this_task_arena {

inline int max_concurrency() {
  return static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}

}  // namespace tbb::this_task_arena
