// SPDX-License-Identifier: Apache-2.0
// Verification that a library is the one that a trusted signer signed, whole, and not older than
// one seen before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/check_library.h"
#include "converters/library/plain_folder.h"
#include "converters/library/signature.h"

namespace lumen::convert {

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

/// Verifies a library. A revision is remembered as soon as its signature is trusted, whatever its
/// files are like: from then on it is known that there is one. Throws as verifySignature(),
/// VerifiedRevisions and checkLibrary().
LibraryVerdict verifyLibrary(const PlainFolder& folder, const VerifyOptions& options,
                             Progress& progress);

}  // namespace lumen::convert
