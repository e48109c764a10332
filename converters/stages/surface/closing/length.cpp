// SPDX-License-Identifier: Apache-2.0
// Declared in surface_options.h.
#include <algorithm>
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
  SurfaceError result;
  for (std::string_view rest = text;;) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view part = rest.substr(0, comma);
    double value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    const std::string_view unit = part.substr(static_cast<std::size_t>(stop - part.data()));
    const bool isUnit = unit.empty() || unit == "mm" || unit == "r" || unit == "v";
    if (error != std::errc{} || !isUnit || !std::isfinite(value) || !(value >= 0))
      throw Error(ErrorKind::Usage, option + ": found " + formats::printable(text) +
                                        ", expected 0 or a distance in mm, such as 0.05 or "
                                        "0.05mm, in voxels, such as 0.1v, in radii, such as 0.03r, "
                                        "or the larger of several, such as 0.1v,0.03r");
    (unit == "r" ? result.radii : unit == "v" ? result.voxels : result.mm) = value;
    if (comma == rest.size()) return result;
    rest.remove_prefix(comma + 1);
  }
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
