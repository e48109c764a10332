// SPDX-License-Identifier: Apache-2.0
// Text files that are part of the program (the function lumen_embed() of cmake/embed.cmake), and
// values in their placeholders.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace lumen::convert {

struct EmbeddedText {
  std::string_view
      name;  ///< name of its file, relative to the folder of the CMakeLists.txt that embeds it
  std::string_view bytes;
};

struct TextValue {
  std::string_view name;
  std::string value;
};

/// `text` with a value in the place of each {name}; names begin with a small letter and have
/// letters only, so other braces stay. A placeholder alone on its line goes with its line break if
/// the value is empty or ends with one. Throws std::logic_error, a fault of the program, for a
/// placeholder without a value and a value without a placeholder.
std::string filled(std::string_view text, std::initializer_list<TextValue> values);

}  // namespace lumen::convert
