// SPDX-License-Identifier: Apache-2.0
#include "formats/case/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <linux/magic.h>
#include <sys/vfs.h>
#endif

#include "formats/case/file_descriptor.h"
#include "formats/case/hidden_folder.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;
constexpr std::size_t kMaxEnding = 16;
constexpr mode_t kPermissionBits = 07777;
constexpr mode_t kNewFileMode = 0666;  // less the bits of the process's umask
constexpr mode_t kNewFolderMode = 0777;

// Whether a link is one of /proc/self/fd, as /dev/stdout is: it leads to what a process holds open,
// which has perhaps no name, and which a new file of its name would not change but cut off.
bool isOpenFile(const fs::path& link) {
#ifdef __linux__
  struct statfs info {};
  return ::statfs(folderOf(link).c_str(), &info) == 0 && info.f_type == PROC_SUPER_MAGIC &&
         link.parent_path().filename() == "fd";
#else
  return link.parent_path() == "/dev/fd";
#endif
}

// The file that `file` leads to through symbolic links, whether it exists or not.
Expected<fs::path> followLinks(fs::path file) {
  std::error_code error;
  for (int i = 0; i < kMaxLinks; ++i) {
    if (!fs::is_symlink(fs::symlink_status(file, error))) return file;
    if (isOpenFile(file))
      return Issue{
          ErrorCode::IoNotAFile, std::nullopt,
          file.string() + ": is an open file of a process, not a regular file with a name"};
    const fs::path target = fs::read_symlink(file, error);
    if (error) return writeError(file, "cannot follow the link", error.value());
    file = file.parent_path() / target;  // an absolute target replaces the whole path
  }
  return writeError(file, "cannot follow the link", ELOOP);
}

// The mode that the new file needs, if one of that name exists; refuses what is no writable file.
Expected<std::optional<mode_t>> existingMode(const fs::path& target) {
  struct stat info {};
  if (::stat(target.c_str(), &info) != 0) {
    if (errno == ENOENT) return std::optional<mode_t>{};
    return writeError(target, "cannot write", errno);
  }
  if (!S_ISREG(info.st_mode))
    return Issue{
        ErrorCode::IoNotAFile, std::nullopt,
        target.string() + (S_ISDIR(info.st_mode) ? ": is a directory" : ": is not a regular file")};
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return writeError(target, "cannot write", errno);
  return std::optional<mode_t>{info.st_mode & kPermissionBits};
}

// The ending of a name, such as ".nii.gz" of "head.nii.gz": writers choose their format by it.
std::string endingOf(const fs::path& file) {
  const std::string last = file.extension().string();
  const std::string both = file.stem().extension().string() + last;
  return both.size() <= kMaxEnding ? both : last.size() <= kMaxEnding ? last : "";
}

// Whether the file system lacks the operation, which is no failure of the disk.
bool isUnsupported(int code) {
  return code == EINVAL || code == ENOSYS || code == ENOTSUP || code == EOPNOTSUPP;
}

// Sets the mode of an open file. Where modes cannot be set, succeeds if the file's mode grants no
// more than `mode`.
bool setMode(int descriptor, mode_t mode, const FileCalls& calls) {
  if (calls.permit(descriptor, mode) == 0) return true;
  const int error = errno;
  struct stat info {};
  if (!isUnsupported(error) && error != EPERM) return false;
  if (::fstat(descriptor, &info) == 0 && (info.st_mode & kPermissionBits & ~mode) == 0) return true;
  errno = error;
  return false;
}

bool flushOpen(int descriptor, const FileCalls& calls) {
  return uninterrupted([&] { return calls.flush(descriptor); }) == 0 || isUnsupported(errno);
}

// Flushes the file or folder at `path` to disk, with the permissions `mode` if that is given.
bool flushPath(const fs::path& path, int flags, const FileCalls& calls,
               std::optional<mode_t> mode = {}) {
  const FileDescriptor open = openForReading(path, flags);
  return open.isOpen() && (!mode || setMode(open.get(), *mode, calls)) &&
         flushOpen(open.get(), calls);
}

// Makes a rename survive a power cut. A folder that cannot be opened or flushed (some network file
// systems) leaves that to the system: the new file or folder is already in place.
void finish(const fs::path& target, const FileCalls& calls) {
  const fs::path folder = folderOf(target);
  flushPath(folder, O_DIRECTORY, calls);
  removeAbandoned(folder);
}

// Flushes everything in `folder`, then the folder.
bool flushFolder(const fs::path& folder, const FileCalls& calls) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::file_status status = entry.symlink_status(error);
    if (fs::is_directory(status) && !flushFolder(entry.path(), calls)) return false;
    if (fs::is_regular_file(status) && !flushPath(entry.path(), 0, calls)) return false;
  }
  if (error) errno = error.value();
  return !error && flushPath(folder, O_DIRECTORY, calls);
}

// Flushes the file system of `folder` by one call, or else the folder file by file.
bool flushAtOnce(const fs::path& folder, const FileCalls& calls) {
  if (!calls.flushSystem) return flushFolder(folder, calls);
  const FileDescriptor open = openForReading(folder, O_DIRECTORY);
  if (!open.isOpen()) return false;
  return calls.flushSystem(open.get()) == 0 || (isUnsupported(errno) && flushFolder(folder, calls));
}

int exchangeNames(const char* a, const char* b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a, AT_FDCWD, b, RENAME_EXCHANGE);
#else
  (void)a, (void)b;
  errno = ENOSYS;
  return -1;
#endif
}

}  // namespace

const FileCalls& systemCalls() {
  static const FileCalls calls{
      [](int descriptor) { return ::fsync(descriptor); },
      [](int descriptor, mode_t mode) { return ::fchmod(descriptor, mode); },
      [](const char* from, const char* to) { return ::rename(from, to); }, exchangeNames,
      [](int descriptor) { return flushFileSystem(descriptor) ? 0 : -1; }};
  return calls;
}

Status writeFileAtomically(std::span<const std::byte> bytes, const fs::path& file,
                           const FileCalls& calls) {
  auto pending = PendingFile::beside(file, calls);
  if (!pending) return pending.error();
  if (!writeAll(bytes, pending->descriptor())) return writeError(file, "cannot write", errno);
  return pending->commit();
}

Expected<PendingFile> PendingFile::beside(const fs::path& file, const FileCalls& calls) {
  const auto target = followLinks(file);
  if (!target) return target.error();
  const auto mode = existingMode(*target);
  if (!mode) return mode.error();
  auto sibling = hiddenSibling(*target, endingOf(*target));
  if (!sibling) return sibling.error();
  FileDescriptor open(uninterrupted([&] {
    return ::open(sibling->path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
  }));
  if (!open.isOpen()) return writeError(*target, "cannot write", errno);
  return PendingFile(*std::move(sibling), std::move(open), *target, *mode, calls);
}

Status PendingFile::commit() {
  if (!flushPath(path(), 0, m_calls, m_mode)) return writeError(m_target, "cannot write", errno);
  if (m_calls.get().rename(path().c_str(), m_target.c_str()) != 0)
    return writeError(m_target, "cannot replace the file", errno);
  m_sibling.remove();
  finish(m_target, m_calls);
  return {};
}

Expected<PendingFolder> PendingFolder::beside(const fs::path& folder, Existing existing,
                                              const FileCalls& calls) {
  const auto target = followLinks(folder.has_filename() ? folder : folder.parent_path());
  if (!target) return target.error();
  std::error_code error;
  const fs::file_status status = fs::status(*target, error);
  if (fs::exists(status) && !fs::is_directory(status))
    return writeError(*target, "cannot become a folder", ENOTDIR);
  if (fs::exists(status) && existing == Existing::Refuse && !fs::is_empty(*target, error))
    return writeError(*target, "cannot be replaced", ENOTEMPTY);
  auto sibling = hiddenSibling(*target, "");
  if (!sibling) return sibling.error();
  if (::mkdir(sibling->path().c_str(), kNewFolderMode) != 0)
    return writeError(*target, "cannot write", errno);
  return PendingFolder(*std::move(sibling), *target, existing, calls);
}

Status PendingFolder::commit(Flush how) {
  const auto flush = how == Flush::Each ? flushFolder : flushAtOnce;
  if (!flush(path(), m_calls)) return writeError(m_target, "cannot write", errno);
  if (m_calls.get().rename(path().c_str(), m_target.c_str()) != 0) {
    const bool isFull = errno == ENOTEMPTY || errno == EEXIST;
    if (!isFull || m_existing == Existing::Refuse)
      return writeError(m_target, "cannot be put in place", errno);
    if (auto replaced = replace(); !replaced) return replaced;
  }
  m_sibling.remove();
  finish(m_target, m_calls);
  return {};
}

Status PendingFolder::replace() {
  const FileCalls& calls = m_calls;
  // the old folder takes the place of the new one, and is removed with it
  if (calls.exchange(path().c_str(), m_target.c_str()) == 0) return {};
  if (!isUnsupported(errno)) return writeError(m_target, "cannot replace the folder", errno);
  const std::string old = m_target.string() + ".lumen-old";
  if (calls.rename(m_target.c_str(), old.c_str()) != 0) {
    if (errno != ENOTEMPTY && errno != EEXIST)
      return writeError(m_target, "cannot be moved away", errno);
    return Issue{ErrorCode::IoWrite, std::nullopt,
                 m_target.string() + ": cannot be replaced: found " + old +
                     ", which an interrupted replacement left; expected nothing there: look " +
                     "whether it holds something that you need, and move it away or remove it"};
  }
  if (calls.rename(path().c_str(), m_target.c_str()) != 0) {
    const int error = errno;
    calls.rename(old.c_str(), m_target.c_str());
    return writeError(m_target, "cannot replace the folder", error);
  }
  calls.rename(old.c_str(), path().c_str());  // hidden: if its removal is killed, the next goes on
  return {};
}

}  // namespace lumen::formats
