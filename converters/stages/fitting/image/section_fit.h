// SPDX-License-Identifier: Apache-2.0
// The fit of one cross-section to the voxels around it (docs/method.md, section 2.11).
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/fitting/image/blurred_section.h"
#include "formats/case/case.h"

namespace lumen::convert::fitting {

/// A voxel near a section.
struct SectionVoxel {
  Eigen::Vector2d place;  ///< in the plane, mm
  double height = 0;      ///< mm along the axis
  double value = 0;       ///< intensity, brighter in vessels
  double beside = 0;      ///< of it, the intensity that other vessels add
  double weight = 1;      ///< in (0, 1]
};

/// A quantity with its standard deviation.
struct Estimate {
  double value = 0, deviation = 0;
};

/// Prior standard deviations of shapes: of slopes of the axis and the radius, as shares; of their
/// curvatures, in inverse radii; and of the outline's curvature by each harmonic, in inverse radii
/// (docs/method.md, section 2.4, has the half).
struct ShapeSpread {
  double tilt = 0.3, bend = 0.1, taper = 0.3, flare = 0.15;
  std::array<double, kMostHarmonics - 1> wave{0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
};

/// Knowledge of a section before its voxels are seen.
struct SectionPrior {
  Outline outline;       ///< the shape that the fit begins with
  Eigen::Vector2d bend;  ///< the expected curvature of the axis, 1/mm
  ShapeSpread spread;
  Estimate contrast;           ///< of lumen and background
  Eigen::Matrix2d covariance;  ///< of the point-spread function in the plane, mm^2
  bool isFirst = true;         ///< the shape is a guess yet: outliers are judged mildly at first
  bool fitsBlur = false;       ///< the width of the point-spread function is unknown, too
};

struct SectionFit {
  Outline outline;
  double background = 0;
  Estimate contrast;
  Estimate radius;  ///< mm; of the outline's mean distance from its centre
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< standard deviations of the centre, mm
  Eigen::VectorXd variance;                          ///< of the outline's parameters
  double noise = 0;                                  ///< robust standard deviation of the residuals
  double blur = 1;       ///< the width of the point-spread function, as a share of the given one
  bool isValid = false;  ///< false: too few voxels, or no minimum was found
};

/// The shape, background (with its slope across the plane) and contrast that minimise the squares of
/// the differences between the voxels and the section's image, weighted by Tukey's function, and of
/// the differences from the prior, in standard deviations. Deterministic.
SectionFit fitSection(const std::vector<SectionVoxel>& voxels, const SectionPrior& prior);

// The contrast of vessels along a tree (docs/method.md, section 2.11). In the image of a vessel that is
// narrower than the blur, contrast and radius are confounded: the wider vessels around it know the
// contrast.

/// For each node the contrast that its neighbours along the tree let expect, without its own
/// measurement. The contrast is a random walk along the edges: exact Gaussian inference by messages
/// from the tips to the roots and back. `measured`: one for each node; a deviation of 0 or less is no
/// measurement. `voxel`: mm. Empty if there is no measurement.
std::vector<Estimate> contrastAlong(const formats::CenterlineTree& tree,
                                    const std::vector<Estimate>& measured, double voxel);

}  // namespace lumen::convert::fitting
