// SPDX-License-Identifier: Apache-2.0
#include "converters/library/row_lock.h"

#include <cerrno>
#include <chrono>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

std::string lockFile(const std::filesystem::path& folder) {
  return folder.string() + ".lock";
}

bool isRefused(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR);
}

}  // namespace

RowLock::RowLock(const std::filesystem::path& folder, const Progress& progress) {
  const std::string file = lockFile(folder);
  constexpr int kPermissions = 0666;
  m_file = formats::FileDescriptor(formats::uninterrupted(
      [&] { return ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kPermissions); }));
  if (!m_file.isOpen())
    throw failed(formats::printable(file) + ": " + formats::systemErrorText(errno));
  while (isRefused(m_file.get())) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    progress.check();
  }
}

bool RowLock::isHeld(const std::filesystem::path& folder) {
  const std::string file = lockFile(folder);
  const formats::FileDescriptor open(
      formats::uninterrupted([&] { return ::open(file.c_str(), O_RDWR | O_CLOEXEC); }));
  return open.isOpen() && isRefused(open.get());
}

}  // namespace lumen::convert
