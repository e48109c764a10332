// SPDX-License-Identifier: Apache-2.0
#include "mapped_file.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lumen::blob {

MappedFile::MappedFile(const char* path) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return;
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (data != MAP_FAILED) {
      m_data = data;
      m_size = size;
    }
  }
  close(file);
}

MappedFile::~MappedFile() {
  if (m_data != nullptr) munmap(const_cast<void*>(m_data), m_size);
}

}  // namespace lumen::blob
#elif defined(__wasm__)
namespace lumen::blob {

// no files exist here, and streams would be most of the library
MappedFile::MappedFile(const char*) {}
MappedFile::~MappedFile() = default;

}  // namespace lumen::blob
#else
#include <fstream>

namespace lumen::blob {

MappedFile::MappedFile(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  if (size <= 0) return;
  m_copy.resize((static_cast<std::size_t>(size) + sizeof(double) - 1) / sizeof(double));
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(m_copy.data()), size)) return;
  m_data = m_copy.data();
  m_size = static_cast<std::size_t>(size);
}

MappedFile::~MappedFile() = default;

}  // namespace lumen::blob
#endif
