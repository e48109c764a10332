// SPDX-License-Identifier: Apache-2.0
// Open files and folders, and the system calls on them that a signal may interrupt.
#pragma once

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include <sys/types.h>

namespace lumen::formats {

/// The message of an error number of the system, such as errno.
std::string systemErrorText(int code);

/// Retries a system call that a signal interrupted.
template <class Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result == -1 && errno == EINTR) result = call();
  return result;
}

/// An open file or folder, closed with this object; closing keeps errno.
class FileDescriptor {
public:
  explicit FileDescriptor(int descriptor = -1) : m_descriptor(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept : m_descriptor(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(m_descriptor, other.m_descriptor);
    return *this;
  }
  ~FileDescriptor();
  [[nodiscard]] bool isOpen() const { return m_descriptor >= 0; }
  [[nodiscard]] int get() const { return m_descriptor; }
  /// The descriptor, which the caller closes.
  int release() { return std::exchange(m_descriptor, -1); }

private:
  int m_descriptor;
};

/// Opens a file or folder for reading, without waiting for the writer of a pipe; `flags` of open(2)
/// are added. On failure the result is not open, and errno is set.
FileDescriptor openForReading(const std::filesystem::path& file, int flags = 0);

/// Fills `bytes` from an open file and returns the number of bytes: fewer at the end of the file,
/// -1 with errno set on failure.
std::ptrdiff_t readInto(std::span<std::byte> bytes, int descriptor);

/// Writes all of `bytes` to an open file; false, with errno set, on failure.
bool writeAll(std::span<const std::byte> bytes, int descriptor);

/// Flushes the file system of a folder to disk; false, with errno set, on failure or where no such
/// call exists.
bool flushFileSystem(int folder);

}  // namespace lumen::formats
