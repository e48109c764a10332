// SPDX-License-Identifier: Apache-2.0
// Declared in surface_options.h.
#include <charconv>
#include <cmath>

#include "converters/base/error.h"
#include "converters/stages/surface/surface_options.h"
#include "formats/container/printable.h"

namespace lumen::convert {

Length parseLength(std::string_view text, const std::string& option) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit = text.substr(static_cast<std::size_t>(stop - text.data()));
  const bool isUnit = unit.empty() || unit == "mm" || unit == "r";
  if (error != std::errc{} || !isUnit || !std::isfinite(value) || !(value > 0))
    throw Error(ErrorKind::Usage, option + ": found " + formats::printable(text) +
                                      ", expected a length above 0 in mm, such as 0.5 or "
                                      "0.5mm, or in radii, such as 5r");
  return unit == "r" ? Length{0, value} : Length{value, 0};
}

SurfaceError parseSurfaceError(std::string_view text, const std::string& option) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit = text.substr(static_cast<std::size_t>(stop - text.data()));
  const bool isUnit = unit.empty() || unit == "mm" || unit == "r" || unit == "v";
  if (error != std::errc{} || !isUnit || !std::isfinite(value) || !(value >= 0))
    throw Error(ErrorKind::Usage, option + ": found " + formats::printable(text) +
                                      ", expected 0 or a distance in mm, such as 0.05 or "
                                      "0.05mm, in voxels, such as 0.1v, or in radii, such as "
                                      "0.03r");
  if (unit == "r") return {.radii = value};
  if (unit == "v") return {.voxels = value};
  return {.mm = value};
}

EndLength parseEndLength(std::string_view text, const std::string& option) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return {"", parseLength(text, option)};
  if (equals == 0)
    throw Error(ErrorKind::Usage, option + ": found " + formats::printable(text) +
                                      ", expected the label of a branch before the \"=\"");
  return {std::string(text.substr(0, equals)), parseLength(text.substr(equals + 1), option)};
}

}  // namespace lumen::convert
