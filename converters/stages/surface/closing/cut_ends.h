// SPDX-License-Identifier: Apache-2.0
// Flat ends of a closed surface, and their names.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/closing/end_planes.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

struct EndsReport {
  std::size_t flat = 0;               ///< ends that were cut
  std::size_t rounded = 0;            ///< ends that no plane could cut
  std::vector<std::string> messages;  ///< a sentence for each rounded end
  std::vector<std::string> moved;     ///< a sentence for each end that was cut farther in
};

/// A surface with the field that it follows.
struct FieldSurface {
  CaseSurface* surface = nullptr;
  const SeparatedField* field = nullptr;
};

/// Cuts each of the ends flat, and closes it by a flat cap. `surfaces`: one, or a lumen's and the
/// outer one of a wall around it, which get the same ends in the same planes. Where the plane meets
/// no simple opening of at least 0.8 of the vessel's radius, it is moved inwards along the
/// centerline, by up to a radius, to the first opening of this width, or else the widest; where
/// there is none, the end stays as the field closes it. Groups are "wall"; "inlet", or
/// "inlet-LABEL" where a case has several; "outlet-LABEL"; and "cap-LABEL" for ends that could not
/// be cut; ends without a surface have none. Surfaces stay closed manifolds of the same genus.
EndsReport cutEnds(std::span<const FieldSurface> surfaces, const std::vector<EndPlane>& planes,
                   Progress& progress);

/// Cuts the case's own ends of one surface, as the overload for several surfaces does.
EndsReport cutEnds(CaseSurface& surface, const SeparatedField& field, Progress& progress);

/// Cuts `outer`, a surface that lies around `inner` and follows `field`, in the planes of its flat
/// ends: groups and ends become the same. Where a plane meets no simple opening of `outer`, the
/// end of both surfaces no longer counts as flat; returns a sentence for each.
std::vector<std::string> cutLike(CaseSurface& outer, const SeparatedField& field,
                                 CaseSurface& inner, Progress& progress);

/// Leaves out the faces of the flat ends: a boundary at each rim. Rounded ends stay closed.
void openEnds(CaseSurface& surface);

/// The rim of each end, in the order of ends: for a flat one the loop of vertices around its faces,
/// counter-clockwise seen from outside; for a rounded one nothing. Throws Error(Failed) unless the
/// edges around a flat end make one loop.
std::vector<std::vector<std::uint32_t>> findRims(const CaseSurface& surface);

}  // namespace lumen::convert
