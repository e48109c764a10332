// SPDX-License-Identifier: Apache-2.0
// The nodes and models of a case used in place, as formats/field takes them. The views own nothing;
// the file's bytes must outlive them.
#pragma once

#include "formats/field/tree_view.h"
#include "formats/view/case_view.h"

namespace lumen::formats {

inline field::TreeView treeViewOf(const CaseView& view) {
  return {view.nodeCount(),       reinterpret_cast<const float(*)[3]>(view.nodeCentre.data()),
          view.nodeRadius.data(), view.nodeParent.data(),
          view.links.size(),      reinterpret_cast<const std::uint32_t(*)[2]>(view.links.data())};
}

/// View of models whose values have been verified.
inline field::ModelsView modelsViewOf(const ModelView& models) {
  return {static_cast<field::Kernel>(models.kernel),
          models.kernelParameter,
          models.isoLevel,
          models.offset.data(),
          reinterpret_cast<const float(*)[3]>(models.centre.data()),
          models.width.data()};
}

}  // namespace lumen::formats
