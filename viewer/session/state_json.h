// SPDX-License-Identifier: Apache-2.0
// The state that pages get.
#pragma once

#include "viewer/session/workspace.h"

namespace lumen::viewer {

/// The members of viewer/README.md, "State".
Json stateJson(const Workspace& workspace);

}  // namespace lumen::viewer
