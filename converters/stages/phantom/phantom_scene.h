// SPDX-License-Identifier: Apache-2.0
// The scene of a phantom: a design, and the voxels that show it.
#pragma once

#include <set>
#include <string>

#include "converters/base/progress.h"
#include "converters/geometry/box.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"

namespace lumen::convert {

struct PhantomScene {
  Design design;           ///< with its seeds
  VolumeGeometry grid;     ///< cubic voxels, before slices are averaged
  double slice = 1;        ///< thickness of a slice, voxels
  std::string treeSha256;  ///< digest of the file with the tree; empty if the phantom has a name
};

/// Parts of a circle of Willis that the options leave out. Throws Error(Usage) for a word that names
/// none, and for another phantom.
std::set<std::string> missingParts(const PhantomOptions& options);

/// The box around the balls of a tree's nodes, mm.
Box3d boxOf(const formats::CenterlineTree& tree);

/// Refuses a tree that would take too much memory or time in voxels of `voxel` mm; `remedy`: what is
/// expected instead, in a message. Throws Error(InvalidInput).
void checkEffort(const CenterlineFile& file, double voxel, const std::string& name,
                 const std::string& remedy);

/// The clicks on a tree that came from a file, as the options state them.
std::vector<SeedBranch> clickTree(const formats::CenterlineTree& tree,
                                  const PhantomOptions& options, double voxel);

/// The phantom `options.name` in a cube. The options are within their ranges. Throws Error(Usage)
/// if the volume is too small for it, and Error(Cancelled).
PhantomScene sceneOfName(const PhantomOptions& options, Progress& progress);

/// The trees of the SWC file `options.tree`, in millimetres, where the file has them, in a box
/// around them. Throws Error(InvalidInput) for the file, and Error(Usage) for a voxel that makes
/// too many voxels, with one that does not.
PhantomScene sceneOfTree(const PhantomOptions& options, Progress& progress);

}  // namespace lumen::convert
