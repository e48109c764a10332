// SPDX-License-Identifier: Apache-2.0
// Reading JSON of others strictly: every refusal names the file, the place, what was found and what was expected.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace lumen::convert {

/// Parses text; throws Error(InvalidInput), naming `file`, for what is not JSON, an object with one
/// key twice, or a nesting deeper than any such file needs.
nlohmann::json parseJson(const std::string& text, const std::filesystem::path& file);

/// A document and the name of its file; must outlive the places in it.
struct JsonFile {
  nlohmann::json root;
  std::string name;
};

/// A JSON value in its file. Every accessor throws Error(InvalidInput) with the file, the JSON
/// pointer (RFC 6901), what was found and what was expected; the pointer is looked up only then.
class JsonPlace {
public:
  explicit JsonPlace(const JsonFile& file) : JsonPlace(file.root, file) {}
  JsonPlace(const nlohmann::json& value, const JsonFile& file) : m_value(&value), m_file(&file) {}

  [[nodiscard]] const nlohmann::json& value() const { return *m_value; }
  [[noreturn]] void refuse(const std::string& expected) const;

  /// Refuses an object with another key than these, and anything but an object.
  void onlyKeys(std::initializer_list<const char*> keys) const;
  [[nodiscard]] bool has(const char* key) const;
  [[nodiscard]] JsonPlace at(const char* key) const;      ///< refuses if there is none
  [[nodiscard]] std::vector<JsonPlace> elements() const;  ///< of an array
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] double number() const;           ///< finite
  [[nodiscard]] Eigen::Vector3d vector() const;  ///< array of three numbers

private:
  [[nodiscard]] std::string where() const;  ///< 'FILE: at "POINTER"'

  const nlohmann::json* m_value;
  const JsonFile* m_file;
};

}  // namespace lumen::convert
