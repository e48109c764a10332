// SPDX-License-Identifier: Apache-2.0
// Faults of lumen as exceptions of Python: lumen.Error, which lumen/_errors.py defines; and work
// without Python's lock.
#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "converters/base/error.h"
#include "formats/container/issue.h"

namespace lumen::python {

/// The result of `work`, during which other threads of Python run. It touches no object of Python.
template <class Work>
auto released(const Work& work) {
  const pybind11::gil_scoped_release released;
  return work();
}

/// Raises lumen.Error with the message, the kind and the exit code of `error`. `file` may be empty.
/// The caller holds Python's lock.
[[noreturn]] void raise(const Error& error, const std::string& file = {});

/// Raises lumen.Error with the place of the fault, its rule, and the values found and expected.
/// `file` may be empty. The caller holds Python's lock.
[[noreturn]] void raise(const formats::Issue& issue, const std::string& file);

/// An issue as a dictionary with the keys of the answer of `lumen validate`.
pybind11::dict issueFacts(const formats::Issue& issue);

}  // namespace lumen::python
