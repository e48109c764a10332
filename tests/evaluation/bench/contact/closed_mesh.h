// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/case/case.h"
#include "method.h"

namespace lumen::bench {

/// The closed surface of a case as `lumen convert CASE MESH --edge 0.5r` makes it: what a simulator would
/// load, with a quarter of the default's triangles, which makes every search among them faster. Throws as
/// convert::closedSurface().
Triangles closedMesh(const formats::Case& source);

}  // namespace lumen::bench
