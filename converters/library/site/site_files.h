// SPDX-License-Identifier: Apache-2.0
// The style sheet and the scripts of the site, which are built into the program: the files of those names beside this.
#pragma once

#include <string_view>
#include <vector>

namespace lumen::convert {

struct SiteFile {
  const char* name;
  std::string_view bytes;
};

const std::vector<SiteFile>& siteFiles();

}  // namespace lumen::convert
