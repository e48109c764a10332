// SPDX-License-Identifier: Apache-2.0
#include "converters/base/files.h"

#include <cerrno>
#include <span>

#include <fcntl.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "formats/case/atomic_file.h"
#include "formats/case/file_descriptor.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

namespace fs = std::filesystem;

std::string nameOf(const fs::path& file) {
  return formats::printable(file.string());
}

std::string reason() {
  return formats::systemErrorText(errno);
}

std::string sizeText(std::uint64_t bytes) {
  constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
  return bytes % kMebibyte == 0 ? std::to_string(bytes / kMebibyte) + " MiB"
                                : std::to_string(bytes) + " bytes";
}

}  // namespace

std::string readWholeFile(const fs::path& file, std::string_view role, std::uint64_t most) {
  const std::string name = nameOf(file);
  const std::string what(role);
  const formats::FileDescriptor open = formats::openForReading(file);
  if (!open.isOpen() && (errno == ENOENT || errno == ENOTDIR))
    throw invalidInput(name + ": there is no such " + what);
  struct stat status {};
  if (!open.isOpen() || ::fstat(open.get(), &status) != 0)
    throw invalidInput(name + ": this " + what + " cannot be read: " + reason());
  if (!S_ISREG(status.st_mode))
    throw invalidInput(name + ": found " +
                       (S_ISDIR(status.st_mode) ? "a folder" : "a device or a pipe") +
                       ", expected a file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  requireAtMost(most, size, file, role);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  const std::ptrdiff_t got =
      formats::readInto(std::as_writable_bytes(std::span(bytes)), open.get());
  if (got < 0) throw invalidInput(name + ": this " + what + " cannot be read: " + reason());
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

void requireAtMost(std::uint64_t most, std::uint64_t size, const fs::path& file,
                   std::string_view role) {
  if (size > most)
    throw invalidInput(nameOf(file) + ": has " + std::to_string(size) +
                       " bytes; expected at most " + sizeText(most) + " for a " +
                       std::string(role));
}

NewFile::NewFile(const fs::path& file, const fs::path& target)
    : m_target(target.empty() ? formats::placeOf(file) : target), m_out(file, std::ios::binary) {
  requireGood();
}

void NewFile::add(std::string_view bytes) {
  errno = 0;
  m_out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  requireGood();
}

void NewFile::close() {
  errno = 0;
  m_out.close();
  requireGood();
}

void NewFile::requireGood() const {
  if (m_out) return;
  const int code = errno;
  throw failed(nameOf(m_target) + ": cannot write this file" +
               (code != 0 ? ": " + formats::systemErrorText(code) : ""));
}

void writeNewFile(std::string_view bytes, const fs::path& file, const fs::path& target) {
  NewFile out(file, target);
  out.add(bytes);
  out.close();
}

void allowRunning(const fs::path& file) {
  std::error_code error;
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add, error);
  if (error) throw failed(nameOf(file) + ": cannot be made a program: " + error.message());
}

void flushFolder(const fs::path& folder) {
  const formats::FileDescriptor open = formats::openForReading(folder, O_DIRECTORY);
  if (!open.isOpen() || !formats::flushFileSystem(open.get()))
    throw failed(nameOf(folder) + ": cannot be written to disk: " + reason());
}

}  // namespace lumen
