// SPDX-License-Identifier: Apache-2.0
// The JSON and the bytes of a glTF file, whether GLB or text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/input_file.h"
#include "formats/json/json_value.h"

namespace lumen::convert {

/// A glTF file. Each value is checked on access. All functions throw Error(InvalidInput) with the
/// file, the JSON pointer, the finding and the expectation.
class GltfContent {
public:
  using Json = formats::JsonValue;

  /// GLB or text. Buffers are inside, or files of the same folder unless `file` is in memory: no
  /// other file is opened.
  GltfContent(std::string_view bytes, const InputFile& file);

  [[nodiscard]] Json root() const { return m_document->root(); }
  [[nodiscard]] const std::string& name() const { return m_name; }
  /// The bytes of the file and of its buffers; a file that many buffers name counts once.
  [[nodiscard]] std::size_t totalBytes() const { return m_totalBytes; }

  /// Item `index` of the list `list` of the root, an object.
  [[nodiscard]] Json item(const char* list, std::uint64_t index) const;
  [[nodiscard]] std::uint64_t size(const char* list) const;
  /// The whole number `key` of `object`, or `otherwise` if it is absent.
  [[nodiscard]] std::uint64_t whole(Json object, const char* key, std::uint64_t otherwise) const;
  /// The text `key` of `object`, or none.
  [[nodiscard]] static std::string text(Json object, const char* key);
  /// The bytes of a buffer view.
  [[nodiscard]] std::string_view view(std::uint64_t index) const;

  [[noreturn]] void refuse(const std::string& what) const;

private:
  void readChunks(std::string_view bytes);
  void parseJson(std::string_view text);
  void readBuffers();
  [[nodiscard]] std::string_view bufferOf(Json buffer, std::uint64_t size);
  [[nodiscard]] std::string_view decodeDataUri(const std::string& uri);
  // Reads each detached file once, up to the largest extent that a buffer needs.
  void readFiles();
  [[nodiscard]] std::filesystem::path detachedFile(const std::string& uri) const;
  [[nodiscard]] std::string readFileOfUri(const std::filesystem::path& file, const std::string& uri,
                                          std::uint64_t size) const;

  InputFile m_file;
  std::string m_name;
  std::optional<formats::JsonDocument> m_document;
  std::string_view m_binary;       // binary chunk of a GLB
  std::deque<std::string> m_held;  // bytes of data URIs
  // Bytes of detached files by canonical path
  std::map<std::filesystem::path, std::string> m_files;
  std::vector<std::string_view> m_buffers;
  std::size_t m_totalBytes = 0;
};

}  // namespace lumen::convert
