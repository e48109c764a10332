// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "converters/fitting/fit.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

void requireRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw invalidInput("fit option " + std::string(name) + ": found " + std::to_string(value) +
                     ", expected a number from " + std::to_string(low) + " to " +
                     std::to_string(high));
}

void requireLength(const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw invalidInput("fit option " + std::string(name) + ": found " + std::to_string(value) +
                     ", expected a length above 0 mm");
}

void scaleWithVoxel(const char* name, std::optional<double>& value, double voxels,
                    double voxelSize) {
  if (!value) {
    if (!(voxelSize > 0) || !std::isfinite(voxelSize)) {
      throw invalidInput("fit option " + std::string(name) +
                         ": it scales with the voxel size, which the case does not state; "
                         "expected a value in mm");
    }
    value = voxels * voxelSize;
  }
  requireLength(name, *value);
}

const char* kernelName(formats::Kernel kernel) {
  switch (kernel) {
    case formats::Kernel::Cauchy:
      return "cauchy";
    case formats::Kernel::Gaussian:
      return "gaussian";
    case formats::Kernel::Quartic:
      return "quartic";
    case formats::Kernel::SoftObject:
      return "soft-object";
  }
  return "unknown";
}

}  // namespace

FitOptions FitOptions::resolved(double voxelSize) const {
  FitOptions full = *this;
  if (!full.kernelParameter) full.kernelParameter = formats::defaultKernelParameter(kernel);
  const bool hasParameter =
      kernel == formats::Kernel::Cauchy || kernel == formats::Kernel::Gaussian;
  if (hasParameter) requireRange("kernel-parameter", *full.kernelParameter, 1e-3, 1e3);
  requireRange("cohesion-weight", cohesionWeight, 0, 1e6);
  requireRange("curvature-weight", curvatureWeight, 0, 1e6);
  requireRange("cohesion-scale", cohesionScale, 1e-3, 1e3);
  requireRange("max-subdivisions", maxSubdivisions, 0, 1000);
  requireRange("neighbourhood", neighbourhood, 0, 100);
  requireRange("seam-sweeps", seamSweeps, 0, 100);
  requireRange("seam-weight", seamWeight, 0, 1e6);
  scaleWithVoxel("iso-level", full.isoLevel, 0.5, voxelSize);
  scaleWithVoxel("accuracy", full.accuracy, 1.5, voxelSize);
  scaleWithVoxel("max-distance", full.maxDistance, 100, voxelSize);
  scaleWithVoxel("min-width", full.minWidth, 0.1, voxelSize);
  return full;
}

std::map<std::string, formats::ParameterValue> FitOptions::parameters() const {
  std::map<std::string, formats::ParameterValue> values{
      {"kernel", std::string(kernelName(kernel))},
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
