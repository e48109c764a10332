// SPDX-License-Identifier: Apache-2.0
// The files that a header of NRRD or MetaImage says its voxels are in. The header may come from
// anywhere, so it gets no file that the user did not mean: only those in its own folder and below,
// and what --allow-detached names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lumen::convert {

/// Names that a header gives, the n-th for n from 0.
struct DetachedNames {
  std::uint64_t count = 0;
  std::function<std::string(std::uint64_t)> name;
};

/// These names resolved: from the header's folder on, every link followed. Throws
/// Error(InvalidInput), naming the header and the option, for a place outside of the header's folder
/// and of `allowed`; and for what is no regular file that can be found. `what` those files hold, for
/// messages.
std::vector<std::filesystem::path> detachedFiles(const std::filesystem::path& header,
                                                 const DetachedNames& names,
                                                 const std::vector<std::filesystem::path>& allowed,
                                                 const std::string& what = "its voxels are");

/// The numbers that a pattern of names runs through; each fits 32 bits.
struct NumberRange {
  std::int64_t first = 0, last = 0, step = 1;
  /// How many those are; 0 for a step that leads away from the last.
  [[nodiscard]] std::uint64_t count() const;
};

/// The names of a pattern that holds exactly one %d, %i or %u, with a width perhaps
/// ("slice%03d.raw"), for the numbers of `range`. Throws Error(InvalidInput), naming the header, for
/// any other pattern.
DetachedNames namesOfPattern(const std::filesystem::path& header, const std::string& pattern,
                             const NumberRange& range);

/// One name after the other.
DetachedNames namesOfList(std::vector<std::string> names);

}  // namespace lumen::convert
