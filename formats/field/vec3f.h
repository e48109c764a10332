// SPDX-License-Identifier: Apache-2.0
// A point or direction as files store it.
#pragma once

namespace lumen::formats {

/// A position (mm) or a unit direction in LPS patient coordinates: +x left, +y posterior, +z
/// superior.
struct Vec3f {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3f&, const Vec3f&) = default;
};

}  // namespace lumen::formats
