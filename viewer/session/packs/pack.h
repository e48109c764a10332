// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers and their descriptions, in one run of bytes (viewer/README.md, "Packs").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "formats/case/case.h"

namespace lumen::viewer {

using engine::Json;

enum class NumberType : std::uint8_t { F32, U8, U16, U32, I32 };

template <class T>
constexpr NumberType numberType() {
  if constexpr (std::is_same_v<T, float>) return NumberType::F32;
  if constexpr (std::is_same_v<T, std::uint8_t>) return NumberType::U8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return NumberType::U16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return NumberType::U32;
  return NumberType::I32;
}

/// Gathers the members of a pack. Arrays are copied.
class PackWriter {
public:
  /// A member of the JSON beside the arrays.
  void set(const std::string& name, Json value) { m_members[name] = std::move(value); }

  /// An array with that shape, rows first; the product of `shape` is the number of values.
  template <class T>
  void add(const std::string& name, std::span<const T> values, std::vector<std::size_t> shape) {
    append(name, numberType<T>(), std::move(shape), std::as_bytes(values));
  }
  template <class T>
  void add(const std::string& name, const std::vector<T>& values) {
    add(name, std::span<const T>(values), {values.size()});
  }
  void add(const std::string& name, std::span<const formats::Vec3f> values);
  void add(const std::string& name, std::span<const std::array<float, 3>> values);
  void add(const std::string& name, std::span<const std::array<std::uint32_t, 3>> values);
  void add(const std::string& name, std::span<const std::array<std::uint32_t, 2>> values);

  /// An array whose bytes are coded according to `description`, which gets its offset.
  void addStored(const std::string& name, std::string_view bytes, Json description);

  /// The whole pack.
  [[nodiscard]] std::string bytes() const;

  /// The bytes before an array that is sent by itself, whose bytes follow; its values are the last
  /// of the pack.
  [[nodiscard]] std::string bytesBefore(const std::string& name, NumberType type,
                                        const std::vector<std::size_t>& shape) const;

private:
  void append(const std::string& name, NumberType type, std::vector<std::size_t> shape,
              std::span<const std::byte> bytes);
  [[nodiscard]] std::string withHeader(const Json& members) const;

  Json m_members = Json::object();
  Json m_arrays = Json::object();
  std::string m_body;
};

/// Bytes with a name: `tag` differs where the bytes do. Null `bytes`: there is no such part.
struct Tagged {
  std::string tag;
  std::shared_ptr<const std::string> bytes;
};

inline Tagged tagged(std::string tag, std::string bytes) {
  return {std::move(tag), std::make_shared<const std::string>(std::move(bytes))};
}

}  // namespace lumen::viewer
