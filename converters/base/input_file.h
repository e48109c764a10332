// SPDX-License-Identifier: Apache-2.0
// The input of a reader: a file or a folder, or bytes in memory under the name of one.
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
#include <utility>
#include <vector>

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
  /// A folder in memory, whose files outlive this object. Their names are as messages call them.
  InputFile(std::filesystem::path name, const std::vector<InputFile>& files)
      : m_path(std::move(name)), m_files(&files) {}

  /// The file, or the name of the bytes.
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
  [[nodiscard]] std::string name() const { return m_path.string(); }
  [[nodiscard]] bool empty() const { return m_path.empty(); }
  [[nodiscard]] bool isInMemory() const { return m_bytes || m_files != nullptr; }
  /// Files of a folder in memory; null for any other input.
  [[nodiscard]] const std::vector<InputFile>* files() const { return m_files; }
  [[nodiscard]] bool isFolder() const;

  /// Number of bytes. Throws Error(InvalidInput), naming the file.
  [[nodiscard]] std::uint64_t size() const;
  /// The bytes from the first on. Throws Error(InvalidInput), naming the file.
  [[nodiscard]] std::unique_ptr<std::istream> open() const;
  /// All bytes. Throws as readWholeFile().
  [[nodiscard]] std::string read(std::string_view role, std::uint64_t most) const;

private:
  std::filesystem::path m_path;
  std::optional<std::array<std::string_view, 2>> m_bytes;
  const std::vector<InputFile>* m_files = nullptr;
};

}  // namespace lumen
