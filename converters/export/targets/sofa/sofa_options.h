// SPDX-License-Identifier: Apache-2.0
// Options of scenes of SOFA.
#pragma once

#include "converters/export/targets/sofa/instrument.h"

namespace lumen::convert {

enum class WallKind {
  Mesh,      ///< triangles, stock SOFA
  Implicit,  ///< the case itself, by the plugin LumenSofa
  Soft,      ///< the case itself along the path of the instrument, which gives way, by LumenSofa
  Grid       ///< distances on a grid, by the plugins SofaDistanceGrid and SofaImplicitField
};
/// Whether the plugin LumenSofa holds the wall.
constexpr bool isOfCase(WallKind wall) {
  return wall == WallKind::Implicit || wall == WallKind::Soft;
}
enum class SofaDialect { Current, V23_06 };

struct SofaOptions {
  InstrumentKind instrument = InstrumentKind::Guidewire;
  WallKind wall = WallKind::Mesh;
  SofaDialect dialect = SofaDialect::Current;
  double step = 0.1;  ///< mm that an instrument advances in a time step
};

}  // namespace lumen::convert
