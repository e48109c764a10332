// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "formats/case/case_file.h"
#include "formats/case/issue_text.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;
using Problem = std::optional<FormatError>;

constexpr int kMaxLinks = 40;
constexpr int kMaxNameTrials = 100;
constexpr mode_t kPermissionBits = 07777;
constexpr mode_t kNewFileMode = 0666;  // the process' umask takes its share

FormatError writeError(const fs::path& file, const std::string& what, int code) {
  return fileError(ErrorCode::IoWrite,
                   file.string() + ": " + what + ": " + std::generic_category().message(code));
}

// Retries a system call that a signal interrupted.
template <class Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result == -1 && errno == EINTR) result = call();
  return result;
}

// The file that `file` leads to through symbolic links, whether it exists or not.
Result<fs::path> followLinks(fs::path file) {
  std::error_code error;
  for (int i = 0; i < kMaxLinks; ++i) {
    if (!fs::is_symlink(fs::symlink_status(file, error))) return file;
    const fs::path target = fs::read_symlink(file, error);
    if (error) return writeError(file, "cannot follow the link", error.value());
    file = file.parent_path() / target;  // an absolute target replaces the whole path
  }
  return writeError(file, "cannot follow the link", ELOOP);
}

// The mode that the new file needs, if one of that name exists; refuses what is no writable file.
Result<std::optional<mode_t>> existingMode(const fs::path& target) {
  struct stat info {};
  if (::stat(target.c_str(), &info) != 0) {
    if (errno == ENOENT) return std::optional<mode_t>{};
    return writeError(target, "cannot write", errno);
  }
  if (!S_ISREG(info.st_mode))
    return fileError(
        ErrorCode::IoNotAFile,
        target.string() + (S_ISDIR(info.st_mode) ? ": is a directory" : ": is not a regular file"));
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return writeError(target, "cannot write", errno);
  return std::optional<mode_t>{info.st_mode & kPermissionBits};
}

constexpr const char* kTemporaryStart = ".lumen-";
constexpr const char* kTemporaryEnd = ".tmp";

fs::path directoryOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Only the writer of a temporary file holds the lock on it, until it has its final name or the
// writer is gone.
bool tryLock(int descriptor) {
  return uninterrupted([&] { return ::flock(descriptor, LOCK_EX | LOCK_NB); }) == 0;
}

// Removes what a writer left that was killed between naming its file and renaming it.
void removeLeftovers(const fs::path& directory) {
  std::error_code error;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(kTemporaryStart) || !name.ends_with(kTemporaryEnd)) continue;
    const int descriptor = uninterrupted(
        [&] { return ::open(it->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK); });
    if (descriptor < 0) continue;
    if (tryLock(descriptor)) ::unlink(it->path().c_str());
    ::close(descriptor);
  }
}

// A new file beside the target, removed again unless it was renamed over it. It has no name until
// it is complete, if the file system can do that.
class TemporaryFile {
public:
  explicit TemporaryFile(const fs::path& target) : m_target(target) {}
  ~TemporaryFile() {
    if (m_descriptor >= 0) ::close(m_descriptor);
    if (!m_path.empty()) ::unlink(m_path.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  Problem create() {
    if (createWithoutName()) return std::nullopt;
    const bool named = tryNames([this](const fs::path& path) {
      m_descriptor = uninterrupted([&] {
        return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
      });
      if (m_descriptor < 0) return false;
      tryLock(m_descriptor);
      return true;
    });
    if (named) return std::nullopt;
    return writeError(m_target, "cannot create a file beside it", errno);
  }

  Problem fill(std::span<const std::byte> bytes, std::optional<mode_t> mode) {
    if (mode && ::fchmod(m_descriptor, *mode) != 0)
      return writeError(m_target, "cannot keep its permissions", errno);
    while (!bytes.empty()) {
      const ssize_t count =
          uninterrupted([&] { return ::write(m_descriptor, bytes.data(), bytes.size()); });
      if (count < 0) return writeError(m_target, "cannot write", errno);
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    if (uninterrupted([&] { return ::fsync(m_descriptor); }) != 0)
      return writeError(m_target, "cannot write", errno);
    return std::nullopt;
  }

  // The file is complete: it takes the target's place.
  Problem publish() {
    if (m_path.empty()) {
      if (linkAs(m_target)) return std::nullopt;  // there was no file of that name
      if (!tryNames([this](const fs::path& path) { return linkAs(path); }))
        return writeError(m_target, "cannot create a file beside it", errno);
    }
    if (::rename(m_path.c_str(), m_target.c_str()) != 0)
      return writeError(m_target, "cannot replace the file", errno);
    m_path.clear();
    return std::nullopt;
  }

private:
  bool createWithoutName() {
#ifdef O_TMPFILE
    m_descriptor = uninterrupted([&] {
      return ::open(directoryOf(m_target).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, kNewFileMode);
    });
    if (m_descriptor < 0) return false;
    if (tryLock(m_descriptor) && ::access(descriptorPath().c_str(), F_OK) == 0) return true;
    ::close(m_descriptor);
    m_descriptor = -1;
#endif
    return false;
  }

  [[nodiscard]] std::string descriptorPath() const {
    return "/proc/self/fd/" + std::to_string(m_descriptor);
  }

  bool linkAs(const fs::path& path) const {
    return uninterrupted([&] {
             return ::linkat(AT_FDCWD, descriptorPath().c_str(), AT_FDCWD, path.c_str(),
                             AT_SYMLINK_FOLLOW);
           }) == 0;
  }

  // Calls `make` with names that nobody has, until it succeeds.
  template <class Make>
  bool tryNames(Make make) {
    static std::atomic<unsigned> counter{0};
    for (int trial = 0; trial < kMaxNameTrials; ++trial) {
      const fs::path path =
          m_target.parent_path() / (kTemporaryStart + std::to_string(::getpid()) + "-" +
                                    std::to_string(counter.fetch_add(1)) + kTemporaryEnd);
      if (make(path)) {
        m_path = path;
        return true;
      }
      if (errno != EEXIST) return false;
    }
    return false;
  }

  fs::path m_target, m_path;
  int m_descriptor = -1;
};

// Makes the rename survive a power cut. A directory that cannot be opened or flushed (some network
// file systems) leaves that to the system: the new file is already in place.
void flushDirectory(const fs::path& file) {
  const fs::path directory = directoryOf(file);
  const int descriptor =
      uninterrupted([&] { return ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) return;
  uninterrupted([&] { return ::fsync(descriptor); });
  ::close(descriptor);
}

}  // namespace

Result<bool> writeFileAtomically(std::span<const std::byte> bytes, const fs::path& file) {
  const auto target = followLinks(file);
  if (!target) return target.error();
  const auto mode = existingMode(*target);
  if (!mode) return mode.error();
  TemporaryFile temporary(*target);
  if (auto problem = temporary.create()) return *std::move(problem);
  if (auto problem = temporary.fill(bytes, *mode)) return *std::move(problem);
  if (auto problem = temporary.publish()) return *std::move(problem);
  flushDirectory(*target);
  removeLeftovers(directoryOf(*target));
  return true;
}

}  // namespace lumen::formats
