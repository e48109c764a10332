// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/plain_folder.h"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <dirent.h>
#include <fcntl.h>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/library/index/library_lock.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

namespace {

using formats::FileDescriptor;

constexpr std::size_t kPiece = std::size_t{1} << 18;  // bytes: read at once

struct CloseFolder {
  void operator()(DIR* folder) const { closedir(folder); }
};

PlainRead fault(PlainFault kind, std::string found) {
  PlainRead read;
  read.fault = kind;
  read.found = std::move(found);
  return read;
}

/// Reason why opening `name` in `folder` failed with `code`.
PlainRead openFault(int folder, const char* name, int code) {
  if (code == ENOENT) return fault(PlainFault::Missing, "nothing");
  struct stat status {};
  const bool isKind = code == ELOOP || code == ENOTDIR || code == ENXIO || code == ENODEV;
  if (isKind && fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0)
    return fault(PlainFault::Kind, kindText(status.st_mode));
  return fault(PlainFault::Unreadable, formats::systemErrorText(code));
}

/// The file or folder of that path below `root`, through folders only; O_NONBLOCK, as a pipe would
/// wait for a writer.
std::pair<FileDescriptor, PlainRead> openBelow(int root, const std::string& path, int flags) {
  FileDescriptor at(openat(root, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!at.isOpen())
    return {FileDescriptor(), fault(PlainFault::Unreadable, formats::systemErrorText(errno))};
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    const int kind = end < path.size() ? O_DIRECTORY : flags;
    FileDescriptor next(
        openat(at.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | kind));
    if (!next.isOpen()) return {FileDescriptor(), openFault(at.get(), name.c_str(), errno)};
    at = std::move(next);
    begin = end + 1;
  }
  return {std::move(at), PlainRead{}};
}

bool isSame(const struct stat& a, const struct stat& b) {
  return a.st_size == b.st_size && a.st_mtim.tv_sec == b.st_mtim.tv_sec &&
         a.st_mtim.tv_nsec == b.st_mtim.tv_nsec && a.st_ctim.tv_sec == b.st_ctim.tv_sec &&
         a.st_ctim.tv_nsec == b.st_ctim.tv_nsec;
}

/// The rest of a file whose state gives `size` bytes.
PlainRead readOpen(int file, std::uint64_t size, bool isKept, const Progress& progress) {
  PlainRead result;
  Sha256 digest;
  std::vector<std::byte> piece(std::min<std::uint64_t>(kPiece, size + 1));
  std::uint64_t total = 0;
  while (total <= size) {
    progress.check();
    const std::ptrdiff_t n = formats::readInto(piece, file);
    if (n < 0) return fault(PlainFault::Unreadable, formats::systemErrorText(errno));
    if (n == 0) break;
    const std::span bytes(piece.data(), static_cast<std::size_t>(n));
    digest.add(bytes);
    if (isKept) result.content.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    total += bytes.size();
  }
  if (total != size) return fault(PlainFault::Unreadable, "a file that changes");
  result.sha256 = digest.text();
  result.isRead = true;
  return result;
}

}  // namespace

std::string kindText(mode_t mode) {
  switch (mode & S_IFMT) {
    case S_IFREG:
      return "a file";
    case S_IFDIR:
      return "a folder";
    case S_IFLNK:
      return "a symbolic link";
    case S_IFIFO:
      return "a named pipe";
    case S_IFSOCK:
      return "a socket";
    default:
      return "a device";
  }
}

PlainFolder::PlainFolder(const std::filesystem::path& folder)
    : m_path(folder), m_descriptor(openLibraryFolder(folder)) {}

PlainRead PlainFolder::read(const std::string& path, const WantedRead& wanted,
                            const Progress& progress) const {
  auto [file, result] = openBelow(m_descriptor.get(), path, 0);
  if (result.fault != PlainFault::None) return result;
  struct stat before {};
  struct stat after {};
  if (fstat(file.get(), &before) != 0)
    return fault(PlainFault::Unreadable, formats::systemErrorText(errno));
  if (!S_ISREG(before.st_mode)) return fault(PlainFault::Kind, kindText(before.st_mode));
  const auto size = static_cast<std::uint64_t>(before.st_size);
  if (size <= wanted.most && wanted.bytes.value_or(size) == size) {
    result = readOpen(file.get(), size, wanted.isKept, progress);
    if (result.fault == PlainFault::None &&
        (fstat(file.get(), &after) != 0 || !isSame(before, after)))
      return fault(PlainFault::Unreadable, "a file that changes");
  }
  result.bytes = size;
  return result;
}

PlainRead PlainFolder::list(const std::string& path,
                            const std::function<void(const PlainEntry&)>& see) const {
  auto [folder, result] = openBelow(m_descriptor.get(), path, O_DIRECTORY);
  if (result.fault != PlainFault::None) return result;
  const std::unique_ptr<DIR, CloseFolder> stream(fdopendir(folder.get()));
  if (!stream) return fault(PlainFault::Unreadable, formats::systemErrorText(errno));
  const int descriptor = folder.release();  // it is the stream's now
  PlainEntry entry;
  while (true) {
    errno = 0;
    const dirent* const next = readdir(stream.get());
    if (next == nullptr) break;
    entry.name = next->d_name;
    if (entry.name == "." || entry.name == "..") continue;
    if (fstatat(descriptor, next->d_name, &entry.status, AT_SYMLINK_NOFOLLOW) != 0) continue;
    see(entry);
  }
  if (errno != 0) return fault(PlainFault::Unreadable, formats::systemErrorText(errno));
  return result;
}

}  // namespace lumen::convert
