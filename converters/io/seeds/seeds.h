// SPDX-License-Identifier: Apache-2.0
// Points at which vessels begin, from the user.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/field_word.h"
#include "converters/base/input_file.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// One click. `radius` is the user's estimate at this point, mm (for an aneurysm: distance to the
/// wall).
struct SeedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  std::optional<double> radius;                        ///< mm, > 0
};

/// The coordinates of a file. Voxel: indices, (0, 0, 0) at the centre of the volume's first voxel.
enum class SeedSystem : std::uint8_t { Lps, Ras, Voxel };

/// Turns a file's coordinates into LPS millimetres. Positions and directions in voxels stay
/// unchanged: the volume alone places them.
struct SeedFrame {
  SeedSystem system = SeedSystem::Lps;
  double unit = 1;  ///< mm; unit of radii, and of positions unless these are in voxels

  [[nodiscard]] Eigen::Vector3d direction(const Eigen::Vector3d& v) const {
    return system == SeedSystem::Ras ? Eigen::Vector3d(-v.x(), -v.y(), v.z()) : v;
  }
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& v) const {
    return (system == SeedSystem::Voxel ? 1.0 : unit) * direction(v);
  }
};

struct SeedBranch {
  std::string label;  ///< unique
  formats::BranchKind kind = formats::BranchKind::Vessel;
  std::optional<std::string> parent;  ///< label of another branch
  std::vector<SeedPoint> points;      ///< at least one; a vessel's second point gives its direction
  std::optional<Eigen::Vector3d> direction;  ///< unit, LPS
  /// Frame of its coordinates; Voxel until they are placed (place_seeds.h).
  SeedFrame frame{};
  bool isRoot = false;     ///< blood comes in through its end nearest to the first point
  bool isTracked = false;  ///< the case that it lies in was tracked with it (case_seeds.h)
};

/// A seed that started no track, or a point of one that the track does not pass through.
struct SeedFailure {
  std::string label;
  std::string reason;  ///< one sentence, with the numbers that decided
};

/// Frame and unit that an option states; they override those of the file.
struct SeedReading {
  std::optional<SeedSystem> system;
  std::optional<double> unit;  ///< mm
  /// Names the fields "seeds-frame" and "seeds-unit", by which a caller states these, in messages.
  FieldWord word{};
};

/// Reads a seeds file: lumen's own JSON (spec/seeds.md), 3D Slicer Markups (`.mrk.json`), or
/// Slicer's older `.fcsv`; the content decides which. Branches come parents first, otherwise in
/// file order; a point in the place of its predecessor is merged with it. Throws
/// Error(InvalidInput), naming file, place, finding and expectation.
std::vector<SeedBranch> readSeeds(const InputFile& file, const SeedReading& reading = {});

/// Writes lumen's own JSON, or curves of 3D Slicer if the file's name ends in .mrk.json; atomically.
/// The text of a file of seeds: Markups of 3D Slicer if its name ends in .mrk.json, lumen's JSON
/// otherwise.
std::string encodeSeeds(const std::vector<SeedBranch>& seeds, const std::filesystem::path& name);

void writeSeeds(const std::vector<SeedBranch>& seeds, const std::filesystem::path& file);

}  // namespace lumen::convert
