// SPDX-License-Identifier: Apache-2.0
// The versions of the program, of libblob and of the file formats (docs/compatibility.md).
#pragma once

#include <string>

namespace lumen::cli {

/// "lumen 0.2.0" and an end of line.
std::string versionLine();

/// Answer of `lumen --version --json`, spec/answers/version.schema.json. Equal builds give equal
/// bytes.
std::string versionJson();

}  // namespace lumen::cli
