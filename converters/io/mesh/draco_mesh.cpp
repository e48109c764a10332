// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/draco_mesh.h"

#include <cstdint>
#include <memory>
#include <string>

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include "converters/base/error.h"
#include "converters/io/mesh/mesh_parts.h"

namespace lumen::convert {
namespace {

// Quantisation bits of radii and confidences over their range.
constexpr int kValueBits = 12;

draco::GeometryAttribute::Type typeOf(const VertexStream& stream) {
  if (stream.name == "POSITION") return draco::GeometryAttribute::POSITION;
  if (stream.name == "NORMAL") return draco::GeometryAttribute::NORMAL;
  if (stream.name == "COLOR_0") return draco::GeometryAttribute::COLOR;
  return draco::GeometryAttribute::GENERIC;
}

// Adds an attribute; returns its index.
int addAttribute(draco::Mesh& target, const DracoPart& part, const VertexStream& stream) {
  const bool isFloat = stream.componentType == kFloat;
  const auto components = static_cast<std::uint8_t>(stream.components);
  draco::GeometryAttribute attribute;
  attribute.Init(typeOf(stream), nullptr, components,
                 isFloat ? draco::DT_FLOAT32 : draco::DT_UINT16, stream.isNormalized,
                 components * (isFloat ? 4 : 2), 0);
  const int index = target.AddAttribute(attribute, true, static_cast<std::uint32_t>(part.count));
  for (std::uint32_t v = 0; v < part.count; ++v)
    target.attribute(index)->SetAttributeValue(
        draco::AttributeValueIndex(v), stream.bytes.data() + (part.first + v) * stream.stride);
  return index;
}

void addFaces(draco::Mesh& target, std::span<const Triangle> triangles) {
  target.SetNumFaces(triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    draco::Mesh::Face face;
    for (std::size_t i = 0; i < 3; ++i) face[i] = draco::PointIndex(triangles[f][i]);
    target.SetFace(draco::FaceIndex(f), face);
  }
}

void checkBits(int bits, int least, const char* what) {
  if (bits >= least && bits <= 30) return;
  throw Error(ErrorKind::Usage, std::string("Draco ") + what + " bits: found " +
                                    std::to_string(bits) + ", expected " + std::to_string(least) +
                                    " to 30");
}

// The box of the positions after quantisation, which moves them.
void measureDecoded(DracoMesh& coded) {
  draco::DecoderBuffer buffer;
  buffer.Init(coded.bytes.data(), coded.bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw failed("Draco cannot read back a mesh: " + decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  const auto* position = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(coded.id.front()));
  coded.vertices = mesh->num_points();
  coded.triangles = mesh->num_faces();
  for (draco::PointIndex i(0); i < mesh->num_points(); ++i) {
    Float3 p;
    position->GetMappedValue(i, p.data());
    if (i == 0U) coded.low = coded.high = p;
    extendBox(p, coded.low, coded.high);
  }
}

}  // namespace

DracoMesh encodeDraco(const DracoPart& part, const DracoGrid& grid,
                      const WriteMeshOptions& options) {
  checkBits(options.dracoPositionBits, 1, "position");
  checkBits(options.dracoNormalBits, 2, "normal");
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(part.count));
  addFaces(mesh, part.triangle);
  std::vector<int> index;
  for (const VertexStream& stream : part.streams) index.push_back(addAttribute(mesh, part, stream));
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  for (std::size_t s = 0; s < index.size(); ++s) {
    const VertexStream& stream = part.streams[s];
    if (stream.name == "POSITION")
      encoder.SetAttributeExplicitQuantization(index[s], options.dracoPositionBits, 3,
                                               grid.origin.data(), grid.range);
    else if (stream.componentType == kFloat)
      encoder.SetAttributeQuantization(
          index[s], stream.name == "NORMAL" ? options.dracoNormalBits : kValueBits);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) throw failed("Draco cannot code a mesh: " + status.error_msg_string());
  DracoMesh coded;
  coded.bytes.assign(buffer.data(), buffer.data() + buffer.size());
  for (const int i : index) coded.id.push_back(static_cast<int>(mesh.attribute(i)->unique_id()));
  measureDecoded(coded);
  return coded;
}

}  // namespace lumen::convert
