// SPDX-License-Identifier: Apache-2.0
// The "edit" steps of a case (edit_steps.h) as a list: sentences, and requests by which changes can be made again.
#pragma once

#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen {

/// A change by hand that a case records.
struct RecordedEdit {
  std::string sentence;
  std::string request;  ///< JSON, by which it can be made again; empty: none is kept
};

/// Whether a parameter of an "edit" step holds a request.
bool isRequestName(const std::string& parameter);

/// Adds a request to the last sentence of recordEdit().
void recordRequest(formats::Metadata& metadata, const std::string& request);

/// The manual changes of a case, in their order.
std::vector<RecordedEdit> recordedEdits(const formats::Metadata& metadata);

}  // namespace lumen
