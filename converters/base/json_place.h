// SPDX-License-Identifier: Apache-2.0
// JSON files of other programs; reading stops at the first fault.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/error.h"
#include "formats/json/json_place.h"

namespace lumen::convert {

/// A JSON file that was read; must outlive the places in it. Faults are thrown as
/// Error(InvalidInput) with the name, the JSON pointer, what was found and what was expected.
class JsonFile final : public formats::JsonFaults {
public:
  /// Throws for a text that is not strict JSON, an object with one key twice, and a nesting of more
  /// than 64 levels.
  JsonFile(std::string_view text, const std::filesystem::path& file);

  [[nodiscard]] formats::JsonValue root() const { return m_document.root(); }
  /// FILE: at "POINTER"
  [[nodiscard]] std::string place(const std::string& pointer) const;
  [[nodiscard]] Error fault(const std::string& pointer, formats::JsonValue found,
                            const std::string& expected) const;

  void wrongType(std::string pointer, formats::JsonValue found,
                 const std::string& expected) override;
  void outOfRange(std::string pointer, formats::JsonNumber found,
                  const std::string& expected) override;
  void missingKey(std::string objectPointer, std::string_view key) override;

private:
  std::string m_name;
  formats::JsonDocument m_document;
};

/// A JSON value in its file. Every accessor throws as JsonFile does.
class JsonPlace {
public:
  explicit JsonPlace(JsonFile& file) : m_place(file.root(), file), m_file(&file) {}

  [[nodiscard]] const formats::JsonValue& value() const { return m_place.value(); }
  [[noreturn]] void refuse(const std::string& expected) const;

  /// Refuses an object with a key beyond these, and any value but an object.
  void onlyKeys(std::initializer_list<const char*> keys) const;
  [[nodiscard]] bool has(const char* key) const { return m_place.find(key).has_value(); }
  [[nodiscard]] JsonPlace at(std::string_view key) const;  ///< refuses a missing key
  [[nodiscard]] std::vector<JsonPlace> elements() const;   ///< elements of an array
  [[nodiscard]] const std::string& text() const { return *m_place.text(); }
  [[nodiscard]] bool boolean() const { return m_place.boolean("true or false"); }
  [[nodiscard]] double number() const { return m_place.real(); }  ///< finite
  [[nodiscard]] Eigen::Vector3d vector() const;                   ///< array of three numbers

private:
  JsonPlace(formats::JsonPlace place, const JsonFile& file)
      : m_place(std::move(place)), m_file(&file) {}

  formats::JsonPlace m_place;
  const JsonFile* m_file;
};

}  // namespace lumen::convert
