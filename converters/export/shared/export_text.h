// SPDX-License-Identifier: Apache-2.0
// Texts of exported folders: files below targets/NAME/texts, which are part of the program.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "converters/base/embedded_text.h"

namespace lumen::convert {

/// filled() of the file targets/NAME/texts/FILE; `name` is "NAME/FILE". Throws std::logic_error if
/// there is none.
std::string exportText(std::string_view name, std::initializer_list<TextValue> values = {});

}  // namespace lumen::convert
