// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/library_lock.h"

#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "formats/case/file_descriptor.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

bool isSamePlace(int descriptor, const std::filesystem::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

/// `kind`: LOCK_SH or LOCK_EX.
bool isLockedByOthers(int descriptor, int kind) {
  return ::flock(descriptor, kind | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR);
}

formats::FileDescriptor openRowLock(const std::string& file, int flags) {
  constexpr int kPermissions = 0666;
  return formats::FileDescriptor(formats::uninterrupted(
      [&] { return ::open(file.c_str(), O_RDWR | O_CLOEXEC | flags, kPermissions); }));
}

}  // namespace

formats::FileDescriptor openLibraryFolder(const std::filesystem::path& library) {
  formats::FileDescriptor folder = formats::openForReading(library, O_DIRECTORY);
  if (folder.isOpen()) return folder;
  const int code = errno;
  const std::string name = formats::printable(library.string());
  if (code == ENOENT) throw invalidInput(name + ": there is no such library");
  if (code == ENOTDIR)
    throw invalidInput(name + ": found a file, expected the folder of a library");
  throw invalidInput(name + ": this library cannot be read: " + formats::systemErrorText(code));
}

LibraryLock::LibraryLock(const std::filesystem::path& library, Progress& progress, Use use) {
  bool waits = false;
  do {
    m_folder = openLibraryFolder(library);
    while (isLockedByOthers(m_folder.get(), use == Use::Read ? LOCK_SH : LOCK_EX)) {
      if (!std::exchange(waits, true))
        progress.detail(formats::printable(library.string()) + ": waiting for another " +
                        (use == Use::Read ? "change" : "use") + " of this library");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      progress.check();
    }
    // another writer may have exchanged the folder while this one waited
  } while (!isSamePlace(m_folder.get(), library));
}

RowLock::RowLock(const std::filesystem::path& folder, const Progress& progress) {
  const std::string file = folder.string() + ".lock";
  m_file = openRowLock(file, O_CREAT);
  if (!m_file.isOpen())
    throw failed(formats::printable(file) + ": " + formats::systemErrorText(errno));
  while (isLockedByOthers(m_file.get(), LOCK_EX)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    progress.check();
  }
}

bool RowLock::isHeld(const std::filesystem::path& folder) {
  const formats::FileDescriptor open = openRowLock(folder.string() + ".lock", 0);
  return open.isOpen() && isLockedByOthers(open.get(), LOCK_EX);
}

}  // namespace lumen::convert
