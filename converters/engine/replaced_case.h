// SPDX-License-Identifier: Apache-2.0
// The version of a case that a new one replaces: its parts stay without being named again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/engine/prepare_case.h"
#include "converters/library/record.h"

namespace lumen::engine {

/// The id that a case gets without another wish: case- and the first 12 digits of its digest.
/// Throws as readCase().
std::string idOfCase(const std::filesystem::path& caseFile);

/// The record of the version that is in the library; nothing if it has no case of this id. Throws
/// as convert::openRecord().
std::optional<convert::CaseRecord> replacedVersion(const std::filesystem::path& library,
                                                   const std::string& id);

/// Adds to `wishes` the parts of the version before: its exports, pages, pictures and files.
/// `keepsViews`, `keepsTurntable`: no other number of them is asked for.
void keepWishes(const convert::CaseRecord& before, const std::filesystem::path& library,
                bool keepsViews, bool keepsTurntable, CaseWishes& wishes);

}  // namespace lumen::engine
