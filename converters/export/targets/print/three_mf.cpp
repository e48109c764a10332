// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/print/three_mf.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/export/shared/text_files.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "formats/case/vessel_system.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace {

void appendFloat(std::string& text, float value) {
  formats::appendNumber(text, value == 0 ? 0.0F : value);  // without a sign of zero
}

/// A material for each system of vessels, by its value.
std::string materials() {
  std::string text = "<basematerials id=\"2\">\n";
  for (std::size_t i = 0; i < formats::kVesselSystemCount; ++i) {
    const auto system = static_cast<formats::VesselSystem>(i);
    text += "<base name=\"" + systemName(system) + "\" displaycolor=\"" + systemColorHex(system) +
            "\"/>\n";
  }
  return text + "</basematerials>\n";
}

std::string modelText(const SurfaceMesh& mesh, const std::string& name) {
  std::string vertices, triangles;
  for (const Float3& p : mesh.position) {
    vertices += "<vertex x=\"";
    appendFloat(vertices, p[0]);
    vertices += "\" y=\"";
    appendFloat(vertices, p[1]);
    vertices += "\" z=\"";
    appendFloat(vertices, p[2]);
    vertices += "\"/>\n";
  }
  const std::vector<formats::VesselSystem> systems = triangleSystems(mesh);
  for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
    const Triangle& t = mesh.triangle[f];
    triangles += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) +
                 "\" v3=\"" + std::to_string(t[2]) + "\"";
    if (!systems.empty())
      triangles += " pid=\"2\" p1=\"" + std::to_string(static_cast<int>(systems[f])) + "\"";
    triangles += "/>\n";
  }
  return exportText("print/3dmodel.model",
                    {{"version", LUMEN_VERSION},
                     {"name", name},
                     {"materials", systems.empty() ? "" : materials()},
                     {"material", systems.empty() ? "" : " pid=\"2\" pindex=\"0\""},
                     {"vertices", std::move(vertices)},
                     {"triangles", std::move(triangles)}});
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
  zip.add("[Content_Types].xml", exportText("print/content_types.xml"));
  zip.add("_rels/.rels", exportText("print/relationships.xml"));
  zip.add("3D/3dmodel.model", modelText(mesh, name));
  return zip.bytes();
}

}  // namespace lumen::convert
