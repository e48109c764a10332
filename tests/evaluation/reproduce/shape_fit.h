// SPDX-License-Identifier: Apache-2.0
// One fit of all points of a shape.
#pragma once

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

}  // namespace lumen::reproduce
