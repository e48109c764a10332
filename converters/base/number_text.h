// SPDX-License-Identifier: Apache-2.0
// Numbers in the text files of other programs, whatever the locale of a person; zero has no sign.
#pragma once

#include <string>

namespace lumen::convert {

/// At most `digits` significant digits; nine read back as the same float.
std::string numberText(double value, int digits = 9);

/// `decimals` decimals, for people.
std::string fixedText(double value, int decimals);

}  // namespace lumen::convert
