// SPDX-License-Identifier: Apache-2.0
// Whole files, read and written. Files that appear under their name in one step:
// formats/case/atomic_file.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "formats/case/file_descriptor.h"

namespace lumen {

inline constexpr std::uint64_t kAnySize = UINT64_MAX;
inline constexpr std::uint64_t kMostText = std::uint64_t{64} << 20;  // bytes of a text format

/// The bytes of a regular file, which may be empty. `role` names it in messages, such as "seeds
/// file". Throws Error(InvalidInput), naming the file, if it is missing, no regular file, larger
/// than `most` bytes, or cannot be read.
std::string readWholeFile(const std::filesystem::path& file, std::string_view role,
                          std::uint64_t most = kAnySize);

/// Throws Error(InvalidInput) if a `role` of `size` bytes, called `file`, has more than `most`.
void requireAtMost(std::uint64_t most, std::uint64_t size, const std::filesystem::path& file,
                   std::string_view role);

/// A new file that is not in its place yet, or whose folder is not, written piece by piece. Throws
/// Error(Failed), naming the file.
class NewFile {
public:
  /// `target`: the name that a message states, where `file` has another until it is in its place.
  explicit NewFile(const std::filesystem::path& file, const std::filesystem::path& target = {});
  void add(std::string_view bytes);
  /// Called once, after the last piece.
  void close();

private:
  void requireGood() const;
  std::filesystem::path m_target;
  std::ofstream m_out;
};

/// Writes a whole file, as NewFile does.
void writeNewFile(std::string_view bytes, const std::filesystem::path& file,
                  const std::filesystem::path& target = {});

/// Lets everybody who may read a file run it. Throws Error(Failed), naming the file.
void allowRunning(const std::filesystem::path& file);

/// Flushes to the disk all data written to the file system of a folder. Throws Error(Failed),
/// naming the folder.
void flushFolder(const std::filesystem::path& folder);

}  // namespace lumen
