// SPDX-License-Identifier: Apache-2.0
// STL whose coordinates are metres, as MuJoCo takes them.
#pragma once

#include <algorithm>
#include <string>

#include "converters/mesh/write_plain.h"

namespace lumen::convert {

/// Binary STL of a surface that is in metres, LPS, and says so in its head.
inline std::string stlInMetres(const SurfaceMesh& metres) {
  std::string bytes = encodeStl(metres, false);
  std::string head = "lumen " LUMEN_VERSION ", binary STL, m, SPACE=LPS (+x left, +y posterior)";
  head.resize(80, ' ');
  std::copy(head.begin(), head.end(), bytes.begin());
  return bytes;
}

}  // namespace lumen::convert
