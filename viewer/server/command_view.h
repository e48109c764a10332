// SPDX-License-Identifier: Apache-2.0
// lumen view: the viewer, as a page that this program serves.
#pragma once

#include <memory>

#include "converters/engine/command.h"

namespace lumen::viewer {

std::unique_ptr<engine::Command> makeViewCommand();

}  // namespace lumen::viewer
