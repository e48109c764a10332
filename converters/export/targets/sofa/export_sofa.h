// SPDX-License-Identifier: Apache-2.0
// A case as a folder that SOFA runs: scene.scn, scene.py, vessel.obj, case.lumen.
#pragma once

#include "converters/export/shared/target.h"
#include "converters/export/targets/sofa/instrument.h"

namespace lumen::convert {

// Options of scenes of SOFA.

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

/// The files, in mm and LPS. Throws as findInsertion() and lumenSurface().
ExportResult exportSofa(const ExportInput& input, const SofaOptions& options);

TargetRow sofaRow();

}  // namespace lumen::convert
