// SPDX-License-Identifier: Apache-2.0
#include "formats/case/hidden_folder.h"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNameTrials = 100;
constexpr mode_t kProofMode = 0666;         // less the bits of the process's umask
constexpr mode_t kHiddenFolderMode = 0777;  // the same

constexpr std::size_t kRandomDigits = 10;

std::string newHiddenName() {
  std::string random = std::to_string(std::random_device()());
  random.insert(0, kRandomDigits - std::min(kRandomDigits, random.size()), '0');
  return std::string(kTemporaryPrefix) + std::to_string(::getpid()) + "-" + random;
}

// The file by which a hidden folder proves to be one of a writer, whatever its name.
constexpr const char* kProof = ".lumen-temporary";
constexpr std::string_view kProofText =
    "lumen writes in this folder, and removes it with all in it: when it is done, or else with the "
    "next file that it writes beside it.\n";

// A prefix, digits, a hyphen and kRandomDigits digits.
bool isTemporaryName(std::string_view name) {
  if (!name.starts_with(kTemporaryPrefix)) return false;
  name.remove_prefix(kTemporaryPrefix.size());
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  if (digits == 0 || digits == name.size() || name[digits] != '-') return false;
  name.remove_prefix(digits + 1);
  return name.size() == kRandomDigits && name.find_first_not_of("0123456789") == name.npos;
}

bool writeProof(const fs::path& folder) {
  const FileDescriptor open(uninterrupted([&] {
    return ::open((folder / kProof).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kProofMode);
  }));
  return open.isOpen() && writeAll(std::as_bytes(std::span(kProofText)), open.get());
}

// The start of the file that proves a folder to be lumen's; nothing where there is no such file.
std::optional<std::string> proofIn(const fs::path& folder) {
  const FileDescriptor open = openForReading(folder / kProof, O_NOFOLLOW);
  struct stat info {};
  if (!open.isOpen() || ::fstat(open.get(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  std::string text(kProofText.size() + 1, '\0');  // a longer text is another one
  const ssize_t count =
      uninterrupted([&] { return ::pread(open.get(), text.data(), text.size(), 0); });
  if (count < 0) return {};
  text.resize(static_cast<std::size_t>(count));
  return text;
}

bool hasProof(const fs::path& folder) {
  return proofIn(folder) == kProofText;
}

// Whether the writer was killed while it wrote the proof, which is the first thing in a folder.
bool hasBegunProofAlone(const fs::path& folder) {
  const auto text = proofIn(folder);
  if (!text || !kProofText.starts_with(*text)) return false;
  std::error_code error;
  return std::distance(fs::directory_iterator(folder, error), {}) == 1;
}

// Hidden files and folders of this process that are not in their place yet.
struct OwnTemporaries {
  std::mutex mutex;
  std::map<fs::path, fs::path> targets;  // of the hidden folders
};
OwnTemporaries& ownTemporaries() {
  static auto* const own = new OwnTemporaries;  // outlives every writer
  return *own;
}

bool tryLock(int descriptor) {
  return uninterrupted([&] { return ::flock(descriptor, LOCK_EX | LOCK_NB); }) == 0;
}

// Removes a hidden folder. The proof goes last, so that the next write can finish what a kill ends.
void removeHidden(const fs::path& folder) {
  std::error_code error, ignored;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().filename() != kProof) fs::remove_all(it->path(), ignored);
  fs::remove(folder / kProof, ignored);
  fs::remove(folder, ignored);
}

}  // namespace

// The lock comes before the proof, without which nobody removes the folder.
Expected<HiddenSibling> hiddenSibling(const fs::path& target, const std::string& ending) {
  int error = EEXIST;
  for (int trial = 0; trial < kMaxNameTrials; ++trial) {
    const fs::path path = target.parent_path() / newHiddenName();
    if (::mkdir(path.c_str(), kHiddenFolderMode) != 0) {
      error = errno;
      if (error == EEXIST) continue;
      break;
    }
    HiddenSibling sibling(path, ending, target, openForReading(path, O_DIRECTORY));
    if (sibling.lock()) return sibling;
    error = errno;
    if (error != ENOENT) break;  // another writer took the folder for a remnant without a proof
  }
  return writeError(target, "no file can be made in the folder " + folderOf(target).string(),
                    error);
}

// The lock, which a living writer would hold, is held until the folder is gone: a writer that made
// its folder just now waits, and finds that it has to make another one.
void removeAbandoned(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& path = it->path();
    if (!isTemporaryName(path.filename().string())) continue;
    const FileDescriptor open = openForReading(path, O_NOFOLLOW);
    if (!open.isOpen() || !tryLock(open.get())) continue;
    if (hasProof(path) || hasBegunProofAlone(path))
      removeHidden(path);
    else
      ::rmdir(path.c_str());
  }
}

HiddenSibling::HiddenSibling(fs::path folder, const std::string& ending, const fs::path& target,
                             FileDescriptor descriptor)
    : m_folder(std::move(folder)),
      m_path(m_folder / ("new" + ending)),
      m_descriptor(std::move(descriptor)) {
  const std::lock_guard lock(ownTemporaries().mutex);
  ownTemporaries().targets.emplace(m_folder, target);
}

HiddenSibling::HiddenSibling(HiddenSibling&& other) noexcept
    : m_folder(std::exchange(other.m_folder, {})),
      m_path(std::move(other.m_path)),
      m_descriptor(std::move(other.m_descriptor)) {}

HiddenSibling::~HiddenSibling() {
  remove();
}

bool HiddenSibling::lock() {
  if (!m_descriptor.isOpen()) return false;
  // it may be held for an instant; a file system without locks has no abandoned files either
  uninterrupted([&] { return ::flock(m_descriptor.get(), LOCK_EX); });
  return writeProof(m_folder);
}

void HiddenSibling::remove() {
  if (m_folder.empty()) return;
  removeHidden(m_folder);
  const std::lock_guard lock(ownTemporaries().mutex);
  ownTemporaries().targets.erase(m_folder);
  m_folder.clear();
}

bool isTemporary(const fs::path& path) {
  return isTemporaryName(path.filename().string()) && hasProof(path);
}

void removeOwnTemporaries() {
  const std::lock_guard lock(ownTemporaries().mutex);
  for (const auto& [folder, target] : ownTemporaries().targets) removeHidden(folder);
}

fs::path placeOf(const fs::path& file) {
  const std::lock_guard lock(ownTemporaries().mutex);
  for (const auto& [folder, target] : ownTemporaries().targets) {
    const auto [stop, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    if (stop != folder.end() || at == file.end()) continue;
    fs::path place = target;
    for (auto part = std::next(at); part != file.end(); ++part) place /= *part;
    return place;
  }
  return file;
}

}  // namespace lumen::formats
