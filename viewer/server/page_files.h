// SPDX-License-Identifier: Apache-2.0
// The files of the page, which are built apart from the program and lie beside it.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace lumen::viewer {

struct PageFile {
  std::string type;  ///< media type
  std::string bytes;
};

/// Files by the name that the page asks for; "" is the page itself.
using PageFiles = std::map<std::string, PageFile>;

/// Reads them from share/lumen/viewer of the installation that the running program is in, or from
/// its build folder. Empty if they are in neither.
PageFiles findPageFiles();

/// A page with instructions, for a build without the page.
extern const char* const kNoPage;

}  // namespace lumen::viewer
