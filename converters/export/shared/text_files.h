// SPDX-License-Identifier: Apache-2.0
// Texts of exported folders: files below targets/NAME/texts, which are part of the program.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "converters/base/embedded_text.h"
#include "converters/export/shared/target.h"

namespace lumen::convert {

/// filled() of the file targets/NAME/texts/FILE; `name` is "NAME/FILE". Throws std::logic_error if
/// there is none.
std::string exportText(std::string_view name, std::initializer_list<TextValue> values = {});

// Texts of cases in Markdown (CommonMark 0.30, and GitHub's tables, strikethrough and addresses).

/// `text` as one line that shows as itself, also in the cell of a table and at the beginning of a
/// paragraph: no character of it is markup, and characters that do not show are written out
/// (formats::printable()).
std::string markdownText(std::string_view text);

// The two files that every exported folder has: README.md for people and lumen-export.json for
// programs.

/// `version` of lumen-export.json, spec/export.md.
inline constexpr int kManifestVersion = 1;

/// README.md: title, how to start, files, units and frame, named ends, systems of the vessels of
/// `source`.
std::string readmeText(const TargetRow& target, const ExportFrame& frame,
                       const formats::Case& source, const ExportResult& result);

/// lumen-export.json, spec/export.md, with all files of `result` and the systems of the vessels of
/// `source`. Equal folders give equal bytes.
std::string makeManifest(const TargetRow& target, const ExportFrame& frame,
                         const formats::Case& source, const OptionTexts& options,
                         const ExportResult& result);

}  // namespace lumen::convert
