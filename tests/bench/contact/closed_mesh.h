// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/case/case.h"
#include "method.h"

namespace lumen::bench {

/// The closed surface of a case as `lumen convert` makes it, with its triangles reduced as far as a
/// twentieth of a voxel allows: what a simulator would load, and fewer triangles than the default, which
/// makes every search among them faster. Throws as convert::closedSurface().
Triangles closedMesh(const formats::Case& source);

}  // namespace lumen::bench
