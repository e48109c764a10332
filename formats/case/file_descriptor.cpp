// SPDX-License-Identifier: Apache-2.0
#include "formats/case/file_descriptor.h"

#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace lumen::formats {

std::string systemErrorText(int code) {
  return std::generic_category().message(code);
}

FileDescriptor::~FileDescriptor() {
  if (m_descriptor < 0) return;
  const int error = errno;
  ::close(m_descriptor);
  errno = error;
}

FileDescriptor openForReading(const std::filesystem::path& file, int flags) {
  return FileDescriptor(uninterrupted(
      [&] { return ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | flags); }));
}

std::ptrdiff_t readInto(std::span<std::byte> bytes, int descriptor) {
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t count =
        uninterrupted([&] { return ::read(descriptor, bytes.data() + got, bytes.size() - got); });
    if (count < 0) return -1;
    if (count == 0) break;
    got += static_cast<std::size_t>(count);
  }
  return static_cast<std::ptrdiff_t>(got);
}

bool writeAll(std::span<const std::byte> bytes, int descriptor) {
  while (!bytes.empty()) {
    const ssize_t count =
        uninterrupted([&] { return ::write(descriptor, bytes.data(), bytes.size()); });
    if (count < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool flushFileSystem(int folder) {
#ifdef __linux__
  return ::syncfs(folder) == 0;
#else
  (void)folder;
  errno = ENOSYS;
  return false;
#endif
}

}  // namespace lumen::formats
