// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/print/three_mf.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <zlib.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

constexpr const char* kTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
    "</Types>\n";
constexpr const char* kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

void appendFloat(std::string& text, float value) {
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value == 0 ? 0.0F : value);
  text.append(digits.data(), end.ptr);
}

std::string modelOf(const SurfaceMesh& mesh, const std::string& name) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
      "<metadata name=\"Application\">lumen " LUMEN_VERSION
      "</metadata>\n<resources>\n<object id=\"1\" "
      "type=\"model\" name=\"";
  text += name;
  text += "\">\n<mesh>\n<vertices>\n";
  for (const Float3& p : mesh.position) {
    text += "<vertex x=\"";
    appendFloat(text, p[0]);
    text += "\" y=\"";
    appendFloat(text, p[1]);
    text += "\" z=\"";
    appendFloat(text, p[2]);
    text += "\"/>\n";
  }
  text += "</vertices>\n<triangles>\n";
  for (const Triangle& t : mesh.triangle)
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) +
            "\" v3=\"" + std::to_string(t[2]) + "\"/>\n";
  return text +
         "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item "
         "objectid=\"1\"/>\n</build>\n</model>\n";
}

void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::string deflated(const std::string& raw) {
  z_stream stream{};
  // raw deflate, as zip has it
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw failed("zlib could not begin to compress");
  std::string out(deflateBound(&stream, static_cast<uLong>(raw.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(raw.data()));
  stream.avail_in = static_cast<uInt>(raw.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw failed("zlib could not compress a file of 3MF");
  return out;
}

/// PKWARE's zip: local headers, then the directory. No times: 1980-01-01.
class Zip {
public:
  void add(const std::string& name, const std::string& raw) {
    if (raw.size() >= UINT32_MAX || m_bytes.size() >= UINT32_MAX / 2)
      throw unsupported("3MF: the mesh is too large for a zip without its 64-bit extension");
    const std::string packed = deflated(raw);
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(raw.data()), static_cast<uInt>(raw.size())));
    const auto offset = static_cast<std::uint32_t>(m_bytes.size());
    std::string common;
    put(common, 20, 2);               // version needed: 2.0
    put(common, 0, 2);                // flags
    put(common, 8, 2);                // deflate
    put(common, 0, 2);                // time
    put(common, (1U << 5U) | 1U, 2);  // date: 1980-01-01
    put(common, crc, 4);
    put(common, static_cast<std::uint32_t>(packed.size()), 4);
    put(common, static_cast<std::uint32_t>(raw.size()), 4);
    put(common, static_cast<std::uint32_t>(name.size()), 2);
    put(common, 0, 2);  // no extra field
    put(m_bytes, 0x04034b50, 4);
    m_bytes += common + name + packed;
    put(m_directory, 0x02014b50, 4);
    put(m_directory, 20, 2);  // version made by
    m_directory += common;
    put(m_directory, 0, 2);  // no comment
    put(m_directory, 0, 2);  // disk
    put(m_directory, 0, 2);  // internal attributes
    put(m_directory, 0, 4);  // external attributes
    put(m_directory, offset, 4);
    m_directory += name;
    ++m_count;
  }

  [[nodiscard]] std::string bytes() const {
    std::string end;
    put(end, 0x06054b50, 4);
    put(end, 0, 4);  // disks
    put(end, m_count, 2);
    put(end, m_count, 2);
    put(end, static_cast<std::uint32_t>(m_directory.size()), 4);
    put(end, static_cast<std::uint32_t>(m_bytes.size()), 4);
    put(end, 0, 2);  // no comment
    return m_bytes + m_directory + end;
  }

private:
  std::string m_bytes, m_directory;
  std::uint32_t m_count = 0;
};

}  // namespace

std::string encode3mf(const SurfaceMesh& mesh, const std::string& name) {
  Zip zip;
  zip.add("[Content_Types].xml", kTypes);
  zip.add("_rels/.rels", kRelations);
  zip.add("3D/3dmodel.model", modelOf(mesh, name));
  return zip.bytes();
}

}  // namespace lumen::convert
