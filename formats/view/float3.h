// SPDX-License-Identifier: Apache-2.0
// Three floats without padding, as they lie in files.
#pragma once

#include <array>

namespace lumen::formats {

/// A position (mm) or a unit direction, in a case and in meshes.
using Float3 = std::array<float, 3>;

}  // namespace lumen::formats
