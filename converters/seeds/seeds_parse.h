// SPDX-License-Identifier: Apache-2.0
// Reading seeds from JSON. Private to the sources of seeds.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "converters/seeds/seeds.h"

namespace lumen::convert {

/// Parses text; throws Error(InvalidInput), naming `file`, for what is not JSON, an object with one
/// key twice, or a nesting deeper than any seeds file needs.
nlohmann::json parseJson(const std::string& text, const std::filesystem::path& file);

/// A JSON value, and where it is. Every accessor throws Error(InvalidInput) with the file, the JSON
/// pointer (RFC 6901), what was found and what was expected.
class JsonPlace {
public:
  JsonPlace(const nlohmann::json& value, std::string file, std::string pointer = {})
      : m_value(&value), m_file(std::move(file)), m_pointer(std::move(pointer)) {}

  [[nodiscard]] const nlohmann::json& value() const { return *m_value; }
  [[nodiscard]] const std::string& file() const { return m_file; }
  [[noreturn]] void refuse(const std::string& expected) const;

  /// Refuses an object with another key than these, and anything but an object.
  void onlyKeys(std::initializer_list<const char*> keys) const;
  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] JsonPlace at(const std::string& key) const;  ///< refuses if there is none
  [[nodiscard]] std::vector<JsonPlace> elements() const;     ///< of an array
  [[nodiscard]] std::string text() const;
  [[nodiscard]] double number() const;           ///< finite
  [[nodiscard]] Eigen::Vector3d vector() const;  ///< array of three numbers

private:
  const nlohmann::json* m_value;
  std::string m_file, m_pointer;
};

/// From a file's coordinates to LPS millimetres.
struct SeedFrame {
  double scale = 1;  ///< mm in the file's unit
  bool ras = false;  ///< x and y change sign
  [[nodiscard]] Eigen::Vector3d direction(const Eigen::Vector3d& v) const {
    return ras ? Eigen::Vector3d(-v.x(), -v.y(), v.z()) : v;
  }
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& v) const {
    return scale * direction(v);
  }
};

/// Millimetres in the unit that `unit` names: "mm" or "m".
double scaleOf(const JsonPlace& unit);

/// "vessel" or "aneurysm"; nothing for another word.
std::optional<formats::BranchKind> branchKind(const std::string& word);

}  // namespace lumen::convert
