// SPDX-License-Identifier: Apache-2.0
// The revision of each library that was seen signed before, so that an older one is not taken for
// news.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "formats/case/file_descriptor.h"

namespace lumen::convert {

/// $XDG_STATE_HOME/lumen/libraries.json, by default below ~/.local/state. Throws Error(Failed)
/// where neither is known.
std::filesystem::path defaultStateFile();

struct VerifiedRevision {
  std::uint64_t revision = 0;
  std::string sha256;  ///< digest of library.json
};

/// The state file, which nobody else changes while this lives: two verifications at once take
/// turns.
class VerifiedRevisions {
public:
  /// Makes the file's folder where there is none. Throws Error(InvalidInput) for a file that is
  /// damaged, which stays as it is, and Error(Failed).
  explicit VerifiedRevisions(const std::filesystem::path& file);

  /// The highest revision that was seen of a library.
  [[nodiscard]] std::optional<VerifiedRevision> of(const std::string& libraryId) const;
  /// Remembers a revision that is not lower; the file is replaced atomically. Throws Error(Failed).
  void remember(const std::string& libraryId, const VerifiedRevision& revision);

private:
  std::filesystem::path m_file;
  formats::FileDescriptor m_lock;
  nlohmann::ordered_json m_libraries;
};

}  // namespace lumen::convert
