// SPDX-License-Identifier: Apache-2.0
// VTK's XML format. VTK itself is too heavy to link for one writer.
#include "converters/mesh/write_vtp.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <zlib.h>

#include "converters/common/error.h"
#include "converters/mesh/face_kind.h"
#include "converters/mesh/plain_names.h"
#include "formats/case/base64.h"

namespace lumen::convert {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");

// Bytes that are compressed together; VTK's readers inflate a block at a time.
constexpr std::size_t kBlock = std::size_t{1} << 20;

using Bytes = std::span<const std::byte>;

std::vector<std::byte> deflated(Bytes block) {
  uLongf size = compressBound(block.size());
  std::vector<std::byte> out(size);
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(block.data()), block.size(),
                Z_DEFAULT_COMPRESSION) != Z_OK)
    throw failed("zlib could not compress a block of the mesh");
  out.resize(size);
  return out;
}

// What VTK calls binary: the number of blocks, their size, that of the last if it is another, and
// the compressed size of each; then the blocks.
std::string coded(Bytes data) {
  const std::size_t blocks = (data.size() + kBlock - 1) / kBlock;
  std::vector<std::uint64_t> header{blocks, kBlock, data.size() % kBlock};
  std::vector<std::byte> body;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * kBlock;
    const std::vector<std::byte> block =
        deflated(data.subspan(first, std::min(kBlock, data.size() - first)));
    header.push_back(block.size());
    body.insert(body.end(), block.begin(), block.end());
  }
  return formats::base64(std::as_bytes(std::span(header))) + formats::base64(body);
}

std::string element(const std::string& attributes, Bytes data) {
  return "<DataArray " + attributes + " format=\"binary\">" + coded(data) + "</DataArray>\n";
}

template <class T>
std::string dataArray(const char* type, const char* name, std::size_t components,
                      const std::vector<T>& values) {
  return element(std::string("type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                     std::to_string(components) + "\"",
                 std::as_bytes(std::span(values)));
}

// Each text ends with a zero; zeros within become spaces.
std::string textArray(const char* name, const std::vector<std::string>& texts) {
  std::string bytes;
  for (std::string text : texts) {
    std::replace(text.begin(), text.end(), '\0', ' ');
    bytes += text + '\0';
  }
  return element(std::string("type=\"String\" Name=\"") + name + "\" NumberOfTuples=\"" +
                     std::to_string(texts.size()) + "\"",
                 std::as_bytes(std::span(bytes)));
}

std::string fieldData(const SurfaceMesh& surface, const std::string& unit) {
  std::vector<std::string> kinds;
  for (const FaceGroup& group : surface.groups) kinds.emplace_back(faceKindName(group.kind));
  return "<FieldData>\n" + textArray("GroupNames", namesOf(surface.groups)) +
         textArray("GroupKinds", kinds) + textArray("BranchLabels", surface.labels) +
         textArray("Unit", {unit}) + textArray("SPACE", {"LPS"}) +
         textArray("Generator", {"lumen " LUMEN_VERSION}) + "</FieldData>\n";
}

std::string pointData(const SurfaceMesh& surface) {
  const std::vector<std::int32_t> branch(surface.branch.begin(), surface.branch.end());
  std::string out = "<PointData Scalars=\"Radius\" Normals=\"Normals\">\n" +
                    dataArray("Float32", "Normals", 3, surface.normal) +
                    dataArray("Float32", "Radius", 1, surface.radius) +
                    dataArray("Int32", "Branch", 1, branch);
  if (!surface.confidence.empty()) out += dataArray("Float32", "Confidence", 1, surface.confidence);
  return out + "</PointData>\n";
}

std::string cellData(const SurfaceMesh& surface) {
  std::vector<std::int32_t> number;
  number.reserve(surface.group.size());
  for (const std::uint32_t group : surface.group)
    number.push_back(static_cast<std::int32_t>(group) + 1);
  return "<CellData Scalars=\"ModelFaceID\">\n" + dataArray("Int32", "ModelFaceID", 1, number) +
         dataArray("Int32", "CellEntityIds", 1, number) + "</CellData>\n";
}

std::string polygons(const SurfaceMesh& surface) {
  std::vector<std::int64_t> corner, end;
  corner.reserve(3 * surface.triangle.size());
  end.reserve(surface.triangle.size());
  for (const Triangle& t : surface.triangle) {
    corner.insert(corner.end(), t.begin(), t.end());
    end.push_back(static_cast<std::int64_t>(corner.size()));
  }
  return "<Polys>\n" + dataArray("Int64", "connectivity", 1, corner) +
         dataArray("Int64", "offsets", 1, end) + "</Polys>\n";
}

}  // namespace

std::string encodeVtp(const SurfaceMesh& surface) {
  return encodeVtpIn(surface, "mm");
}

std::string encodeVtpIn(const SurfaceMesh& surface, const std::string& unit) {
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n" +
         fieldData(surface, unit) + "<Piece NumberOfPoints=\"" +
         std::to_string(surface.position.size()) +
         "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(surface.triangle.size()) + "\">\n" + pointData(surface) +
         cellData(surface) + "<Points>\n" + dataArray("Float32", "Points", 3, surface.position) +
         "</Points>\n" + polygons(surface) + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace lumen::convert
