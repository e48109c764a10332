// SPDX-License-Identifier: Apache-2.0
// Names of face kinds in files.
#pragma once

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

constexpr const char* faceKindName(FaceKind kind) {
  switch (kind) {
    case FaceKind::Inlet:
      return "inlet";
    case FaceKind::Outlet:
      return "outlet";
    case FaceKind::Cap:
      return "cap";
    case FaceKind::Wall:
      break;
  }
  return "wall";
}

}  // namespace lumen::convert
