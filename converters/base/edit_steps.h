// SPDX-License-Identifier: Apache-2.0
// How a case records what a person has changed in it, and what it records of the stages before.
#pragma once

#include <string>

#include "formats/case/case.h"

namespace lumen {

constexpr const char* kEditStep = "edit";

/// Adds a sentence to what was done to a case by hand: edits that follow one another are parameters of
/// one "edit" step, numbered from 0001. Throws Error(Unsupported) if the case has no room for another
/// step.
void recordEdit(formats::Metadata& metadata, const std::string& sentence);

/// The last step of that name, or null.
const formats::Step* lastStep(const formats::Metadata& metadata, const std::string& name);

}  // namespace lumen
