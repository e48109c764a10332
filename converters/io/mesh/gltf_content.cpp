// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/gltf_content.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/io/mesh/gltf_document.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"
#include "formats/container/printable.h"
#include "formats/json/base64.h"
#include "formats/json/json_document.h"
#include "formats/view/limits.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataUri = "data:", kBase64 = ";base64,";

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
  return loadNumber<std::uint32_t>(bytes.data() + at, Endian::Little);
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// Decodes escapes of RFC 3986: %20 is a space.
std::string percentDecoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool coded = uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 &&
                       hexDigit(uri[i + 2]) >= 0;
    text += coded ? static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])) : uri[i];
    if (coded) i += 2;
  }
  return text;
}

}  // namespace

GltfContent::GltfContent(std::string_view bytes, const InputFile& file)
    : m_file(file), m_name(formats::printable(file.path().string())), m_totalBytes(bytes.size()) {
  if (bytes.starts_with("glTF"))
    readChunks(bytes);
  else
    parseJson(bytes);
  if (!m_document || !root().isObject()) refuse("is no JSON object; expected glTF");
  const auto asset = root().find("asset");
  const std::string version = asset ? text(*asset, "version") : "";
  if (!version.starts_with("2."))
    throw unsupported(m_name + ": /asset/version is " + quotedText(version) +
                      "; lumen reads glTF 2.0, which Blender exports");
  readBuffers();
}

void GltfContent::readChunks(std::string_view bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader)
    refuse("has " + std::to_string(bytes.size()) + " bytes; expected at least 20 of a GLB");
  if (wordAt(bytes, 4) != 2)
    throw unsupported(m_name + ": byte 4: the version is " + std::to_string(wordAt(bytes, 4)) +
                      "; lumen reads GLB of version 2");
  bool isFirst = true;
  for (std::size_t at = kHeader; bytes.size() - at >= kChunkHeader;) {
    const std::uint32_t size = wordAt(bytes, at), type = wordAt(bytes, at + 4);
    const std::size_t left = bytes.size() - at - kChunkHeader;
    if (size > left)
      refuse("byte " + std::to_string(at) + ": a chunk has " + std::to_string(size) +
             " bytes; expected at most " + std::to_string(left) + ", which follow");
    const std::string_view chunk = bytes.substr(at + kChunkHeader, size);
    if (isFirst != (type == kJsonChunk))
      refuse("byte " + std::to_string(at + 4) +
             ": expected the first chunk, and no other, to be "
             "JSON");
    if (isFirst) parseJson(chunk);
    if (type == kBinaryChunk && m_binary.data() == nullptr) m_binary = chunk;
    isFirst = false;
    at += kChunkHeader + size;
  }
}

void GltfContent::parseJson(std::string_view text) {
  formats::IssueList issues(1);
  m_document = formats::parseJson(withoutByteOrderMark(text), 0, "", issues);
  if (m_document) return;
  const formats::Issue issue = *issues.firstError();
  if (issue.code == formats::ErrorCode::JsonDepth)
    refuse("its JSON is more than " + std::to_string(formats::kMaxJsonDepth) +
           " levels deep; expected fewer");
  refuse((issue.pointer ? "at \"" + formats::printable(*issue.pointer) + "\": " : "is no JSON: ") +
         formats::printable(issue.message));
}

void GltfContent::readBuffers() {
  readFiles();
  for (std::uint64_t b = 0; b < size("buffers"); ++b) {
    const Json buffer = item("buffers", b);
    const std::uint64_t bytes = whole(buffer, "byteLength", 0);
    if (b == 0 && m_binary.data() != nullptr && !buffer.find("uri")) {
      if (bytes > m_binary.size())
        refuse("/buffers/0/byteLength is " + std::to_string(bytes) + "; expected at most " +
               std::to_string(m_binary.size()) + ", the size of the binary chunk");
      m_buffers.push_back(m_binary.substr(0, static_cast<std::size_t>(bytes)));
      continue;
    }
    m_buffers.push_back(buffer.find("uri") ? bufferOf(buffer, bytes) : std::string_view());
  }
  for (const std::string& bytes : m_held) m_totalBytes += bytes.size();
  for (const auto& [file, bytes] : m_files) m_totalBytes += bytes.size();
}

std::string_view GltfContent::bufferOf(Json buffer, std::uint64_t size) {
  const std::string uri = text(buffer, "uri");
  if (!uri.starts_with(kDataUri))
    return std::string_view(m_files.at(detachedFile(uri))).substr(0, size);
  const std::string_view bytes = decodeDataUri(uri);
  if (bytes.size() < size)
    refuse("/buffers: byteLength is " + std::to_string(size) + "; expected at most " +
           std::to_string(bytes.size()) + ", which are there");
  return bytes;
}

std::string_view GltfContent::decodeDataUri(const std::string& uri) {
  const std::size_t from = uri.find(kBase64);
  const auto decoded =
      from == uri.npos ? std::nullopt
                       : formats::fromBase64(std::string_view(uri).substr(from + kBase64.size()));
  if (!decoded) refuse("/buffers: a data URI is no base64; expected \"data:...;base64,\"");
  return m_held.emplace_back(reinterpret_cast<const char*>(decoded->data()), decoded->size());
}

fs::path GltfContent::detachedFile(const std::string& uri) const {
  if (m_file.isInMemory())
    refuse("its data are in " + quotedText(uri) +
           "; expected them in the file, as it is in memory");
  const fs::path parent = m_file.path().parent_path();
  const fs::path stated = parent / fs::path(percentDecoded(uri));
  std::error_code error;
  const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent, error);
  const bool isName = !uri.empty() && uri.find("://") == uri.npos &&
                      percentDecoded(uri).find('\0') == std::string::npos;
  const fs::path file = isName && !error ? fs::canonical(stated, error) : fs::path();
  const bool within =
      !error && !file.empty() &&
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
  if (!within || !fs::is_regular_file(file, error))
    refuse("its data are in " + quotedText(uri) +
           ", which is no file of the same folder; expected one");
  return file;
}

void GltfContent::readFiles() {
  struct Part {
    std::string uri;
    std::uint64_t bytes = 0;  // largest extent that a buffer needs
  };
  std::map<fs::path, Part> parts;
  for (std::uint64_t b = 0; b < size("buffers"); ++b) {
    const Json buffer = item("buffers", b);
    const std::string uri = text(buffer, "uri");
    if (!buffer.find("uri") || uri.starts_with(kDataUri)) continue;
    Part& part = parts[detachedFile(uri)];
    part = {uri, std::max(part.bytes, whole(buffer, "byteLength", 0))};
  }
  for (const auto& [file, part] : parts) m_files[file] = readFileOfUri(file, part.uri, part.bytes);
}

std::string GltfContent::readFileOfUri(const fs::path& file, const std::string& uri,
                                       std::uint64_t size) const {
  std::error_code error;
  const std::uintmax_t there = fs::file_size(file, error);
  if (error || there < size)
    refuse("its data are in " + quotedText(uri) + ", which has " +
           std::to_string(error ? 0 : there) + " bytes; expected " + std::to_string(size));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!std::ifstream(file, std::ios::binary)
           .read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    refuse("its data are in " + quotedText(uri) + ", which cannot be read");
  return bytes;
}

std::uint64_t GltfContent::size(const char* list) const {
  const auto found = root().find(list);
  if (!found) return 0;
  if (!found->isArray()) refuse(std::string("/") + list + " is no array; expected one");
  return found->arraySize();
}

GltfContent::Json GltfContent::item(const char* list, std::uint64_t index) const {
  if (index >= size(list))
    refuse(std::string("/") + list + " has " + std::to_string(size(list)) +
           " items; found the number " + std::to_string(index));
  const Json found = (*root().find(list))[static_cast<std::size_t>(index)];
  if (!found.isObject())
    refuse(std::string("/") + list + "/" + std::to_string(index) + " is no object; expected one");
  return found;
}

std::uint64_t GltfContent::whole(Json object, const char* key, std::uint64_t otherwise) const {
  const auto found = object.find(key);
  if (!found) return otherwise;
  const auto number = found->number();
  const auto value = number ? number->asInteger<std::uint64_t>() : std::nullopt;
  if (!value)
    refuse(std::string(key) + " is " +
           (number ? number->shown() : std::string("no number: ") + found->kind()) +
           "; expected a whole number from 0 on");
  return *value;
}

std::string GltfContent::text(Json object, const char* key) {
  const auto found = object.find(key);
  return found && found->text() != nullptr ? *found->text() : std::string();
}

std::string_view GltfContent::view(std::uint64_t index) const {
  const Json json = item("bufferViews", index);
  const auto extensions = json.find("extensions");
  if (extensions && extensions->find("EXT_meshopt_compression"))
    throw unsupported(m_name +
                      ": it is packed by EXT_meshopt_compression, which lumen does not read; "
                      "unpack it, such as by gltf-transform copy");
  const std::uint64_t buffer = whole(json, "buffer", std::numeric_limits<std::uint64_t>::max());
  (void)item("buffers", buffer);
  const std::string_view bytes = m_buffers[static_cast<std::size_t>(buffer)];
  const std::uint64_t offset = whole(json, "byteOffset", 0), length = whole(json, "byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse("/bufferViews/" + std::to_string(index) + " has " + std::to_string(length) +
           " bytes from " + std::to_string(offset) + " on; expected an end within the " +
           std::to_string(bytes.size()) + " bytes of its buffer");
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

void GltfContent::refuse(const std::string& what) const {
  throw invalidInput(m_name + ": " + what);
}

}  // namespace lumen::convert
