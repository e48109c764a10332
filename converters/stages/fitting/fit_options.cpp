// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/fit_options.h"

#include <cmath>

#include "converters/base/error.h"
#include "formats/field/kernel.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

/// Voxels: what Yureidini's thesis, table 4.5, gives in mm for voxels of 0.2 mm.
constexpr double kIsoLevel = 0.5, kAccuracy = 1.5, kMaxDistance = 100, kMinWidth = 0.1;

void requireRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw invalidInput("--" + std::string(name) + ": found " + formats::shortText(value) +
                     ", expected a number from " + formats::shortText(low) + " to " +
                     formats::shortText(high));
}

void requireLength(const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw invalidInput("--" + std::string(name) + ": found " + formats::shortText(value) +
                     ", expected a length above 0 mm");
}

void scaleWithVoxel(const char* name, std::optional<double>& value, double voxels,
                    double voxelSize) {
  if (!value) {
    if (!(voxelSize > 0) || !std::isfinite(voxelSize)) {
      throw invalidInput("--" + std::string(name) +
                         ": it scales with the voxel size, which the case does not state; "
                         "expected a value in mm");
    }
    value = voxels * voxelSize;
  }
  requireLength(name, *value);
}

}  // namespace

FitOptions FitOptions::resolved(double voxelSize) const {
  FitOptions full = *this;
  if (!full.kernelParameter) full.kernelParameter = field::usualParameter(kernel);
  if (field::hasParameter(kernel))
    requireRange("kernel-parameter", *full.kernelParameter, 1e-3, 1e3);
  requireRange("cohesion-weight", cohesionWeight, 0, 1e6);
  requireRange("curvature-weight", curvatureWeight, 0, 1e6);
  requireRange("cohesion-scale", cohesionScale, 1e-3, 1e3);
  requireRange("max-subdivisions", maxSubdivisions, 0, 1000);
  requireRange("neighbourhood", neighbourhood, 0, 100);
  requireRange("seam-sweeps", seamSweeps, 0, 100);
  requireRange("seam-weight", seamWeight, 0, 1e6);
  scaleWithVoxel("iso-level", full.isoLevel, kIsoLevel, voxelSize);
  scaleWithVoxel("accuracy", full.accuracy, kAccuracy, voxelSize);
  scaleWithVoxel("max-distance", full.maxDistance, kMaxDistance, voxelSize);
  scaleWithVoxel("min-width", full.minWidth, kMinWidth, voxelSize);
  return full;
}

std::map<std::string, formats::ParameterValue> FitOptions::parameters() const {
  std::map<std::string, formats::ParameterValue> values{
      {"kernel", std::string(field::kKernelNames[static_cast<std::size_t>(kernel)])},
      {"cohesion-weight", cohesionWeight},
      {"curvature-weight", curvatureWeight},
      {"cohesion-scale", cohesionScale},
      {"max-subdivisions", std::int64_t{maxSubdivisions}},
      {"neighbourhood", std::int64_t{neighbourhood}},
      {"seam-sweeps", std::int64_t{seamSweeps}},
      {"seam-weight", seamWeight}};
  const auto add = [&values](const char* name, const std::optional<double>& value) {
    if (value) values.emplace(name, *value);
  };
  add("kernel-parameter", kernelParameter);
  add("iso-level", isoLevel);
  add("accuracy", accuracy);
  add("max-distance", maxDistance);
  add("min-width", minWidth);
  return values;
}

}  // namespace lumen::convert
