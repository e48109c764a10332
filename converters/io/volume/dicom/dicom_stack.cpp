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
#include "converters/io/volume/dicom/slice_spacing.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Lean of a stack from its first to its last slice, at most this share of a pixel.
constexpr double kShearTolerance = 0.5;
// Tolerance of slices of one grid in pixel spacing, mm, and in the axes' directions.
constexpr double kSameGrid = 1e-4;
// Frames of a segmentation: mm within which they share a slice, slices by which one lies off its slice,
// and slices of a volume, which are those of 2 m at 0.2 mm.
constexpr double kSamePlane = 1e-3, kOffSlot = 0.1, kMostSlots = 1e4;

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
                       ": has no image position (0020,0032) and orientation (0020,0037); expected "
                       "a slice of a volume");
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

/// The step from a slice to the next of a stack whose slices are shifted along themselves, as under a
/// gantry tilt: the direction of the third axis and its spacing. Shifts of less than half a pixel from
/// the first to the last slice are none.
void leanAsSlices(const std::vector<DicomFrame>& slices, const Vector3d& pixels, double steps,
                  const fs::path& path, VolumeGeometry& geometry) {
  const Vector3d lean = *slices.back().plane.position - *slices.front().plane.position;
  const Vector3d shift = geometry.direction.transpose() * lean;
  const auto isShifted = [&](const Vector3d& by) {
    return std::abs(by[0]) > kShearTolerance * pixels[0] ||
           std::abs(by[1]) > kShearTolerance * pixels[1];
  };
  const double height = slices.back().position - slices.front().position;
  for (const DicomFrame& slice : slices) {
    const double part = (slice.position - slices.front().position) / height;
    const Vector3d off = *slice.plane.position - *slices.front().plane.position - part * lean;
    if (isShifted(geometry.direction.transpose() * off))
      throw invalidInput(path.string() + ": its slice " + slice.name() +
                         " is shifted along itself against the others (0020,0032); expected a "
                         "stack along one line, upright or leaning as under a gantry tilt");
  }
  if (!isShifted(shift)) return;
  geometry.direction.col(2) = lean.normalized();
  geometry.spacing[2] = lean.norm() / steps;
}

/// Sorts slices with positions; returns their geometry.
VolumeGeometry stackPlaced(DicomStack& stack, const ReadVolumeOptions& options,
                           const fs::path& path) {
  std::vector<DicomFrame>& slices = stack.slices;
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
  SliceSpacing spacing = sliceSpacing(slices, options, path, stack.assumptions);
  geometry.spacing[2] = spacing.step;
  const std::size_t count = spacing.places.empty() ? slices.size() : spacing.places.size();
  leanAsSlices(slices, options.spacing.value_or(geometry.spacing), static_cast<double>(count - 1),
               path, geometry);
  geometry.origin = *slices[0].plane.position;
  stack.places = std::move(spacing.places);
  stack.filled = std::move(spacing.filled);
  return geometry;
}

/// The distance of slices, mm, of which the distances of frames, sorted by position, are multiples: the
/// stated one, or else the least of theirs; of one frame `otherwise`, if it states none.
double segmentStep(const std::vector<DicomFrame>& frames, double otherwise, const fs::path& path) {
  const double first = frames.front().position;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < frames.size(); ++n)
    if (const double gap = frames[n].position - frames[n - 1].position; gap > kSamePlane)
      step = std::min(step, gap);
  const double stated = std::abs(frames[0].plane.distance.value_or(0));
  const auto isGrid = [&](double by) {
    return std::all_of(frames.begin(), frames.end(), [&](const DicomFrame& frame) {
      const double slot = (frame.position - first) / by;
      return std::abs(slot - std::round(slot)) <= kOffSlot && slot < kMostSlots;
    });
  };
  if (stated > 0 && isGrid(stated)) return stated;
  if (!std::isfinite(step)) step = stated > 0 ? stated : otherwise;
  if (step > 0 && isGrid(step)) return step;
  throw invalidInput(path.string() + ": the frames of this segmentation are not multiples of " +
                     shownNumber(step) +
                     " mm apart (0020,0032); expected those of a regular stack");
}

/// Frames of a segmentation, several in a slice or none, sorted by slices.
VolumeGeometry stackSegments(DicomStack& stack, const ReadVolumeOptions& options,
                             const fs::path& path) {
  std::vector<DicomFrame>& frames = stack.slices;
  VolumeGeometry geometry;
  checkPlaced(frames[0]);
  geometry.direction = directionOf(*frames[0].plane.orientation);
  for (DicomFrame& frame : frames) {
    checkPlaced(frame);
    checkSameGrid(frame, frames[0], path);
    frame.position = geometry.direction.col(2).dot(*frame.plane.position);
  }
  std::stable_sort(frames.begin(), frames.end(), [](const DicomFrame& a, const DicomFrame& b) {
    return a.position < b.position;
  });
  geometry.spacing = pixelSpacing(frames[0], options);
  const double first = frames.front().position;
  const double step = segmentStep(frames, geometry.spacing[0], path);
  for (DicomFrame& frame : frames)
    frame.slot = static_cast<std::size_t>(std::lround((frame.position - first) / step));
  geometry.spacing[2] = step;
  // a volume has two slices at least; the second one is empty
  geometry.size[2] = static_cast<int>(std::max<std::size_t>(2, frames.back().slot + 1));
  if (frames.back().slot > 0)
    leanAsSlices(frames, options.spacing.value_or(geometry.spacing),
                 static_cast<double>(frames.back().slot), path, geometry);
  geometry.origin = *frames[0].plane.position;
  stack.isLabelled = true;
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
    if (image.frames > 1 && images.size() > 1 && image.perFrame.empty())
      throw invalidInput(image.file.path().string() + ": holds " + std::to_string(image.frames) +
                         " frames without a position each beside other files of its series; "
                         "expected one frame for each file");
    for (const std::size_t frame : image.usedFrames())
      slices.push_back({&image, frame, image.planeOf(frame)});
  }
  return slices;
}

/// Adds an assumption about pixels after the announced ones, which may be uncounted frames.
void reportRest(DicomStack& stack) {
  for (const DicomImage& image : stack.images) {
    const std::size_t used = image.pixelBytes();
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
  const bool isLabelled = stack.images[0].labels != DicomLabels::None;
  if (stack.slices.size() < 2 && !isLabelled)
    throw invalidInput(stack.images[0].file.path().string() +
                       ": is the only slice of its series, so it is not 3-D; expected a series of "
                       "slices in one folder, or a file of several frames");
  const bool isByFrame = !stack.images[0].perFrame.empty();
  const bool placed = !isLabelled && (stack.images.size() > 1 ||
                                      (isByFrame && stack.slices[1].plane.position.has_value()));
  if (placed) checkPlaced(stack.slices[0]);
  StatedGeometry stated;
  stated.geometry = isLabelled ? stackSegments(stack, options, path)
                    : placed   ? stackPlaced(stack, options, path)
                               : stackFrames(stack.slices, options, stack.assumptions);
  stated.geometry.size[0] = static_cast<int>(stack.images[0].columns);
  stated.geometry.size[1] = static_cast<int>(stack.images[0].rows);
  if (!isLabelled) stated.geometry.size[2] = static_cast<int>(stack.count());
  stated.unit = 1;  // DICOM has no other unit
  reportRest(stack);
  stack.geometry = settledGeometry(stated, options, path, stack.assumptions);
  return stack;
}

}  // namespace lumen::convert
