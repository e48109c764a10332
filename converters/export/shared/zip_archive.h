// SPDX-License-Identifier: Apache-2.0
// PKWARE's zip (APPNOTE 6.3): local headers, then the directory.
#pragma once

#include <cstdint>
#include <string>

namespace lumen::convert {

/// Equal files give equal bytes: there are no times, all are 1980-01-01.
class ZipArchive {
public:
  /// `isProgram`: whoever unpacks it on Unix may run it. Throws Error(Unsupported) for sizes that need the 64-bit
  /// extension (4 GiB), Error(Failed) if zlib refuses.
  void add(const std::string& name, const std::string& bytes, bool isProgram = false);
  /// The whole file.
  [[nodiscard]] std::string bytes() const;

private:
  std::string m_bytes, m_directory;
  std::uint32_t m_count = 0;
};

}  // namespace lumen::convert
