// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/export_text.h"

#include <algorithm>
#include <span>
#include <stdexcept>

namespace lumen::convert {

/// The files in the list of export/CMakeLists.txt.
std::span<const EmbeddedText> exportTextFiles();

std::string exportText(std::string_view name, std::initializer_list<TextValue> values) {
  const std::size_t slash = name.find('/');
  const std::string file = "targets/" + std::string(name.substr(0, slash)) + "/texts" +
                           std::string(name.substr(std::min(slash, name.size())));
  for (const EmbeddedText& text : exportTextFiles())
    if (text.name == file) return filled(text.bytes, values);
  throw std::logic_error("there is no text " + file);
}

}  // namespace lumen::convert
