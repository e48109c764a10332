// SPDX-License-Identifier: Apache-2.0
// A case's nodes and models as formats/field takes them. The views own nothing; the case must
// outlive them.
#pragma once

#include "formats/case/case.h"
#include "formats/field/blended_field.h"
#include "formats/field/tree_view.h"

namespace lumen::formats {

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && alignof(Vec3f) == alignof(float));

inline field::TreeView treeViewOf(const CenterlineTree& tree) {
  return {tree.nodeCount(),   reinterpret_cast<const float(*)[3]>(tree.centre.data()),
          tree.radius.data(), tree.parent.data(),
          tree.links.size(),  reinterpret_cast<const std::uint32_t(*)[2]>(tree.links.data())};
}

inline field::ModelsView modelsViewOf(const BlobbyModels& models) {
  return {models.kernel,
          models.kernelParameter,
          models.isoLevel,
          models.offset.data(),
          reinterpret_cast<const float(*)[3]>(models.centre.data()),
          models.width.data()};
}

/// The field of a valid case that has models.
inline field::BlendedField caseField(const Case& value) {
  return {treeViewOf(value.tree), modelsViewOf(*value.models)};
}

}  // namespace lumen::formats
