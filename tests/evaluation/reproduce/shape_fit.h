// SPDX-License-Identifier: Apache-2.0
// One fit of all points of a shape.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/stages/fitting/local_model.h"
#include "convolution_shapes.h"

namespace lumen::reproduce {

/// A model of one node, begun with the shape's number of blobs along its skeleton.
formats::BlobbyModels fitShape(const ConvolutionShape& shape, const std::vector<Vector3d>& points,
                               const convert::fitting::LocalModelOptions& options);

/// Points of the shape's wall, moved along its normal by deviates of that standard deviation, mm.
std::vector<Vector3d> withNoise(const ConvolutionShape& shape, std::vector<Vector3d> points,
                                double noise, Random random);

// Cost of noise alone: the error of a least-squares fit of the family of shapes that the points
// are of. A fit without bias that does not know the shape has a larger one.

/// A direction in which a shape may change: velocities of its blobs and rates of their widths.
struct ShapeChange {
  std::vector<Vector3d> velocity;
  std::vector<double> widthRate;
};

/// The changes that keep a shape what it is: every arc or segment moves, turns, and changes its
/// radius of curvature, its length and its width.
std::vector<ShapeChange> makeFamily(const ConvolutionShape& shape);

/// The error of the fit of a family, to first order in the noise.
class FamilyFit {
public:
  FamilyFit(const ConvolutionShape& shape, const std::vector<Vector3d>& points, Random random);

  [[nodiscard]] std::size_t unknowns() const { return m_rank; }
  /// Distances of even samples of the fitted surface from the true one, mm, ascending, given the
  /// displacement of every point along its normal.
  [[nodiscard]] std::vector<double> distances(const Eigen::VectorXd& noise) const;

private:
  std::size_t m_rank = 0;
  Eigen::MatrixXd m_solve;   ///< from displacements to changes
  Eigen::MatrixXd m_shifts;  ///< from changes to displacements of the samples
};

}  // namespace lumen::reproduce
