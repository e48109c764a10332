// SPDX-License-Identifier: Apache-2.0
// The rules of the model, part by part: each gives the first one that is broken.
#pragma once

#include <optional>

#include "formats/case/case_file.h"

namespace lumen::formats {

using Problem = std::optional<FormatError>;

Problem checkMetadata(const Metadata& metadata);
Problem checkTree(const CenterlineTree& tree);
Problem checkPoints(const PointSets& points, std::size_t nodeCount);
Problem checkModels(const BlobbyModels& models, std::size_t nodeCount);

}  // namespace lumen::formats
