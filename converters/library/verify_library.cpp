// SPDX-License-Identifier: Apache-2.0
#include "converters/library/verify_library.h"

#include <optional>
#include <span>
#include <utility>

#include "converters/base/sha256.h"
#include "converters/base/text.h"
#include "converters/library/verified_revisions.h"

namespace lumen::convert {

namespace {

constexpr std::uint64_t kMostSignature = 1U << 16U;  // bytes: one of a long RSA key has 2,000

/// The signature's file, or a fault with the reason why it is none; nothing if there is none.
std::optional<std::string> readSignature(const PlainFolder& folder, const std::string& file,
                                         FaultList& faults, const Progress& progress) {
  PlainRead read = folder.read(file, {0, false}, progress);
  if (read.fault == PlainFault::None && read.bytes <= kMostSignature && read.bytes > 0)
    read = folder.read(file, {read.bytes, true}, progress);
  if (read.fault == PlainFault::Missing) return {};
  if (read.fault == PlainFault::None && !read.content.empty()) return std::move(read.content);
  const std::string found =
      read.fault == PlainFault::None ? counted(read.bytes, "byte", "bytes") : read.found;
  faults.add({FaultCode::SignatureBroken, "", file, found, "a signature"});
  return {};
}

void checkSignature(const PlainFolder& folder, const std::string& text,
                    const VerifyOptions& options, LibraryVerdict& verdict,
                    const Progress& progress) {
  const std::string file = signatureFile(options.trusted.kind);
  const auto signature = readSignature(folder, file, verdict.check.faults, progress);
  if (!verdict.check.faults.empty()) return;
  const TrustAnswer answer =
      verifySignature(text, signature, options.trusted, options.identity, progress);
  verdict.signer = answer.signer;
  if (answer.trust == Trust::Trusted) return;
  const FaultCode code = answer.trust == Trust::Unsigned    ? FaultCode::SignatureMissing
                         : answer.trust == Trust::Untrusted ? FaultCode::SignatureKey
                                                            : FaultCode::SignatureBroken;
  verdict.check.faults.add({code, "", file, answer.found, answer.expected});
}

/// Refuses a revision that is older than one seen, or another of its number or history; remembers
/// it otherwise.
void checkRevision(const LibraryFile& library, const std::string& digest,
                   const std::filesystem::path& state, LibraryVerdict& verdict) {
  VerifiedRevisions known(state);
  const auto before = known.of(library.id);
  verdict.knownRevision = before ? before->revision : 0;
  const auto refuse = [&](FaultCode code, const std::string& found, const std::string& expected) {
    verdict.check.faults.add(
        {code, "", kLibraryFile, found, expected + ", as " + state.string() + " remembers"});
  };
  const std::string number = "revision " + std::to_string(library.revision);
  const std::string at = before ? "revision " + std::to_string(before->revision) : "";
  if (before && library.revision < before->revision)
    return refuse(FaultCode::RevisionOlder, number,
                  at + " or a later one: that was verified before");
  if (before && library.revision == before->revision && digest != before->sha256)
    return refuse(FaultCode::RevisionOther, number + " with SHA-256 " + digest,
                  before->sha256 + ": another of this number was verified before");
  if (before && library.revision == before->revision + 1 && library.previous != before->sha256)
    return refuse(FaultCode::RevisionOther,
                  number + " that follows " + library.previous.value_or("nothing"),
                  "one that follows " + before->sha256 + ", " + at + ": that was verified before");
  if (!before || before->revision != library.revision)
    known.remember(library.id, {library.revision, digest});
}

}  // namespace

LibraryVerdict verifyLibrary(const PlainFolder& folder, const VerifyOptions& options,
                             Progress& progress) {
  LibraryVerdict verdict{{FaultList(options.mostFaults), {}, 0, 0, 0, 0}, {}, 0};
  const auto text = readLibraryText(folder, verdict.check.faults, progress);
  if (!text) return verdict;
  checkSignature(folder, *text, options, verdict, progress);
  if (!verdict.check.faults.empty()) return verdict;
  try {
    verdict.check.library = readLibrary(*text, kLibraryFile);
  } catch (const Error& error) {
    verdict.check.faults.add({FaultCode::LibraryFile, "", kLibraryFile, error.what(), ""});
    return verdict;
  }
  if (!options.state.empty())
    checkRevision(*verdict.check.library, sha256(std::as_bytes(std::span(*text))), options.state,
                  verdict);
  if (verdict.check.faults.empty())
    verdict.check = checkLibrary(folder, *text, {options.mostFaults, {}}, progress);
  return verdict;
}

}  // namespace lumen::convert
