// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "converters/base/error.h"
#include "converters/io/mesh/meshopt_codec.h"
#include "formats/json/base64.h"

namespace lumen::convert {

using nlohmann::json;

namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

std::size_t aligned(std::size_t size) {
  return (size + 3) / 4 * 4;
}

void checkSize(std::size_t size) {
  if (size > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw unsupported(
        "the mesh needs over 2 GiB of glTF buffer; expected less, such as draco makes it");
}

void putWord(std::string& out, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(word >> shift & 0xffU);
}

std::vector<unsigned char> bytesOf(const std::vector<std::uint32_t>& index, bool isShort) {
  const std::size_t size = isShort ? 2 : 4;
  std::vector<unsigned char> bytes;
  bytes.reserve(size * index.size());
  for (const std::uint32_t i : index)
    for (std::size_t b = 0; b < size; ++b)
      bytes.push_back(static_cast<unsigned char>(i >> (8 * b) & 0xffU));
  return bytes;
}

/// JSON text of a value; invalid UTF-8 is replaced.
std::string textOf(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

int GltfDocument::add(const char* list, json item) {
  json& items = content[list];
  items.push_back(std::move(item));
  return static_cast<int>(items.size()) - 1;
}

int GltfDocument::addView(std::span<const unsigned char> bytes, json view) {
  m_bytes.resize(aligned(m_bytes.size()));
  checkSize(m_bytes.size() + bytes.size());
  view["buffer"] = 0;
  view["byteOffset"] = m_bytes.size();
  view["byteLength"] = bytes.size();
  m_bytes.insert(m_bytes.end(), bytes.begin(), bytes.end());
  return add("bufferViews", std::move(view));
}

int GltfDocument::addCodedView(std::span<const unsigned char> coded, std::size_t size, json view,
                               json coding) {
  m_bytes.resize(aligned(m_bytes.size()));
  m_decodedSize = aligned(m_decodedSize);
  checkSize(std::max(m_bytes.size() + coded.size(), m_decodedSize + size));
  coding["buffer"] = 0;
  coding["byteOffset"] = m_bytes.size();
  coding["byteLength"] = coded.size();
  view["buffer"] = 1;
  view["byteOffset"] = m_decodedSize;
  view["byteLength"] = size;
  view["extensions"][kMeshopt] = std::move(coding);
  m_bytes.insert(m_bytes.end(), coded.begin(), coded.end());
  m_decodedSize += size;
  return add("bufferViews", std::move(view));
}

int GltfDocument::addVertices(VertexStream& stream) {
  json view = {{"byteStride", stream.stride}, {"target", kVertexTarget}};
  if (!m_meshopt) return addView(stream.bytes, std::move(view));
  const MeshoptStream coded = encodeVertices(stream);
  json coding = {{"byteStride", stream.stride},
                 {"count", stream.bytes.size() / stream.stride},
                 {"mode", "ATTRIBUTES"}};
  if (coded.isExponential) coding["filter"] = "EXPONENTIAL";
  return addCodedView(coded.bytes, stream.bytes.size(), std::move(view), std::move(coding));
}

int GltfDocument::addIndices(const std::vector<std::uint32_t>& index, std::size_t vertices,
                             bool isShort) {
  json view = {{"target", kIndexTarget}};
  if (!m_meshopt) return addView(bytesOf(index, isShort), std::move(view));
  const std::size_t size = isShort ? 2 : 4;
  json coding = {{"byteStride", size}, {"count", index.size()}, {"mode", "TRIANGLES"}};
  return addCodedView(encodeTriangles(index, vertices), size * index.size(), std::move(view),
                      std::move(coding));
}

int GltfDocument::addBytes(const std::vector<char>& bytes) {
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  return addView({first, bytes.size()}, json::object());
}

void GltfDocument::useExtension(const char* name, bool required) {
  const auto put = [&](const char* list) {
    const json& names = content[list];
    if (std::find(names.begin(), names.end(), name) == names.end()) content[list].push_back(name);
  };
  put("extensionsUsed");
  if (required) put("extensionsRequired");
}

std::string GltfDocument::write(bool binary) {
  m_bytes.resize(aligned(m_bytes.size()));
  if (!m_bytes.empty()) {
    json buffer = {{"byteLength", m_bytes.size()}};
    if (!binary)
      buffer["uri"] = "data:application/octet-stream;base64," +
                      formats::base64(std::as_bytes(std::span(m_bytes)));
    add("buffers", std::move(buffer));
  }
  if (m_decodedSize > 0) {
    useExtension(kMeshopt, true);
    json buffer = {{"byteLength", aligned(m_decodedSize)}};
    buffer["extensions"][kMeshopt]["fallback"] = true;
    add("buffers", std::move(buffer));
  }
  std::string text = textOf(content);
  if (!binary) return text;
  text.resize(aligned(text.size()), ' ');
  const std::size_t rest = m_bytes.empty() ? 0 : 8 + m_bytes.size();
  std::string out;
  out.reserve(20 + text.size() + rest);
  for (const std::size_t word : {std::size_t{kGlbMagic}, std::size_t{2}, 20 + text.size() + rest,
                                 text.size(), std::size_t{kJsonChunk}})
    putWord(out, static_cast<std::uint32_t>(word));
  out += text;
  if (m_bytes.empty()) return out;
  putWord(out, static_cast<std::uint32_t>(m_bytes.size()));
  putWord(out, kBinaryChunk);
  out.append(reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size());
  return out;
}

}  // namespace lumen::convert
