// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/volume_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/geometry/far_origin.h"
#include "converters/voxels/label_voxels.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

// Headers store directions with 6 to 17 digits; beyond this they describe a sheared grid.
constexpr double kDirectionTolerance = 1e-3;
constexpr double kMaxVoxels = 1e11;

// Deflate expands at most 1032 times (zlib's technical notes).
constexpr double kMaxExpansion = 1032;

/// Refuses a volume without a finite value, and constant ones unless they are allowed.
template <class T>
void checkValues(const std::vector<T>& voxels, const fs::path& path, bool allowsConstant) {
  if constexpr (std::is_floating_point_v<T>) {
    const auto bad =
        std::count_if(voxels.begin(), voxels.end(), [](T v) { return !std::isfinite(v); });
    if (bad > 0)
      throw invalidInput(path.string() + ": " + std::to_string(bad) +
                         " of its voxels are not finite; expected numbers within a float's range");
  }
  if (allowsConstant) return;
  const bool constant = std::all_of(voxels.begin(), voxels.end(),
                                    [&](T v) { return !(v < voxels[0]) && !(v > voxels[0]); });
  if (constant)
    throw invalidInput(path.string() + ": every voxel is " +
                       shownNumber(static_cast<double>(voxels[0])) +
                       "; expected an image with vessels in it");
}

/// The value around labels, 0, where the finite voxels are labels from 1 on; else the least of them,
/// and infinity if there is none.
float aroundFinite(const std::vector<float>& voxels) {
  constexpr double kBesideWhole = 1e-3;  // as of settleLabels()
  std::vector<float> rounded(voxels.size());
  float least = std::numeric_limits<float>::infinity();
  bool areWhole = true;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (!std::isfinite(voxels[i])) continue;
    least = std::min(least, voxels[i]);
    rounded[i] = std::round(voxels[i]);
    areWhole = areWhole && std::abs(static_cast<double>(voxels[i] - rounded[i])) <= kBesideWhole;
  }
  if (!std::isfinite(least)) return least;
  return areWhole && least > 0.5F && !isGrey(rounded) ? 0.0F : least;
}

/// Sets voxels that are not finite to what is around the others. They stay where no other is finite.
void padNotFinite(std::vector<float>& voxels, Volume& volume) {
  const auto isNone = [](float v) { return !std::isfinite(v); };
  const auto count = std::count_if(voxels.begin(), voxels.end(), isNone);
  if (count == 0) return;
  const float around = aroundFinite(voxels);
  if (!std::isfinite(around)) return;
  std::replace_if(voxels.begin(), voxels.end(), isNone, around);
  volume.padding = {around, around};
  volume.assumptions.push_back(std::to_string(count) +
                               " of its voxels are not finite (NaN, or infinite); they count as "
                               "no image, with the value " +
                               shownNumber(static_cast<double>(around)));
}

}  // namespace

void checkGeometry(VolumeGeometry& geometry, const fs::path& path) {
  double voxels = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (geometry.size[a] < 2)
      throw invalidInput(path.string() + ": has " + std::to_string(geometry.size[a]) +
                         (geometry.size[a] == 1 ? " voxel" : " voxels") + " along axis " +
                         std::to_string(a + 1) +
                         ", so it is not 3-D; expected at least 2 along each of three axes");
    voxels *= geometry.size[a];
    const double spacing = geometry.spacing[static_cast<Eigen::Index>(a)];
    if (!(std::isfinite(spacing) && spacing > 0))
      throw invalidInput(path.string() + ": the spacing along axis " + std::to_string(a + 1) +
                         " is " + shownNumber(spacing) + "; expected a positive number of mm");
  }
  if (voxels > kMaxVoxels)
    throw invalidInput(path.string() + ": its header announces more than 1e11 voxels");
  if (!geometry.origin.allFinite())
    throw invalidInput(path.string() + ": its origin is not finite; expected three numbers of mm");
  auto& direction = geometry.direction;
  const double fault =
      (direction.transpose() * direction - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  // Eigen's maxCoeff() may pass over NaN
  if (!direction.allFinite() || !(fault <= kDirectionTolerance))
    throw invalidInput(
        path.string() + ": its axes' directions are not orthogonal unit vectors (off by " +
        shownNumber(fault) + "; expected at most " + shownNumber(kDirectionTolerance) +
        "); resample the volume to an orthogonal grid first");
  if (fault > 1e-14) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(direction,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    direction = svd.matrixU() * svd.matrixV().transpose();
  }
}

void moveFarOrigin(VolumeGeometry& geometry, std::vector<std::string>& assumptions) {
  const Eigen::Vector3d move = farMove(geometry.origin);
  if (move.isZero(0)) return;
  geometry.origin -= move;
  assumptions.push_back(farSentence("its origin is", move));
}

void checkStatedSpacing(const fs::path& path, const std::string& field, int axis, double value,
                        const FieldWord& word) {
  if (std::isfinite(value) && value > 0) return;
  throw invalidInput(path.string() + ": " + field + " states a spacing of " + longNumber(value) +
                     " along axis " + std::to_string(axis) +
                     "; expected a positive number; state it with " + word("spacing"));
}

void checkRoom(const fs::path& path, double needed, double available, bool compressed) {
  if (needed <= available * (compressed ? kMaxExpansion : 1)) return;
  throw invalidInput(path.string() + ": truncated: its header announces " + longNumber(needed) +
                     " bytes of voxels, but " + longNumber(std::max(available, 0.0)) +
                     " bytes of data are there");
}

void refuseDimensions(const fs::path& path, unsigned dimensions, const std::string& sizes) {
  throw invalidInput(path.string() + ": is " + std::to_string(dimensions) + "-D (" + sizes +
                     "); expected a 3-D volume");
}

std::uint64_t chosenVolume(const fs::path& path, const std::string& sizes, std::uint64_t volumes,
                           const ReadVolumeOptions& options) {
  const std::optional<int>& wanted = options.volumeIndex;
  if (volumes == 1 && wanted)
    throw invalidInput(path.string() + ": holds one volume; " + options.word("volume-index") +
                       " is for files of several");
  if (volumes == 1) return 0;
  const std::string choice = options.word("volume-index") + " 0 to " + std::to_string(volumes - 1);
  const auto dimensions = 1 + std::count(sizes.begin(), sizes.end(), 'x');
  const std::string what =
      path.string() + ": is " + std::to_string(dimensions) + "-D (" + sizes + ")";
  if (!wanted)
    throw invalidInput(what + "; expected a 3-D volume; choose one of its " +
                       std::to_string(volumes) + " with " + choice);
  if (*wanted < 0 || static_cast<std::uint64_t>(*wanted) >= volumes)
    throw invalidInput(what + " and has no volume " + std::to_string(*wanted) + "; expected " +
                       choice);
  return static_cast<std::uint64_t>(*wanted);
}

std::string longNumber(double value) {
  return shownNumber(value, kHeaderDigits);
}

void checkVoxels(Volume& volume, const fs::path& path, bool allowsConstant) {
  if (auto* const floats = std::get_if<std::vector<float>>(&volume.voxels))
    padNotFinite(*floats, volume);
  std::visit([&](const auto& values) { checkValues(values, path, allowsConstant); }, volume.voxels);
}

}  // namespace lumen::convert
