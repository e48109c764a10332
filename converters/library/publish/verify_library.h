// SPDX-License-Identifier: Apache-2.0
// Verification that a library is the one that a trusted signer signed, whole, and not older than
// one seen before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/publish/check_library.h"
#include "converters/library/publish/plain_folder.h"
#include "converters/library/publish/signature.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

// The revision of each library that was seen signed before, so that an older one is not taken for
// news.

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
  std::map<std::string, VerifiedRevision> m_libraries;
};

struct VerifyOptions {
  KeyFile trusted;
  std::string identity;         ///< one of a list of allowed signers; empty: any of them
  std::filesystem::path state;  ///< VerifiedRevisions' file; none: nothing is remembered
  std::size_t mostFaults = 1000;
};

struct LibraryVerdict {
  /// Includes the faults of signature and revision. The cases are checked only if there are none of
  /// these.
  LibraryCheck check;
  Signer signer;                    ///< as far as it is known
  std::uint64_t knownRevision = 0;  ///< the revision verified before; 0 for none
  [[nodiscard]] bool isTrusted() const { return check.faults.counts().errors == 0; }
};

/// Verifies a library. A revision is remembered if it has no error. Throws as verifySignature(),
/// VerifiedRevisions and checkLibrary().
LibraryVerdict verifyLibrary(const PlainFolder& folder, const VerifyOptions& options,
                             Progress& progress);

}  // namespace lumen::convert
