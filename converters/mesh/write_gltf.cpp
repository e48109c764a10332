// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 through tinygltf, and KHR_draco_mesh_compression through Draco.
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include "converters/mesh/write_gltf.h"

#include <cstring>
#include <limits>
#include <sstream>

#include <tiny_gltf.h>

#include "converters/common/error.h"
#include "converters/mesh/draco_mesh.h"

namespace lumen::convert {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// Appends `bytes`, four-byte aligned, as a view; gives its index.
int addView(tinygltf::Model& model, const void* bytes, std::size_t size, int target) {
  std::vector<unsigned char>& data = model.buffers[0].data;
  data.resize((data.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = size;
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(bytes);
  data.insert(data.end(), first, first + size);
  if (data.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw unsupported("the mesh needs over 2 GiB of glTF buffer; expected less: try --draco");
  model.bufferViews.push_back(std::move(view));
  return static_cast<int>(model.bufferViews.size()) - 1;
}

int addAccessor(tinygltf::Model& model, int view, int componentType, int type, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.componentType = componentType;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size()) - 1;
}

template <class Index>
int addIndices(tinygltf::Model& model, const std::vector<std::uint32_t>& index, int componentType) {
  const std::vector<Index> packed(index.begin(), index.end());
  const int view = addView(model, packed.data(), packed.size() * sizeof(Index),
                           TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  return addAccessor(model, view, componentType, TINYGLTF_TYPE_SCALAR, packed.size());
}

int addVectors(tinygltf::Model& model, const std::vector<Float3>& vectors) {
  const int view =
      addView(model, vectors.data(), vectors.size() * sizeof(Float3), TINYGLTF_TARGET_ARRAY_BUFFER);
  return addAccessor(model, view, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                     vectors.size());
}

void setBounds(tinygltf::Accessor& accessor, const Float3& low, const Float3& high) {
  accessor.minValues.assign(low.begin(), low.end());
  accessor.maxValues.assign(high.begin(), high.end());
}

// Index 65535 is the primitive restart value of 16-bit indices, which glTF forbids.
constexpr std::size_t kMaxShortVertices = 65535;

tinygltf::Primitive plainPrimitive(tinygltf::Model& model, const BranchMesh& mesh) {
  std::vector<std::uint32_t> index;
  index.reserve(3 * mesh.triangle.size());
  for (const Triangle& t : mesh.triangle) index.insert(index.end(), t.begin(), t.end());
  Float3 low = mesh.position.front(), high = low;
  for (const Float3& p : mesh.position) extendBox(p, low, high);
  tinygltf::Primitive primitive;
  primitive.attributes["POSITION"] = addVectors(model, mesh.position);
  setBounds(model.accessors.back(), low, high);
  primitive.attributes["NORMAL"] = addVectors(model, mesh.normal);
  primitive.indices =
      mesh.position.size() <= kMaxShortVertices
          ? addIndices<std::uint16_t>(model, index, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
          : addIndices<std::uint32_t>(model, index, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  return primitive;
}

tinygltf::Primitive dracoPrimitive(tinygltf::Model& model, const BranchMesh& mesh,
                                   const WriteMeshOptions& options) {
  const DracoMesh coded = encodeDraco(mesh, options);
  constexpr int kNoView = -1, kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;
  tinygltf::Primitive primitive;
  const int position = addAccessor(model, kNoView, kFloat, TINYGLTF_TYPE_VEC3, coded.vertices);
  setBounds(model.accessors.back(), coded.low, coded.high);
  primitive.attributes["POSITION"] = position;
  primitive.attributes["NORMAL"] =
      addAccessor(model, kNoView, kFloat, TINYGLTF_TYPE_VEC3, coded.vertices);
  const bool isShort = coded.vertices <= kMaxShortVertices;
  primitive.indices = addAccessor(
      model, kNoView,
      isShort ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
      TINYGLTF_TYPE_SCALAR, 3 * coded.triangles);
  const int view = addView(model, coded.bytes.data(), coded.bytes.size(), 0);
  tinygltf::Value::Object attributes, extension;
  attributes["POSITION"] = tinygltf::Value(coded.positionId);
  attributes["NORMAL"] = tinygltf::Value(coded.normalId);
  extension["bufferView"] = tinygltf::Value(view);
  extension["attributes"] = tinygltf::Value(attributes);
  primitive.extensions[kDracoExtension] = tinygltf::Value(extension);
  return primitive;
}

tinygltf::Material wallMaterial() {
  tinygltf::Material material;
  material.name = "vessel wall";
  material.pbrMetallicRoughness.baseColorFactor = {0.5, 0.05, 0.05, 1.0};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.6;
  material.doubleSided = true;  // the ends are open, and the inside of the wall shows
  return material;
}

tinygltf::Node rootNode() {
  tinygltf::Node root;
  root.name = "LPS_mm_to_glTF_m";
  root.matrix.assign(kGltfFromLps.begin(), kGltfFromLps.end());
  tinygltf::Value::Object frame;
  frame["frame"] = tinygltf::Value(std::string("LPS: +x left, +y posterior, +z superior"));
  frame["unit"] = tinygltf::Value(std::string("mm"));
  frame["matrix"] =
      tinygltf::Value(std::string("to glTF: metres, +x left, +y superior, +z anterior; apply its "
                                  "inverse to come back to LPS mm"));
  root.extras = tinygltf::Value(frame);
  return root;
}

tinygltf::Model emptyModel(bool draco) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "lumen " LUMEN_VERSION;
  model.nodes.push_back(rootNode());
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;
  model.buffers.resize(1);
  if (draco) {
    model.extensionsUsed = {kDracoExtension};
    model.extensionsRequired = {kDracoExtension};
  }
  return model;
}

}  // namespace

std::string encodeGltf(const std::vector<BranchMesh>& meshes, bool binary,
                       const WriteMeshOptions& options) {
  const auto hasFaces = [](const BranchMesh& branch) { return !branch.triangle.empty(); };
  const bool any = std::any_of(meshes.begin(), meshes.end(), hasFaces);
  tinygltf::Model model = emptyModel(options.draco && any);
  for (const BranchMesh& branch : meshes) {
    if (!hasFaces(branch)) continue;
    tinygltf::Primitive primitive =
        options.draco ? dracoPrimitive(model, branch, options) : plainPrimitive(model, branch);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    tinygltf::Mesh mesh;
    mesh.name = branch.label;
    mesh.primitives.push_back(std::move(primitive));
    tinygltf::Node node;
    node.name = branch.label;
    node.mesh = static_cast<int>(model.meshes.size());
    model.meshes.push_back(std::move(mesh));
    model.nodes[0].children.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
  }
  if (any) model.materials.push_back(wallMaterial());
  if (!any) model.buffers.clear();
  std::ostringstream stream;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, !binary, binary))
    throw failed("tinygltf could not write the scene");
  return std::move(stream).str();
}

}  // namespace lumen::convert
