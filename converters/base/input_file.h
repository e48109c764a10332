// SPDX-License-Identifier: Apache-2.0
// The input of a reader: a file, or bytes in memory under the name of one.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace lumen {

class InputFile {
public:
  InputFile() = default;  ///< none: its name is empty
  /// A file by its name: whatever names a path names an input.
  template <std::convertible_to<std::filesystem::path> Name>
  InputFile(const Name& file) : m_path(file) {}
  /// The bytes outlive this object. `name`: as messages call them, and by whose ending they are
  /// recognised; no file of that name or beside it is opened.
  InputFile(std::filesystem::path name, std::string_view bytes)
      : InputFile(std::move(name), bytes, {}) {}
  /// The same for bytes of which `rest` follows `head`, such as a header and the voxels of an array.
  InputFile(std::filesystem::path name, std::string_view head, std::string_view rest)
      : m_path(std::move(name)), m_bytes({head, rest}) {}

  /// The file, or the name of the bytes.
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
  [[nodiscard]] std::string name() const { return m_path.string(); }
  [[nodiscard]] bool empty() const { return m_path.empty(); }
  [[nodiscard]] bool isInMemory() const { return m_bytes.has_value(); }

  /// Number of bytes. Throws Error(InvalidInput), naming the file.
  [[nodiscard]] std::uint64_t size() const;
  /// The bytes from the first on. Throws Error(InvalidInput), naming the file.
  [[nodiscard]] std::unique_ptr<std::istream> open() const;
  /// All bytes. Throws as readWholeFile().
  [[nodiscard]] std::string read(std::string_view role, std::uint64_t most) const;

private:
  std::filesystem::path m_path;
  std::optional<std::array<std::string_view, 2>> m_bytes;
};

}  // namespace lumen
