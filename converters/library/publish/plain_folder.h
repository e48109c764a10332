// SPDX-License-Identifier: Apache-2.0
// Files of a folder that somebody else made: nothing is reached through a link, and nothing but a
// file is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <sys/stat.h>

#include "converters/base/progress.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

/// Reason why a file cannot be had.
enum class PlainFault : std::uint8_t {
  None,
  Missing,
  Kind,        ///< a link, a device, a folder, or a file in the way of a folder
  Unreadable,  ///< also: it changed while it was read
};

struct PlainRead {
  PlainFault fault = PlainFault::None;
  std::string found;        ///< the fault: "a symbolic link", "Permission denied"
  std::uint64_t bytes = 0;  ///< the size of the file
  bool isRead = false;      ///< it has the size that was wanted, and was read
  std::string sha256;       ///< digest of the bytes read
  std::string content;      ///< if it was to be kept
};

/// Limits of the reading of a file.
struct WantedRead {
  std::optional<std::uint64_t> bytes;  ///< a file of another size is not read
  bool isKept = false;
  std::uint64_t most = UINT64_MAX;  ///< bytes: a larger file is not read either
};

/// A name in a folder.
struct PlainEntry {
  std::string name;
  struct stat status {};  ///< the entry's own, not its link's target's
};

/// "a file", "a folder", "a symbolic link", "a named pipe", "a device".
std::string kindText(mode_t mode);

class PlainFolder {
public:
  /// Throws Error(InvalidInput) if there is no such folder or it cannot be read. Here a link is
  /// followed.
  explicit PlainFolder(const std::filesystem::path& folder);

  /// The path as it was named.
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

  /// Reads a file; `path` is relative, with a / between folders. Throws Error(Cancelled) only.
  [[nodiscard]] PlainRead read(const std::string& path, const WantedRead& wanted,
                               const Progress& progress) const;

  /// Calls `see` with each entry of a folder ("" is this one) in the order of the file system.
  [[nodiscard]] PlainRead list(const std::string& path,
                               const std::function<void(const PlainEntry&)>& see) const;

private:
  std::filesystem::path m_path;
  formats::FileDescriptor m_descriptor;
};

}  // namespace lumen::convert
