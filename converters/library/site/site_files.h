// SPDX-License-Identifier: Apache-2.0
// The style sheet and the scripts of the site, which are built into the program: the files of those
// names beside this.
#pragma once

#include <span>

#include "converters/base/embedded_text.h"

namespace lumen::convert {

std::span<const EmbeddedText> siteFiles();

}  // namespace lumen::convert
