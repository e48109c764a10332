// SPDX-License-Identifier: Apache-2.0
// A case as the cache that NVIDIA's catheter navigation (isaac-for-healthcare) reads, and as a
// stage of USD.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// The cache, always in mm and LPS, its arrays in the order z, y, x: metadata.json, mu_volume.npy
/// (synthetic: see isaac.cpp), vessel_mask.npy, centerline_points_mm.npy, centerline_edges.npy,
/// centerline_radii_mm.npy. vessel.usda in the folder's frame: a thick wall. Throws Error(Usage) for
/// too many samples, and as wallSurface().
ExportResult exportIsaac(const ExportInput& input);

TargetRow isaacRow();

}  // namespace lumen::convert
