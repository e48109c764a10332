// SPDX-License-Identifier: Apache-2.0
// A case's record of manual changes, and of the stages before them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen {

constexpr const char* kEditStep = "edit";
constexpr const char* kPoseStep = "pose";

/// Adds a step. Throws Error(Unsupported) if the case has no room for another one.
void addStep(formats::Metadata& metadata, formats::Step step);

/// Adds a sentence to the last step of a case if that has the given name, or else to a new one:
/// sentences are parameters, numbered from 0001. Throws Error(Unsupported) if the case has no room
/// for another step.
void recordNumbered(formats::Metadata& metadata, const std::string& step,
                    const std::string& sentence);

/// Adds a sentence to the record of manual changes of a case, "edit" steps. Throws as
/// recordNumbered().
void recordEdit(formats::Metadata& metadata, const std::string& sentence);

/// Records what the reader of the source took for granted where its file is incomplete, such as where
/// left and right are: sentences, as parameters "assumption-1" and so on.
void recordAssumptions(formats::Step& step, const std::vector<std::string>& assumptions);

/// The sentences that recordAssumptions() left in the steps of a case, each once.
std::vector<std::string> recordedAssumptions(const formats::Metadata& metadata);

/// The time, s, at which a case was taken from its motion, by its last step "pose"; or nothing.
std::optional<double> recordedTime(const formats::Metadata& metadata);

/// A parameter of a step as text: a number with at most six significant digits, "true" or "false".
std::string parameterText(const formats::ParameterValue& value);

/// The last step of the given name, or null.
const formats::Step* lastStep(const formats::Metadata& metadata, const std::string& name);

// The "edit" steps of a case (edit_steps.h) as a list: sentences, and requests by which changes can be made again.

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
