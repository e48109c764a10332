// SPDX-License-Identifier: Apache-2.0
// A case as an object of Python, with its arrays as views of its memory.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "formats/case/case.h"
#include "packages/python/src/made_by_init.h"

namespace lumen::python {

/// A case whose arrays never move: views of NumPy point into them and keep this object alive.
struct CaseObject {
  formats::Case value;
  bool isWritable = false;  ///< its arrays may be written to
};
using SharedCase = std::shared_ptr<CaseObject>;

inline SharedCase sharedCase(formats::Case value, bool isWritable = false) {
  return std::make_shared<CaseObject>(CaseObject{std::move(value), isWritable});
}

/// The case that a file of these bytes holds. Raises lumen.Error; `file` may be empty.
SharedCase decodedCase(std::span<const std::byte> bytes, const std::string& file = {});
/// Raises lumen.Error with the first rule that the case breaks.
void requireValid(const CaseObject& self);

/// Adds the class Case.
void addCase(pybind11::module_& module);
/// Adds the corrections of a case, `edit_*` and `refit`.
void addEdits(pybind11::module_& module);

}  // namespace lumen::python
