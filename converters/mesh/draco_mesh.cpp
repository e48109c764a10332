// SPDX-License-Identifier: Apache-2.0
#include "converters/mesh/draco_mesh.h"

#include <memory>
#include <string>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include "converters/common/error.h"

namespace lumen::convert {
namespace {

int addAttribute(draco::Mesh& target, draco::GeometryAttribute::Type type, std::uint32_t vertices) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
  return target.AddAttribute(attribute, true, vertices);
}

struct DracoInput {
  draco::Mesh mesh;
  int position = 0, normal = 0;  // attribute indices
};

void fill(const BranchMesh& mesh, DracoInput& input) {
  const auto vertices = static_cast<std::uint32_t>(mesh.position.size());
  input.mesh.set_num_points(vertices);
  input.position = addAttribute(input.mesh, draco::GeometryAttribute::POSITION, vertices);
  input.normal = addAttribute(input.mesh, draco::GeometryAttribute::NORMAL, vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const draco::AttributeValueIndex at(v);
    input.mesh.attribute(input.position)->SetAttributeValue(at, mesh.position[v].data());
    input.mesh.attribute(input.normal)->SetAttributeValue(at, mesh.normal[v].data());
  }
  input.mesh.SetNumFaces(mesh.triangle.size());
  for (std::uint32_t f = 0; f < mesh.triangle.size(); ++f) {
    draco::Mesh::Face face;
    for (std::size_t i = 0; i < 3; ++i) face[i] = draco::PointIndex(mesh.triangle[f][i]);
    input.mesh.SetFace(draco::FaceIndex(f), face);
  }
}

void checkBits(int bits, int least, const char* what) {
  if (bits >= least && bits <= 30) return;
  throw Error(ErrorKind::Usage, std::string("Draco ") + what + " bits: found " +
                                    std::to_string(bits) + ", expected " + std::to_string(least) +
                                    " to 30");
}

// What a viewer will see: quantisation moves positions.
void measureDecoded(DracoMesh& coded) {
  draco::DecoderBuffer buffer;
  buffer.Init(coded.bytes.data(), coded.bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw failed("Draco cannot read back a mesh: " + decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  const auto* position = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(coded.positionId));
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

DracoMesh encodeDraco(const BranchMesh& mesh, const WriteMeshOptions& options) {
  checkBits(options.dracoPositionBits, 1, "position");
  checkBits(options.dracoNormalBits, 2, "normal");
  DracoInput input;
  fill(mesh, input);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, options.dracoPositionBits);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, options.dracoNormalBits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(input.mesh, &buffer);
  if (!status.ok()) throw failed("Draco cannot code a mesh: " + status.error_msg_string());
  DracoMesh coded;
  coded.bytes.assign(buffer.data(), buffer.data() + buffer.size());
  coded.positionId = static_cast<int>(input.mesh.attribute(input.position)->unique_id());
  coded.normalId = static_cast<int>(input.mesh.attribute(input.normal)->unique_id());
  measureDecoded(coded);
  return coded;
}

}  // namespace lumen::convert
