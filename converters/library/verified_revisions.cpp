// SPDX-License-Identifier: Apache-2.0
#include "converters/library/verified_revisions.h"

#include <cerrno>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/base/state_folder.h"
#include "converters/library/json_values.h"
#include "formats/case/atomic_file.h"
#include "formats/case/case_file.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lumen-verified-libraries";
constexpr const char* kAdvice =
    "; it holds which revisions were verified, and is left as it is. Restore it, or move it away "
    "if older revisions may pass";

Json readState(const fs::path& file) {
  std::error_code error;
  Json libraries = Json::object();
  if (!fs::exists(fs::symlink_status(file, error))) return libraries;
  const auto bytes = formats::readFileBytes(file);
  if (!bytes) throw invalidInput(file.string() + ": " + bytes.error().message + kAdvice);
  try {
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    JsonFile document(text, file);
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
      libraries[id] = {{"revision", wholeNumber(place.at("revision"), 1)},
                       {"sha256", digest(place.at("sha256"))}};
    }
  } catch (const Error& fault) {
    throw invalidInput(fault.what() + std::string(kAdvice));
  }
  return libraries;
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
  if (found == m_libraries.end()) return {};
  return VerifiedRevision{(*found)["revision"].get<std::uint64_t>(),
                          (*found)["sha256"].get<std::string>()};
}

void VerifiedRevisions::remember(const std::string& libraryId, const VerifiedRevision& revision) {
  m_libraries[libraryId] = {{"revision", revision.revision}, {"sha256", revision.sha256}};
  const Json all = {{"format", kFormat}, {"formatVersion", 1}, {"libraries", m_libraries}};
  const std::string text = all.dump(2) + "\n";
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), m_file);
  if (!written) throw failed(written.error().message);
}

}  // namespace lumen::convert
