// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/fit_options.h"

#include <cmath>

#include "converters/base/error.h"
#include "formats/field/kernel.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

/// Voxels: the lengths of Yureidini's thesis, table 4.5, which are in mm for voxels of 0.2 mm.
constexpr double kIsoLevel = 0.5, kAccuracy = 1.5, kMaxDistance = 100, kMinWidth = 0.1;

constexpr NumberRange kWeight{0, 1e6};
constexpr NumberRange kScale{1e-3, 1e3};

const std::map<std::string, formats::Kernel>& kernelsByName() {
  static const std::map<std::string, formats::Kernel> kernels = [] {
    std::map<std::string, formats::Kernel> named;
    for (std::size_t i = 0; i < field::kKernelNames.size(); ++i)
      named.emplace(field::kKernelNames[i], static_cast<formats::Kernel>(i));
    return named;
  }();
  return kernels;
}

void requireLength(const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw invalidInput(std::string(name) + ": found " + formats::shortText(value) +
                     ", expected a length above 0 mm");
}

void scaleWithVoxel(const char* name, std::optional<double>& value, double voxels,
                    double voxelSize) {
  if (!value) {
    if (!(voxelSize > 0) || !std::isfinite(voxelSize)) {
      throw invalidInput(std::string(name) +
                         ": it scales with the voxel size, which the case does not state; "
                         "expected a value in mm");
    }
    value = voxels * voxelSize;
  }
  requireLength(name, *value);
}

}  // namespace

void FitOptions::addRows(OptionTable& table) {
  table.group("Fitting");
  OptionRow& kernelRow =
      table.choice("kernel", kernel, kernelsByName(), "Radial kernel").recorded();
  kernelRow.type = "NAME";
  table
      .add("kernel-parameter", &kernelParameter, "X",
           "Cauchy's s^2 [0.2] or the Gaussian's a^2 [0.5]")
      .in(kScale)
      .recorded()
      .unusedIf([this, &kernelRow] {
        const std::string name(field::kKernelNames.at(static_cast<std::size_t>(kernel)));
        return field::hasParameter(kernel) ? ""
                                           : "does nothing with " + kernelRow.shownName() + " " +
                                                 name + ", which has no parameter";
      });
  OptionRow& cohesionRow =
      table.add("cohesion-weight", &cohesionWeight, "W", "Weight alpha of the Lennard-Jones energy")
          .in(kWeight)
          .recorded();
  table.add("curvature-weight", &curvatureWeight, "W", "Weight beta of the curvature energy")
      .in(kWeight)
      .recorded();
  table.add("cohesion-scale", &cohesionScale, "S", "Scale s of the Lennard-Jones energy")
      .in(kScale)
      .recorded()
      .unusedIf([this, &cohesionRow] {
        return cohesionWeight > 0 ? "" : "does nothing with " + cohesionRow.shownName() + " 0";
      });
  table.add("max-subdivisions", &maxSubdivisions, "N", "Most blob subdivisions in one node")
      .in(WholeRange{0, 1000})
      .recorded();
  table
      .add("neighbourhood", &neighbourhood, "N",
           "Topological distance of the nodes whose points a node is fitted to")
      .in(WholeRange{0, 100})
      .recorded();
  OptionRow& sweepsRow =
      table.add("seam-sweeps", &seamSweeps, "N", "Sweeps that tie adjacent models to one another")
          .in(WholeRange{0, 100})
          .recorded();
  table.add("seam-weight", &seamWeight, "W", "Weight of a tie, in wall points")
      .in(kWeight)
      .recorded()
      .unusedIf([this, &sweepsRow] {
        return seamSweeps > 0 ? "" : "does nothing with " + sweepsRow.shownName() + " 0";
      });
  table.scaled("iso-level", isoLevel, "Iso-level T", "half a voxel").recorded();
  table.scaled("accuracy", accuracy, "Subdivide until no point is farther than this", "1.5 voxels")
      .recorded();
  table
      .scaled("max-distance", maxDistance, "Drop blobs farther than this from their node",
              "100 voxels")
      .recorded();
  table.scaled("min-width", minWidth, "Drop blobs narrower than this", "0.1 voxel").recorded();
}

FitOptions FitOptions::resolved(double voxelSize) const {
  FitOptions full = *this;
  if (!full.kernelParameter) full.kernelParameter = field::usualParameter(kernel);
  OptionTable table;
  full.addRows(table);
  if (!field::hasParameter(kernel)) table.find("kernel-parameter")->range.reset();
  // lengths are checked below, and may be longer than a person is tall
  for (const char* const name : {"iso-level", "accuracy", "max-distance", "min-width"})
    table.find(name)->range.reset();
  table.requireValues("");
  scaleWithVoxel("iso-level", full.isoLevel, kIsoLevel, voxelSize);
  scaleWithVoxel("accuracy", full.accuracy, kAccuracy, voxelSize);
  scaleWithVoxel("max-distance", full.maxDistance, kMaxDistance, voxelSize);
  scaleWithVoxel("min-width", full.minWidth, kMinWidth, voxelSize);
  return full;
}

std::map<std::string, formats::ParameterValue> FitOptions::parameters() const {
  FitOptions copy = *this;
  OptionTable table;
  copy.addRows(table);
  return table.recordedValues();
}

}  // namespace lumen::convert
