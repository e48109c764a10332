// SPDX-License-Identifier: Apache-2.0
// Facts of a mesh for `lumen info`.
#pragma once

#include <string>

#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/mesh_input.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/stages/repair/mesh_report.h"

namespace lumen::engine {

struct MeshInfo {
  convert::MeshFile file;
  convert::MeshReport report;  ///< in the file's unit
  operations::MeshFrame frame;
};

/// `unit` is the user's, or empty. Warns where the unit is a guess that is not mm.
MeshInfo describeMesh(convert::MeshFile file, const std::string& name, const std::string& unit,
                      Progress& progress);

Json meshInfoJson(const MeshInfo& info);
std::string meshInfoText(const MeshInfo& info);

}  // namespace lumen::engine
