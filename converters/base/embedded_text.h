// SPDX-License-Identifier: Apache-2.0
// A text file that is part of the program: the function lumen_embed() of cmake/embed.cmake.
#pragma once

#include <string_view>

namespace lumen::convert {

struct EmbeddedText {
  std::string_view
      name;  ///< name of its file, relative to the folder of the CMakeLists.txt that embeds it
  std::string_view bytes;
};

}  // namespace lumen::convert
