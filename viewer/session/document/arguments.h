// SPDX-License-Identifier: Apache-2.0
// Arguments of a request, checked, and a request that came too late.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/io/seeds/seeds.h"
#include "formats/json/json_place.h"

namespace lumen::viewer {

using engine::Json;

/// Throws Error(Usage), whose sentence the page shows.
[[noreturn]] void refuse(const std::string& sentence);

/// The members of a JSON object, whose document must outlive it. Each call throws Error(Usage) with
/// a sentence for people for a missing member, and for a value of another kind.
class Arguments {
public:
  explicit Arguments(formats::JsonValue object);

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
  [[nodiscard]] formats::JsonPlace at(const char* name) const;

  formats::JsonPlace m_object;
};

/// Strict JSON of at most `mostBytes`. Throws Error(Usage).
formats::JsonDocument parseRequest(const std::string& text, std::size_t mostBytes);

/// The request was legal when the page made it. The server answers it with 409, a job ends with its
/// sentence.
class Conflict : public Error {
public:
  explicit Conflict(const std::string& sentence) : Error(ErrorKind::Usage, sentence) {}
};

}  // namespace lumen::viewer
