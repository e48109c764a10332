// SPDX-License-Identifier: Apache-2.0
// Parts of scenes of MuJoCo and CathSim: numbers, sites, meshes in metres.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/export/shared/frame.h"
#include "converters/export/shared/insertion.h"

namespace lumen::convert {

/// Numbers with spaces between them, as MuJoCo reads them.
std::string mujocoNumbers(std::initializer_list<double> values);
std::string mujocoNumbers(const Eigen::Vector3d& vector);

/// The ends under names that need no escapes in XML, each of its own.
std::vector<NamedEnd> plainlyNamed(std::vector<NamedEnd> ends);

/// A site at the end, its z axis out of the vessel, with a line break. The name is one of
/// plainlyNamed().
std::string endSite(const ExportFrame& frame, const NamedEnd& end);

/// Binary STL of a surface that is in metres, LPS, as its header states.
std::string stlInMetres(const SurfaceMesh& metres);

}  // namespace lumen::convert
