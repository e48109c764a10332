// SPDX-License-Identifier: Apache-2.0
#include "converters/library/library_lock.h"

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

bool isLockedByOthers(int descriptor, LibraryLock::Use use) {
  const int kind = use == LibraryLock::Use::Read ? LOCK_SH : LOCK_EX;
  return ::flock(descriptor, kind | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR);
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
    while (isLockedByOthers(m_folder.get(), use)) {
      if (!std::exchange(waits, true))
        progress.detail(formats::printable(library.string()) + ": waiting for another " +
                        (use == Use::Read ? "change" : "use") + " of this library");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      progress.check();
    }
    // another writer may have exchanged the folder while this one waited
  } while (!isSamePlace(m_folder.get(), library));
}

}  // namespace lumen::convert
