// SPDX-License-Identifier: Apache-2.0
// The two files that every exported folder has: README.md for people and lumen-export.json for
// programs.
#pragma once

#include <string>

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// `version` of lumen-export.json, spec/export.md.
inline constexpr int kManifestVersion = 1;

/// README.md: title, how to start, files, units and frame, named ends.
std::string readmeText(const TargetRow& target, const ExportFrame& frame,
                       const ExportResult& result);

/// lumen-export.json, spec/export.md, with all files of `result`. Equal folders give equal bytes.
std::string makeManifest(const TargetRow& target, const ExportFrame& frame,
                         const formats::Case& source, const OptionTexts& options,
                         const ExportResult& result);

}  // namespace lumen::convert
