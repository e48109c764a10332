// SPDX-License-Identifier: Apache-2.0
// What an operation was asked for with, checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/engine/report.h"
#include "converters/io/seeds/seeds.h"

namespace lumen::viewer {

using app::Json;

/// The members of a JSON object. Each call throws Error(Usage) with a sentence for people if the member
/// is missing, or is no such value.
class Arguments {
public:
  explicit Arguments(const Json& object);

  [[nodiscard]] bool has(const char* name) const;  ///< and it is not null
  [[nodiscard]] std::uint32_t index(const char* name, std::size_t count) const;
  [[nodiscard]] std::int64_t whole(const char* name) const;
  [[nodiscard]] double number(const char* name) const;
  [[nodiscard]] std::string text(const char* name) const;  ///< at most 255 bytes
  [[nodiscard]] std::string text(const char* name, const std::string& otherwise) const;
  [[nodiscard]] bool flag(const char* name) const;                 ///< false if it is missing
  [[nodiscard]] Eigen::Vector3d position(const char* name) const;  ///< finite
  [[nodiscard]] std::vector<std::string> texts(const char* name) const;
  [[nodiscard]] std::vector<convert::SeedPoint> points(const char* name) const;  ///< one to 1000

private:
  [[nodiscard]] const Json& at(const char* name) const;

  const Json& m_object;
};

/// JSON of at most `mostBytes` and eight levels. Throws Error(Usage).
Json parseRequest(const std::string& text, std::size_t mostBytes);

}  // namespace lumen::viewer
