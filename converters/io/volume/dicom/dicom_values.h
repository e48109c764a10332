// SPDX-License-Identifier: Apache-2.0
// The values of a DICOM data set by their tags, without those of its sequences.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/io/volume/dicom/dicom_elements.h"
#include "formats/container/printable.h"

namespace lumen::convert {

using DicomValues = std::map<DicomTag, std::string>;

/// Adds the value of an element. Throws Error(InvalidInput) for one that occurs twice, and for values of
/// more than 4096 bytes: a text is at most 64 characters long and a list of numbers a few hundred.
inline void addDicomValue(DicomBytes& bytes, const DicomElement& element, DicomValues& values) {
  constexpr std::uint64_t kMaxValue = 1 << 12;
  if (element.value.length > kMaxValue)
    throw invalidInput(tagText(element.tag) + " has " + std::to_string(element.value.length) +
                       " bytes; expected a number or a short text");
  std::string text(element.value.length, '\0');
  bytes.read(element.value.at, std::as_writable_bytes(std::span(text)));
  if (!values.emplace(element.tag, std::move(text)).second)
    throw invalidInput(tagText(element.tag) + " occurs twice; expected one value");
}

/// Types of values: texts, unsigned numbers of two or four bytes, floats of eight.
enum class DicomType { Text, Whole, Float };

/// Reads numbers of one data set, with messages that name the element.
class DicomReader {
public:
  DicomReader(const DicomValues& values, bool bigEndian)
      : m_values(values), m_bigEndian(bigEndian) {}

  [[nodiscard]] std::string text(DicomTag tag) const {
    const auto found = m_values.find(tag);
    return found == m_values.end() ? std::string() : trimmedText(found->second);
  }

  /// An unsigned number of two bytes.
  [[nodiscard]] std::size_t word(DicomTag tag, const char* name,
                                 std::optional<std::size_t> otherwise = std::nullopt) const {
    const auto found = m_values.find(tag);
    if (found == m_values.end() && otherwise) return *otherwise;
    if (found == m_values.end() || found->second.size() != 2)
      throw invalidInput(std::string(name) + " " + tagText(tag) +
                         (found == m_values.end() ? " is missing" : " is not of two bytes") +
                         "; expected one number");
    return static_cast<std::size_t>(whole(found->second));
  }

  /// A stored value of two bytes; empty where the element is missing or has another length.
  [[nodiscard]] std::optional<double> level(DicomTag tag, bool isSigned) const {
    const auto found = m_values.find(tag);
    if (found == m_values.end() || found->second.size() != 2) return std::nullopt;
    const auto stored = static_cast<std::uint16_t>(whole(found->second));
    return isSigned ? static_cast<double>(static_cast<std::int16_t>(stored))
                    : static_cast<double>(stored);
  }

  /// Decimal numbers; empty where the element is missing or empty.
  template <std::size_t N>
  [[nodiscard]] std::optional<std::array<double, N>> decimals(DicomTag tag,
                                                              const char* name) const {
    const std::string value = text(tag);
    if (value.empty()) return std::nullopt;
    const std::vector<double> numbers = parseNumbers(value);
    if (numbers.size() != N)
      throw invalidInput("its " + std::string(name) + " " + tagText(tag) + " is \"" +
                         formats::printable(value) + "\"; expected " + std::to_string(N) +
                         (N == 1 ? " number" : " numbers"));
    std::array<double, N> result{};
    std::copy(numbers.begin(), numbers.end(), result.begin());
    return result;
  }
  [[nodiscard]] std::optional<double> decimal(DicomTag tag, const char* name) const {
    const auto value = decimals<1>(tag, name);
    return value ? std::optional((*value)[0]) : std::nullopt;
  }

  /// A value as text, whatever its type; empty where it is missing or has another length than that.
  [[nodiscard]] std::string shown(DicomTag tag, DicomType type) const {
    if (type == DicomType::Text) return text(tag);
    const auto found = m_values.find(tag);
    if (found == m_values.end()) return {};
    const std::string& bytes = found->second;
    if (type == DicomType::Whole)
      return bytes.size() == 2 || bytes.size() == 4 ? std::to_string(whole(bytes)) : std::string();
    if (bytes.size() != sizeof(double)) return {};
    const auto value = std::bit_cast<double>(whole(bytes));
    return std::isfinite(value) ? shownNumber(value, 12) : std::string();
  }

private:
  [[nodiscard]] std::uint64_t whole(const std::string& bytes) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      value =
          value << 8U | static_cast<unsigned char>(bytes[m_bigEndian ? i : bytes.size() - 1 - i]);
    return value;
  }

  const DicomValues& m_values;
  bool m_bigEndian;
};

}  // namespace lumen::convert
