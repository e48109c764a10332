// SPDX-License-Identifier: Apache-2.0
// Texts and points of files, as they appear in messages.
#pragma once

#include <string>

#include <Eigen/Core>

#include "converters/base/number_text.h"
#include "formats/container/printable.h"

namespace lumen::convert {

/// A text of a file between quotes, short enough for a sentence.
inline std::string quotedText(const std::string& text) {
  std::size_t shown = 80;  // bytes
  if (text.size() <= shown) return std::string("\"").append(formats::printable(text)).append("\"");
  while (shown > 0 && (static_cast<unsigned char>(text[shown]) & 0xC0U) == 0x80U) --shown;
  return std::string("\"").append(formats::printable(text.substr(0, shown))).append("...\"");
}

inline std::string vectorText(const Eigen::Vector3d& v) {
  return "(" + shownNumber(v.x()) + ", " + shownNumber(v.y()) + ", " + shownNumber(v.z()) + ")";
}

}  // namespace lumen::convert
