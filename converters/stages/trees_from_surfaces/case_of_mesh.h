// SPDX-License-Identifier: Apache-2.0
// Conversion of the surface of vessels to a case: its tree and its wall points (docs/method.md,
// section 10).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The centerline that a surface comes with.
struct GivenCenterline {
  CenterlineFile file;  ///< mm, LPS
  std::string name;     ///< name of its file, printable, for messages
};

struct MeshCase {
  formats::Case result;            ///< tree, wall points and metadata, without models
  std::vector<MeshEnd> openings;   ///< of the surface: all of them are ends, but for remarks
  std::vector<std::string> notes;  ///< remarks for the user, a sentence each
};

/// The case of a vessel's surface. `mesh` is repaired: oriented and manifold, closed or open where
/// vessels end; mm, LPS. `name` is that of its file, printable. `parameters` are stored with the
/// step. The result has the same bits on any number of threads. A wall that has a thickness is
/// replaced by its inner side, which `notes` reports. Throws Error(InvalidInput) if there is no
/// vessel in it, or for a centerline that does not lie in it; and Error(Cancelled).
MeshCase caseOfMesh(TriangleMesh mesh, const std::string& name,
                    const std::optional<GivenCenterline>& centerline,
                    const std::map<std::string, formats::ParameterValue>& parameters,
                    Progress& progress);

/// The case of a mesh that is known to be the surface of a lumen, nowhere narrower than
/// `resolution`, mm; otherwise like caseOfMesh().
MeshCase caseOfLumen(const ClosedMesh& surface, double resolution, const std::string& name,
                     const std::optional<GivenCenterline>& centerline,
                     const std::map<std::string, formats::ParameterValue>& parameters,
                     Progress& progress);

}  // namespace lumen::convert
