// SPDX-License-Identifier: Apache-2.0
// Synthetic angiograms with a known truth. Nothing here is patient data.
//
// The volume is a cube: origin 0, identity direction, equal spacing. A voxel's intensity is 100
// outside of vessels and 1100 within them (less where `dropout` loses contrast); voxels that the
// wall crosses have the share of them that lies inside. Then come the point-spread function, the
// bias field, and white noise.
//
// The truth defines the wall exactly: the union of the round cones between consecutive nodes of
// each branch (common/tube_tree_distance.h). Nodes are about half a voxel apart. Ends are round; a
// vessel that leaves the volume ends on the plane of the outermost voxel centres. A child's first
// node lies on its parent's axis. Where a vessel divides, the wider child goes on as the same
// branch. An aneurysm is a branch from its parent's axis to the centre of its sac, each radius that
// of the largest ball inside.
//
// Shapes scale with the volume's edge. Radii of the small phantoms are given for 25.4 mm (128
// voxels of 0.2 mm), where they are 0.63 to 2.6 mm, and scale by no less than 0.5 and no more
// than 1.5. `patient` keeps radii of 2.2 to 0.25 mm (at least 1.25 voxels) in volumes of 50 mm or
// more; it has 40 branches from 45 mm on, in proportion fewer in smaller volumes, and its branches
// get shorter with the volume. Its step in the metadata names the two vessels that touch
// ("kissing").
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "converters/seeds/seeds.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct PhantomOptions {
  std::string name;     ///< one of phantomNames()
  int size = 0;         ///< voxels along an edge; 0: the phantom's own (128; patient 256)
  double voxel = 0.2;   ///< mm
  double noise = 0.05;  ///< standard deviation, as a share of the vessels' contrast
  double bias = 0.1;    ///< amplitude of the slow bias field, as a share of the contrast
  double psf = 0.6;     ///< standard deviation of the Gaussian point-spread function, in voxels
  std::uint64_t seed = 1;
  [[nodiscard]] std::map<std::string, formats::ParameterValue> parameters() const;
};

struct Phantom {
  Volume volume;                  ///< int16
  formats::Case truth;            ///< the true tree, densely sampled; no points, no models
  std::vector<SeedBranch> seeds;  ///< what a user would click
};

/// tube, helix, bifurcation, kissing, aneurysm, stenosis, dropout, patient.
const std::vector<std::string>& phantomNames();

/// Throws Error(Usage) for an unknown name or options out of range, and Error(Cancelled).
Phantom makePhantom(const PhantomOptions& options, Progress& progress);

}  // namespace lumen::convert
