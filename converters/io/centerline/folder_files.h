// SPDX-License-Identifier: Apache-2.0
// Files of a folder, for formats of several files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/base/text.h"

namespace lumen::convert {

/// The regular files of `folder` whose names end as one of `endings` do, in the order of their names;
/// (10) comes before (2). Sets `error` where the folder cannot be read.
inline std::vector<InputFile> filesEndingIn(const std::filesystem::path& folder,
                                            std::initializer_list<std::string_view> endings,
                                            std::error_code& error) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = lowerCase(entry->path().filename().string());
    std::error_code ignored;
    if (std::any_of(endings.begin(), endings.end(),
                    [&](std::string_view ending) { return name.ends_with(ending); }) &&
        fs::is_regular_file(entry->path(), ignored))
      files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return {files.begin(), files.end()};
}

}  // namespace lumen::convert
