// SPDX-License-Identifier: Apache-2.0
// Synthetic angiograms with a known truth. Nothing here is patient data.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "converters/volume/seeds.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct PhantomOptions {
  std::string name;             ///< one of phantomNames()
  int size = 0;                 ///< voxels along an edge; 0: the phantom's own (128; patient 256)
  double voxel = 0.2;           ///< mm
  double noise = 0.05;          ///< standard deviation, as a share of the vessels' contrast
  double bias = 0.1;            ///< amplitude of the slow bias field, as a share of the contrast
  double psf = 0.6;             ///< standard deviation of the Gaussian point-spread function, in voxels
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
