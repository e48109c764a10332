// SPDX-License-Identifier: Apache-2.0
// Detached files of voxels that a header of NRRD or MetaImage names. The header may come from
// anywhere, so it opens no file against the user's will: only those in its own folder and below,
// and those that --allow-detached names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/input_file.h"

namespace lumen::convert {

/// File names in a header, the n-th for n from 0.
struct DetachedNames {
  std::uint64_t count = 0;
  std::function<std::string(std::uint64_t)> name;
};

/// These names resolved: from the header's folder on, every link followed. A header in memory has no
/// folder. Throws Error(InvalidInput), naming the header and, for a place outside of its folder and of
/// `allowed`, the field "allow-detached", and for a missing or non-regular file. `what`: content of those files,
/// for messages.
std::vector<std::filesystem::path> detachedFiles(const InputFile& header,
                                                 const DetachedNames& names,
                                                 const std::vector<std::filesystem::path>& allowed,
                                                 const FieldWord& word,
                                                 const std::string& what = "its voxels are");

/// The numbers of a file name pattern; each fits 32 bits.
struct NumberRange {
  std::int64_t first = 0, last = 0, step = 1;
  /// Count of the numbers; 0 for a step that leads away from the last.
  [[nodiscard]] std::uint64_t count() const;
};

/// The names of a pattern that holds exactly one %d, %i or %u, optionally with a width
/// ("slice%03d.raw"), for the numbers of `range`. Throws Error(InvalidInput), naming the header,
/// for any other pattern.
DetachedNames namesOfPattern(const std::filesystem::path& header, const std::string& pattern,
                             const NumberRange& range);

/// Names from an explicit list.
DetachedNames namesOfList(std::vector<std::string> names);

}  // namespace lumen::convert
