// SPDX-License-Identifier: Apache-2.0
// Shared by the functions of lumen/case.h: the case behind the pointer, and the way from issues and
// exceptions to a status.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "formats/case/case.h"
#include "formats/container/issue.h"
#include "lumen/case.h"

struct lumen_case {
  lumen::formats::Case value;
};

namespace lumen::formats::api {

/// The fault of an issue, whose message begins with `prefix`.
lumen_case_fault faultOf(const Issue& issue, std::string_view prefix = {});

/// Fills *fault, if there is one, with a sentence that is about no rule; returns `status`.
lumen_case_status refuse(lumen_case_fault* fault, lumen_case_status status,
                         std::string_view sentence);
/// ARGUMENT with a sentence.
lumen_case_status refuseArgument(lumen_case_fault* fault, std::string_view sentence);
/// Fills *fault, if there is one, and returns the status that the rule's group has.
lumen_case_status refuse(lumen_case_fault* fault, const Issue& issue, std::string_view prefix = {});

/// The status of `work`, which may throw: no exception leaves the library.
template <class Work>
lumen_case_status guarded(lumen_case_fault* fault, Work work) {
  if (fault) *fault = {};
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return refuse(fault, LUMEN_CASE_ERROR_MEMORY, "the system has no more memory");
  } catch (const std::length_error&) {
    return refuse(fault, LUMEN_CASE_ERROR_MEMORY, "an array is larger than memory");
  } catch (const std::exception& error) {
    return refuse(fault, LUMEN_CASE_ERROR_ARGUMENT, error.what());
  }
}

}  // namespace lumen::formats::api
