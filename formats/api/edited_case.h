// SPDX-License-Identifier: Apache-2.0
// The one way in which the functions of lumen/case_edit.h change a case.
#pragma once

#include <cstdint>
#include <utility>

#include "formats/api/handle.h"
#include "formats/case/validate.h"

namespace lumen::formats::api {

/// Subject of an edit: chunks of others that depend on nodes, points and models go with a change of
/// the shape.
enum class Edits : std::uint8_t { Shape, Values };

/// Lets `change` work on a copy of the case, and puts the copy in its place if `change` returns
/// LUMEN_CASE_OK and the copy breaks no rule. A case without nodes is checked once it has some.
/// `change` returns a status, and describes a refusal itself.
template <class Change>
lumen_case_status edit(lumen_case* value, lumen_case_fault* fault, Change change,
                       Edits edits = Edits::Shape) {
  return guarded(fault, [&] {
    if (!value) return refuseArgument(fault, "the case is a null pointer");
    Case edited = value->value;
    if (const lumen_case_status status = change(edited); status != LUMEN_CASE_OK) return status;
    if (edits == Edits::Shape) dropDependentChunks(edited);
    if (edited.tree.nodeCount() > 0)
      if (const Status valid = validate(edited); !valid) return refuse(fault, valid.error());
    std::swap(value->value, edited);
    return LUMEN_CASE_OK;
  });
}

}  // namespace lumen::formats::api
