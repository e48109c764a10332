// SPDX-License-Identifier: Apache-2.0
// Inputs and outputs of a command that are in memory, under the names by which its arguments and
// options name them.
#pragma once

#include <concepts>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/input_file.h"

namespace lumen {

/// The output of a writer: a file, or a place in memory under the name of one.
class OutputFile {
public:
  OutputFile() = default;  ///< none: its name is empty
  /// A file by its name: whatever names a path names an output.
  template <std::convertible_to<std::filesystem::path> Name>
  OutputFile(const Name& file) : m_path(file) {}
  /// `bytes` receives what is written, and outlives this object.
  OutputFile(std::filesystem::path name, std::string& bytes)
      : m_path(std::move(name)), m_bytes(&bytes) {}

  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
  [[nodiscard]] std::string name() const { return m_path.string(); }
  [[nodiscard]] bool empty() const { return m_path.empty(); }
  /// The place in memory; null for a file.
  [[nodiscard]] std::string* bytes() const { return m_bytes; }

private:
  std::filesystem::path m_path;
  std::string* m_bytes = nullptr;
};

/// The names are equal to those of no file that the command reads or writes.
class MemoryFiles {
public:
  /// An input. `rest`, which outlives this object, follows `head`.
  void give(const std::string& name, std::string head, std::string_view rest = {}) {
    m_given[name] = {std::move(head), rest};
  }
  /// An output. Returns its bytes, which are empty until a command wrote it.
  std::string& keep(const std::string& name) { return m_kept[name]; }

  /// The input of that name: bytes that were given, or else a file.
  [[nodiscard]] InputFile input(const std::string& name) const {
    const auto found = m_given.find(name);
    if (found == m_given.end()) return name;
    return {name, found->second.first, found->second.second};
  }
  /// The output of that name: a place that keep() made, or else a file.
  [[nodiscard]] OutputFile output(const std::string& name) {
    const auto found = m_kept.find(name);
    if (found == m_kept.end()) return name;
    return {name, found->second};
  }

private:
  std::map<std::string, std::pair<std::string, std::string_view>> m_given;
  std::map<std::string, std::string> m_kept;
};

}  // namespace lumen
