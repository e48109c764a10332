// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/verify_library.h"

#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/option_name.h"
#include "converters/base/sha256.h"
#include "converters/base/state_folder.h"
#include "converters/base/text.h"
#include "converters/library/index/json_values.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lumen-verified-libraries";
constexpr const char* kAdvice =
    "; it holds which revisions were verified, and is left as it is. Restore it, or move it away "
    "if older revisions may pass";

std::map<std::string, VerifiedRevision> readState(const fs::path& file) {
  std::error_code error;
  std::map<std::string, VerifiedRevision> libraries;
  if (!fs::exists(fs::symlink_status(file, error))) return libraries;
  try {
    JsonFile document(readWholeFile(file, "list of verified revisions"), file);
    const JsonPlace root(document);
    requireFormat(root, kFormat);
    root.onlyKeys({"format", "formatVersion", "libraries"});
    const JsonPlace all = root.at("libraries");
    if (!all.value().isObject()) all.refuse("an object");
    for (const auto& [key, value] : all.value().members()) {
      const std::string id(key);
      const JsonPlace place = all.at(id);
      if (!isUuid(id)) place.refuse("it under a UUID");
      place.onlyKeys({"revision", "sha256"});
      libraries[id] = {wholeNumber(place.at("revision"), 1), digest(place.at("sha256"))};
    }
  } catch (const Error& fault) {
    throw invalidInput(fault.what() + std::string(kAdvice));
  }
  return libraries;
}

constexpr std::uint64_t kMostSignature = 1U << 16U;  // bytes: one of a long RSA key has 2,000

/// The signature's file, or a fault with the reason why it is none; nothing if there is none.
std::optional<std::string> readSignature(const PlainFolder& folder, const std::string& file,
                                         FaultList& faults, const Progress& progress) {
  PlainRead read = folder.read(file, {{}, true, kMostSignature}, progress);
  if (read.fault == PlainFault::Missing) return {};
  if (read.isRead && read.bytes > 0) return std::move(read.content);
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

/// Refuses a revision that is older than one that was verified, or another of its number or history.
/// Remembers one without any fault.
void checkRevision(const LibraryFile& library, const std::string& digest, const fs::path& state,
                   bool isSound, LibraryVerdict& verdict) {
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
  if (isSound && (!before || before->revision != library.revision))
    known.remember(library.id, {library.revision, digest});
}

}  // namespace

fs::path defaultStateFile() {
  const auto folder = stateFolder();
  if (!folder)
    throw failed(
        "neither XDG_STATE_HOME nor HOME names a folder to remember verified revisions in; " +
        kOption.state.shown() + " FILE does");
  return *folder / "libraries.json";
}

VerifiedRevisions::VerifiedRevisions(const fs::path& file) : m_file(file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    throw failed(file.string() + ": its folder cannot be made: " + error.message() + "; " +
                 kOption.state.shown() + " FILE names another place");
  // beside the file, which is replaced
  const fs::path lock = file.string() + ".lock";
  m_lock =
      formats::FileDescriptor(open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!m_lock.isOpen())
    throw failed(lock.string() + ": cannot be made: " + formats::systemErrorText(errno) + "; " +
                 kOption.state.shown() + " FILE names another place");
  while (flock(m_lock.get(), LOCK_EX) != 0 && errno == EINTR) continue;
  m_libraries = readState(file);
}

std::optional<VerifiedRevision> VerifiedRevisions::of(const std::string& libraryId) const {
  const auto found = m_libraries.find(libraryId);
  return found == m_libraries.end() ? std::nullopt : std::optional(found->second);
}

void VerifiedRevisions::remember(const std::string& libraryId, const VerifiedRevision& revision) {
  m_libraries[libraryId] = revision;
  Json all = {{"format", kFormat}, {"formatVersion", 1}, {"libraries", Json::object()}};
  for (const auto& [id, known] : m_libraries)
    all["libraries"][id] = {{"revision", known.revision}, {"sha256", known.sha256}};
  const std::string text = all.dump(2) + "\n";
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), m_file);
  if (!written) throw failed(written.error().message);
}

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
  const LibraryFile library = *verdict.check.library;
  const auto checkAge = [&](bool isSound) {
    if (!options.state.empty())
      checkRevision(library, sha256(*text), options.state, isSound, verdict);
  };
  checkAge(false);
  if (!verdict.check.faults.empty()) return verdict;
  verdict.check = checkLibrary(folder, *text, {options.mostFaults, {}}, progress);
  // another process may have verified a later revision in the meantime
  if (verdict.isTrusted()) checkAge(true);
  return verdict;
}

}  // namespace lumen::convert
