// SPDX-License-Identifier: Apache-2.0
// Rigid registration of two images by ITK.
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Whether lumen was built with ITK.
bool canRegister();

/// The rigid motion that leads from places in `fixed` to those in `moving`, mm, LPS, with the least
/// mean square of the difference of both images at `points`, places in `fixed`; sought downhill
/// from `start`, which is returned if too few of the points lie in `moving`. Images have voxels of
/// type float. The same bits on any number of threads, as it runs on one. Throws Error(Cancelled),
/// and Error(Unsupported) if lumen was built without ITK.
Eigen::Isometry3d registerRigid(const Volume& fixed, const Volume& moving,
                                std::span<const Eigen::Vector3d> points,
                                const Eigen::Isometry3d& start, const Progress& progress);

}  // namespace lumen::convert
