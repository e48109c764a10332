// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/packs/pack.h"

#include <bit>
#include <cstring>
#include <utility>

namespace lumen::viewer {

static_assert(std::endian::native == std::endian::little,
              "packs are written as they lie in memory");

namespace {

constexpr std::size_t kAlignment = 8;  // the reader's typed arrays lie on multiples of their size

constexpr std::array<std::string_view, 5> kTypeNames = {"f32", "u8", "u16", "u32", "i32"};

Json describe(NumberType type, const std::vector<std::size_t>& shape, std::size_t offset) {
  return {
      {"type", kTypeNames[static_cast<std::size_t>(type)]}, {"shape", shape}, {"offset", offset}};
}

}  // namespace

void PackWriter::add(const std::string& name, std::span<const formats::Vec3f> values) {
  append(name, NumberType::F32, {values.size(), 3}, std::as_bytes(values));
}

void PackWriter::add(const std::string& name, std::span<const std::array<float, 3>> values) {
  append(name, NumberType::F32, {values.size(), 3}, std::as_bytes(values));
}

void PackWriter::add(const std::string& name,
                     std::span<const std::array<std::uint32_t, 3>> values) {
  append(name, NumberType::U32, {values.size(), 3}, std::as_bytes(values));
}

void PackWriter::add(const std::string& name,
                     std::span<const std::array<std::uint32_t, 2>> values) {
  append(name, NumberType::U32, {values.size(), 2}, std::as_bytes(values));
}

void PackWriter::append(const std::string& name, NumberType type, std::vector<std::size_t> shape,
                        std::span<const std::byte> bytes) {
  m_body.append((kAlignment - m_body.size() % kAlignment) % kAlignment, '\0');
  m_arrays[name] = describe(type, shape, m_body.size());
  if (!bytes.empty()) m_body.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void PackWriter::addStored(const std::string& name, std::string_view bytes, Json description) {
  m_body.append((kAlignment - m_body.size() % kAlignment) % kAlignment, '\0');
  description["offset"] = m_body.size();
  m_arrays[name] = std::move(description);
  m_body.append(bytes);
}

std::string PackWriter::withHeader(const Json& members) const {
  // the readers of files refuse text that is not UTF-8; names of dropped files have not passed them
  std::string json = members.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.append((kAlignment - (4 + json.size()) % kAlignment) % kAlignment, ' ');
  const auto size = static_cast<std::uint32_t>(json.size());
  std::string text(4, '\0');
  std::memcpy(text.data(), &size, 4);
  text.reserve(4 + json.size() + m_body.size() + kAlignment);
  return text.append(json).append(m_body);
}

std::string PackWriter::bytes() const {
  Json members = m_members;
  members["arrays"] = m_arrays;
  return withHeader(members);
}

std::string PackWriter::bytesBefore(const std::string& name, NumberType type,
                                    const std::vector<std::size_t>& shape) const {
  const std::size_t padding = (kAlignment - m_body.size() % kAlignment) % kAlignment;
  Json members = m_members;
  members["arrays"] = m_arrays;
  members["arrays"][name] = describe(type, shape, m_body.size() + padding);
  return withHeader(members).append(padding, '\0');
}

}  // namespace lumen::viewer
