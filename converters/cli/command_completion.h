// SPDX-License-Identifier: Apache-2.0
// lumen completion: the words that a shell offers when the tabulator key is pressed.
#pragma once

#include <memory>

#include "converters/engine/command.h"

namespace lumen::cli {

std::unique_ptr<engine::Command> makeCompletionCommand();

}  // namespace lumen::cli
