// SPDX-License-Identifier: Apache-2.0
// Where the user says that vessels begin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// One click. `radius` is the user's estimate at this point, mm (for an aneurysm: distance to the
/// wall).
struct SeedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  std::optional<double> radius;                        ///< mm, > 0
};

struct SeedBranch {
  std::string label;  ///< unique
  formats::BranchKind kind = formats::BranchKind::Vessel;
  std::optional<std::string> parent;  ///< label of another branch
  std::vector<SeedPoint> points;      ///< at least one; a vessel's second point gives its direction
  std::optional<Eigen::Vector3d> direction;  ///< unit, LPS
};

/// Reads a seeds file: lumen's own JSON (spec/seeds.md), or 3D Slicer Markups (`.mrk.json`).
/// Branches come parents first, otherwise in file order. Throws Error(InvalidInput), naming file
/// and label.
std::vector<SeedBranch> readSeeds(const std::filesystem::path& file);

/// Refuses seed points outside the volume. Throws Error(InvalidInput), naming the label and `file`.
void checkSeedsInside(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                      const std::filesystem::path& file);

/// Writes lumen's own JSON, atomically.
void writeSeeds(const std::vector<SeedBranch>& seeds, const std::filesystem::path& file);

}  // namespace lumen::convert
