// SPDX-License-Identifier: Apache-2.0
// Declared in vtk_xml.h.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/io/vtk/vtk_xml.h"

namespace lumen {
namespace {

// deflate packs at most 258 bytes into two bits, and its streams have a few bytes of overhead
constexpr std::uint64_t kMostPerPackedByte = 1032;

bool isSpace(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

/// The bytes of a text, raw or as base64. Writers end a run of base64 by padding after a header, or
/// continue it: both are read, as each group of four stands for itself.
class VtkBytes {
public:
  VtkBytes(std::string_view text, bool base64) : m_rest(text), m_base64(base64) {}

  /// The next `size` bytes, or fewer if there are no more.
  std::string read(std::uint64_t size) {
    if (!m_base64) {
      const auto taken = static_cast<std::size_t>(std::min<std::uint64_t>(size, m_rest.size()));
      std::string bytes(m_rest.substr(0, taken));
      m_rest.remove_prefix(taken);
      return bytes;
    }
    std::string bytes;
    bytes.reserve(std::min<std::uint64_t>(size, mostLeft()));
    while (bytes.size() < size && (m_at < m_held || group())) bytes += m_group[m_at++];
    return bytes;
  }
  [[nodiscard]] std::uint64_t mostLeft() const {
    return m_base64 ? m_rest.size() / 4 * 3 + 3 : m_rest.size();
  }

private:
  bool group() {
    std::uint32_t bits = 0;
    int digits = 0;
    int ends = 0;
    while (digits + ends < 4) {
      while (!m_rest.empty() && isSpace(m_rest.front())) m_rest.remove_prefix(1);
      if (m_rest.empty()) return false;
      const int digit = base64Digit(m_rest.front());
      if (digit >= 0 && ends == 0)
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
      else if (m_rest.front() == '=' && digits >= 2)
        bits <<= 6;
      else
        return false;
      ++(digit >= 0 ? digits : ends);
      m_rest.remove_prefix(1);
    }
    m_group = {static_cast<char>(bits >> 16 & 255), static_cast<char>(bits >> 8 & 255),
               static_cast<char>(bits & 255)};
    m_at = 0;
    m_held = static_cast<std::size_t>(digits - 1);
    return true;
  }

  std::string_view m_rest;
  bool m_base64;
  std::array<char, 3> m_group{};
  std::size_t m_at = 0, m_held = 0;
};

class VtkDecoder {
public:
  VtkDecoder(const VtkEncodedArray& array, const VtkPacking& packing)
      : m_array(array), m_packing(packing), m_bytes(array.text, array.form == VtkForm::Base64) {}

  std::string bytes(std::uint64_t expected) {
    if (m_packing.zlib) return unpacked(expected);
    const std::uint64_t stated = headers(1)[0];
    if (stated != expected) refuseSize(stated, expected);
    if (expected > m_bytes.mostLeft()) refuse("ends before its data do");
    std::string data = m_bytes.read(expected);
    if (data.size() < expected) refuse("ends before its data do");
    return data;
  }

  /// The announced number of bytes; consumes its header.
  std::uint64_t size() {
    const std::uint64_t first = headers(1)[0];
    if (!m_packing.zlib) return first;
    if (first > 1) return std::numeric_limits<std::uint64_t>::max();  // blocks: never short
    const std::vector<std::uint64_t> sizes = headers(2);
    return first == 0 ? 0 : sizes[1] != 0 ? sizes[1] : sizes[0];
  }

  std::vector<double> ascii(std::uint64_t count) const {
    std::vector<double> values;
    // a number takes a digit and a separator
    values.reserve(std::min<std::uint64_t>(count, m_array.text.size() / 2 + 1));
    for (std::string_view rest = m_array.text;;) {
      while (!rest.empty() && isSpace(rest.front())) rest.remove_prefix(1);
      if (rest.empty()) break;
      const auto end = std::find_if(rest.begin(), rest.end(), isSpace);
      const std::string_view word = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
      rest.remove_prefix(word.size());
      if (values.size() == count)
        refuse("has more than the " + std::to_string(count) + " numbers expected");
      values.push_back(numberOf(word));
    }
    if (values.size() < count)
      refuse("has " + std::to_string(values.size()) + " numbers; expected " +
             std::to_string(count));
    return values;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw invalidInput(m_array.where + " " + what);
  }

private:
  [[noreturn]] void refuseSize(std::uint64_t stated, std::uint64_t expected) const {
    refuse("states a size of " + std::to_string(stated) + " bytes; expected " +
           std::to_string(expected));
  }

  [[nodiscard]] double numberOf(std::string_view word) const {
    const auto value = parsedNumber(word);
    if (!value) refuse("has " + convert::quotedText(std::string(word)) + "; expected a number");
    return *value;
  }

  std::vector<std::uint64_t> headers(std::uint64_t count) {
    const std::uint64_t size = count * m_packing.headerBytes;
    if (size > m_bytes.mostLeft()) refuse("ends within the sizes that stand before its data");
    const std::string raw = m_bytes.read(size);
    if (raw.size() < size) refuse("ends within the sizes that stand before its data");
    std::vector<std::uint64_t> values;
    for (std::size_t at = 0; at < raw.size(); at += m_packing.headerBytes) {
      std::uint64_t value = 0;
      for (unsigned b = 0; b < m_packing.headerBytes; ++b) {
        const unsigned place = m_packing.bigEndian ? b : m_packing.headerBytes - 1 - b;
        value = value << 8 | static_cast<unsigned char>(raw[at + place]);
      }
      values.push_back(value);
    }
    return values;
  }

  std::string unpacked(std::uint64_t expected) {
    const std::vector<std::uint64_t> head = headers(1);
    const std::uint64_t blocks = head[0];
    if (blocks == 0 && expected == 0) return {};
    const std::vector<std::uint64_t> sizes = headers(2);
    if (blocks > m_bytes.mostLeft() / m_packing.headerBytes)
      refuse("states " + std::to_string(blocks) + " blocks, more than its bytes can hold");
    const std::uint64_t full = blocks - (sizes[1] != 0 ? 1 : 0);
    if ((full > 0 && sizes[0] > expected / full) || sizes[1] > expected ||
        full * sizes[0] + sizes[1] != expected)
      refuse("states " + std::to_string(blocks) + " blocks of " + std::to_string(sizes[0]) +
             " bytes, the last of " + std::to_string(sizes[1]) + "; expected " +
             std::to_string(expected) + " bytes");
    const std::vector<std::uint64_t> packed = headers(blocks);
    std::string data;
    for (std::size_t b = 0; b < packed.size(); ++b)
      unpack(packed[b], b < full ? sizes[0] : sizes[1], data);
    return data;
  }

  void unpack(std::uint64_t packedSize, std::uint64_t size, std::string& data) {
    if (packedSize > m_bytes.mostLeft()) refuse("ends before its data do");
    if (size / kMostPerPackedByte > packedSize)
      refuse("states that " + std::to_string(packedSize) + " bytes unpack to " +
             std::to_string(size) + ", more than zlib can pack");
    const std::string packed = m_bytes.read(packedSize);
    if (packed.size() < packedSize) refuse("ends before its data do");
    const std::size_t before = data.size();
    data.resize(before + static_cast<std::size_t>(size));
    auto got = static_cast<uLongf>(size);
    const int status = uncompress(reinterpret_cast<Bytef*>(data.data() + before), &got,
                                  reinterpret_cast<const Bytef*>(packed.data()),
                                  static_cast<uLong>(packed.size()));
    if (status != Z_OK || got != size) refuse("has data that zlib cannot unpack");
  }

  const VtkEncodedArray& m_array;
  const VtkPacking& m_packing;
  VtkBytes m_bytes;
};

template <class Number>
std::vector<double> decodeNumbers(VtkDecoder& decoder, const VtkPacking& packing,
                                  std::uint64_t count) {
  if (count > std::numeric_limits<std::size_t>::max() / sizeof(Number))
    decoder.refuse("cannot have " + std::to_string(count) + " numbers");
  const std::string bytes = decoder.bytes(count * sizeof(Number));
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Number)) {
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), bytes.data() + at, raw.size());
    if (packing.bigEndian) std::reverse(raw.begin(), raw.end());
    Number value;
    std::memcpy(&value, raw.data(), raw.size());
    values.push_back(static_cast<double>(value));
  }
  return values;
}

}  // namespace

std::vector<double> decodeVtkNumbers(const VtkEncodedArray& array, const VtkPacking& packing,
                                     std::uint64_t count) {
  VtkDecoder decoder(array, packing);
  if (array.form == VtkForm::Ascii) return decoder.ascii(count);
  if (array.type == "Float32") return decodeNumbers<float>(decoder, packing, count);
  if (array.type == "Float64") return decodeNumbers<double>(decoder, packing, count);
  if (array.type == "Int64") return decodeNumbers<std::int64_t>(decoder, packing, count);
  if (array.type == "Int32") return decodeNumbers<std::int32_t>(decoder, packing, count);
  if (array.type == "Int16") return decodeNumbers<std::int16_t>(decoder, packing, count);
  if (array.type == "Int8") return decodeNumbers<std::int8_t>(decoder, packing, count);
  if (array.type == "UInt64") return decodeNumbers<std::uint64_t>(decoder, packing, count);
  if (array.type == "UInt32") return decodeNumbers<std::uint32_t>(decoder, packing, count);
  if (array.type == "UInt16") return decodeNumbers<std::uint16_t>(decoder, packing, count);
  if (array.type == "UInt8") return decodeNumbers<std::uint8_t>(decoder, packing, count);
  decoder.refuse("is of the type " + convert::quotedText(std::string(array.type)) +
                 "; expected Int8 to Int64, UInt8 to UInt64, Float32 or Float64");
}

std::string decodeVtkText(const VtkEncodedArray& array, const VtkPacking& packing,
                          std::uint64_t most) {
  std::string text;
  if (array.form == VtkForm::Ascii) {
    if (array.text.size() > 16 * most) return {};
    const std::string_view digits = array.text;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < digits.size(); ++i)
      count += !isSpace(digits[i]) && (i == 0 || isSpace(digits[i - 1])) ? 1 : 0;
    for (const double code : VtkDecoder(array, packing).ascii(count))
      text += code >= 1 && code < 128 ? static_cast<char>(code) : '\0';
  } else {
    const std::uint64_t size = VtkDecoder(array, packing).size();
    if (size > most) return {};
    text = VtkDecoder(array, packing).bytes(size);
  }
  return text.substr(0, text.find('\0'));
}

}  // namespace lumen
