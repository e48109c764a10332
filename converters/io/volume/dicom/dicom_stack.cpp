// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Share of the mean distance within which distances between slices of a regular grid agree.
constexpr double kGapTolerance = 0.02;
// Share of the mean distance by which rounded positions may lie off a regular grid.
constexpr double kRoundedTolerance = 0.1;
// The same where the decimals of positions explain more; a missing slice takes half.
constexpr double kMostRounded = 0.25;
// Lean of a stack from its first to its last slice, at most this share of a pixel.
constexpr double kShearTolerance = 0.5;
// Tolerance of slices of one grid in pixel spacing, mm, and in the axes' directions.
constexpr double kSameGrid = 1e-4;

/// Rows, columns and normal, made orthogonal as ITK's reader of DICOM does.
Matrix3d directionOf(const std::array<double, 6>& v) {
  const auto unit = [](const Vector3d& w) -> Vector3d { return w * (1 / w.norm()); };
  const Vector3d row(v[0], v[1], v[2]), column(v[3], v[4], v[5]);
  Matrix3d direction;
  direction.col(2) = unit(row.cross(column));
  direction.col(0) = unit(column.cross(direction.col(2)));
  direction.col(1) = direction.col(2).cross(direction.col(0));
  return direction;
}

/// Spacing along columns and rows; NaN where the image states none, which only a stated spacing permits.
Vector3d pixelSpacing(const DicomFrame& slice, const ReadVolumeOptions& options) {
  const auto& stated = slice.plane.pixelSpacing;
  const bool sound = stated && (*stated)[0] > 0 && (*stated)[1] > 0;
  if (!sound && !options.spacing)
    throw invalidInput(
        slice.image->file.path().string() + ": its pixel spacing (0028,0030) is " +
        (stated ? longNumber((*stated)[0]) + " and " + longNumber((*stated)[1]) : "not stated") +
        "; expected two positive numbers of mm; state the spacing with " + options.word("spacing"));
  const double none = std::numeric_limits<double>::quiet_NaN();
  return sound ? Vector3d((*stated)[1], (*stated)[0], none) : Vector3d(none, none, none);
}

/// Refuses slices without a position in space, which cannot be stacked.
void checkPlaced(const DicomFrame& slice) {
  if (!slice.plane.position || !slice.plane.orientation)
    throw invalidInput(slice.image->file.path().string() +
                       ": has no image position and orientation; expected a slice of a volume");
}

void checkSameGrid(const DicomFrame& slice, const DicomFrame& first, const fs::path& path) {
  const auto near = [](const auto& a, const auto& b) {
    if (a.has_value() != b.has_value()) return false;
    for (std::size_t i = 0; a && i < a->size(); ++i)
      if (!(std::abs((*a)[i] - (*b)[i]) < kSameGrid)) return false;
    return true;
  };
  if (slice.image->columns == first.image->columns && slice.image->rows == first.image->rows &&
      near(slice.plane.pixelSpacing, first.plane.pixelSpacing) &&
      near(slice.plane.orientation, first.plane.orientation))
    return;
  throw invalidInput(path.string() + ": " + slice.name() + " and " + first.name() +
                     " belong to one series, but differ in size, pixel spacing or orientation; "
                     "expected parallel slices of one grid");
}

/// The coarsest decimal place, mm, of which all coordinates of positions are multiples, from 1 mm to
/// 0.001 mm; 0: of none.
double decimalOf(const std::vector<DicomFrame>& slices) {
  constexpr double kExact = 1e-6;  // of the place
  for (const double decimal : {1.0, 0.1, 0.01, 0.001}) {
    const bool isAll = std::all_of(slices.begin(), slices.end(), [&](const DicomFrame& slice) {
      const Eigen::Array3d places = slice.plane.position->array() / decimal;
      return ((places - places.round()).abs() <= kExact * (1 + places.abs())).all();
    });
    if (isAll) return decimal;
  }
  return 0;
}

/// Whether slices that are sorted by position lie on a regular grid up to the rounding of their
/// positions: within a tenth of their distance, or within the rounding of their decimals. A slice that
/// is missing moves others by half a distance.
bool isRounded(const std::vector<DicomFrame>& slices, double mean) {
  double least = 0, most = 0;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    const double off = slices[n].position - slices.front().position - static_cast<double>(n) * mean;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  // along a normal that is no axis the rounding of three coordinates adds up
  const double decimals = std::sqrt(3.0) / 2 * decimalOf(slices);
  const double allowed =
      std::max(kRoundedTolerance * mean, std::min(decimals, kMostRounded * mean));
  return mean > 0 && 0.5 * (most - least) <= allowed;
}

/// Distance between slices that are sorted by position, mm.
double sliceSpacing(const std::vector<DicomFrame>& slices, const fs::path& path,
                    std::vector<std::string>& assumptions) {
  std::vector<double> gaps;
  for (std::size_t n = 1; n < slices.size(); ++n)
    gaps.push_back(slices[n].position - slices[n - 1].position);
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  const double mean =
      (slices.back().position - slices.front().position) / static_cast<double>(gaps.size());
  const auto isUsual = [&](double gap) {
    return gap > 0 && std::abs(gap - usual) <= kGapTolerance * usual;
  };
  if (!std::all_of(gaps.begin(), gaps.end(), isUsual) && sorted.front() > 0 &&
      isRounded(slices, mean)) {
    assumptions.push_back("its slices are " + shownNumber(sorted.front()) + " to " +
                          shownNumber(sorted.back()) +
                          " mm apart, as positions that are rounded; their mean distance, " +
                          shownNumber(mean) + " mm, is used");
    return mean;
  }
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    if (isUsual(gaps[n])) continue;
    throw invalidInput(path.string() + ": slices " + slices[n].name() + " and " +
                       slices[n + 1].name() + " are " + shownNumber(gaps[n]) +
                       " mm apart, where most are " + shownNumber(usual) +
                       " mm; expected a regular stack with one image for each position");
  }
  return mean;
}

void checkUpright(const std::vector<DicomFrame>& slices, const Matrix3d& direction,
                  const Vector3d& spacing, const fs::path& path) {
  const Vector3d lean = *slices.back().plane.position - *slices.front().plane.position;
  for (int a = 0; a < 2; ++a)
    if (std::abs(lean.dot(direction.col(a))) > kShearTolerance * spacing[a])
      throw invalidInput(path.string() +
                         ": its slices are shifted along themselves (a tilted gantry?); expected a "
                         "stack along the slices' normal");
}

/// Sorts slices with positions; returns their geometry.
VolumeGeometry stackPlaced(std::vector<DicomFrame>& slices, const ReadVolumeOptions& options,
                           const fs::path& path, std::vector<std::string>& assumptions) {
  VolumeGeometry geometry;
  geometry.direction = directionOf(*slices[0].plane.orientation);
  for (DicomFrame& slice : slices) {
    checkPlaced(slice);
    checkSameGrid(slice, slices[0], path);
    slice.position = geometry.direction.col(2).dot(*slice.plane.position);
  }
  std::stable_sort(slices.begin(), slices.end(), [](const DicomFrame& a, const DicomFrame& b) {
    return a.position < b.position;
  });
  geometry.spacing = pixelSpacing(slices[0], options);
  geometry.spacing[2] = sliceSpacing(slices, path, assumptions);
  checkUpright(slices, geometry.direction, options.spacing.value_or(geometry.spacing), path);
  geometry.origin = *slices[0].plane.position;
  return geometry;
}

/// Frames of one file in its order, which states their distance.
VolumeGeometry stackFrames(const std::vector<DicomFrame>& slices, const ReadVolumeOptions& options,
                           std::vector<std::string>& assumptions) {
  const DicomFrame& first = slices[0];
  if (!first.plane.distance && !options.spacing)
    throw invalidInput(first.image->file.path().string() +
                       ": does not state the distance between its frames; expected a volume; state "
                       "the spacing with " +
                       options.word("spacing"));
  VolumeGeometry geometry;
  geometry.spacing = pixelSpacing(first, options);
  geometry.spacing[2] = first.plane.distance.value_or(std::numeric_limits<double>::quiet_NaN());
  if (first.plane.orientation) geometry.direction = directionOf(*first.plane.orientation);
  if (first.plane.position) geometry.origin = *first.plane.position;
  if (!first.plane.orientation || !first.plane.position)
    assumptions.emplace_back(
        "its image position or orientation is missing, so its axes are taken as left, posterior "
        "and superior, or its origin as its first pixel");
  return geometry;
}

std::vector<DicomFrame> slicesOf(const std::vector<DicomImage>& images) {
  std::vector<DicomFrame> slices;
  for (const DicomImage& image : images) {
    if (image.frames > 1 && images.size() > 1)
      throw invalidInput(image.file.path().string() + ": holds " + std::to_string(image.frames) +
                         " frames beside other files of its series; expected one frame for each "
                         "file");
    for (std::size_t frame = 0; frame < image.frames; ++frame)
      slices.push_back(
          {&image, frame, image.perFrame.empty() ? image.plane : image.perFrame[frame]});
  }
  return slices;
}

/// Adds an assumption about pixels after the announced ones, which may be uncounted frames.
void reportRest(DicomStack& stack) {
  for (const DicomImage& image : stack.images) {
    const std::size_t used = image.frameBytes() * image.frames;
    if (image.pixels.encapsulated || image.pixels.value.length < used + image.frameBytes())
      continue;
    stack.assumptions.push_back(image.file.path().filename().string() + " holds " +
                                std::to_string(image.pixels.value.length - used) +
                                " bytes of pixels more than it announces, which are left out");
    return;
  }
}

}  // namespace

DicomStack stackOf(DicomChoice choice, const ReadVolumeOptions& options, const fs::path& path) {
  DicomStack stack;
  stack.images = std::move(choice.images);
  stack.assumptions = std::move(choice.assumptions);
  stack.slices = slicesOf(stack.images);
  if (stack.slices.size() < 2)
    throw invalidInput(stack.images[0].file.path().string() +
                       ": is the only slice of its series, so it is not 3-D; expected a series of "
                       "slices in one folder, or a file of several frames");
  const auto& perFrame = stack.images[0].perFrame;
  const bool placed = stack.images.size() > 1 || (!perFrame.empty() && perFrame[1].position);
  if (placed) checkPlaced(stack.slices[0]);
  StatedGeometry stated;
  stated.geometry = placed ? stackPlaced(stack.slices, options, path, stack.assumptions)
                           : stackFrames(stack.slices, options, stack.assumptions);
  stated.geometry.size = {static_cast<int>(stack.images[0].columns),
                          static_cast<int>(stack.images[0].rows),
                          static_cast<int>(stack.slices.size())};
  stated.unit = 1;  // DICOM has no other unit
  reportRest(stack);
  stack.geometry = settledGeometry(stated, options, path, stack.assumptions);
  return stack;
}

}  // namespace lumen::convert
