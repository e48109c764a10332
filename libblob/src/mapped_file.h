// SPDX-License-Identifier: Apache-2.0
// A file's bytes, read only.
#pragma once

#include <cstddef>
#include <vector>

namespace lumen::blob {

/// A file mapped into memory where the system can, read into memory elsewhere.
class MappedFile {
public:
  /// Maps or reads a file; false as a bool if it cannot be opened, is no regular file, or is empty.
  explicit MappedFile(const char* path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  explicit operator bool() const { return m_data != nullptr; }
  [[nodiscard]] const void* data() const { return m_data; }
  [[nodiscard]] std::size_t size() const { return m_size; }

private:
  const void* m_data = nullptr;
  std::size_t m_size = 0;
  std::vector<double> m_copy;  ///< bytes where files cannot be mapped; doubles for alignment
};

}  // namespace lumen::blob
