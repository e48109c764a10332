// SPDX-License-Identifier: Apache-2.0
// Meshes, which are also repaired, and scenes of SOFA.
#include <span>
#include <string_view>

#include "converters/base/error.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/mesh/sofa_scene.h"
#include "converters/stages/repair/mesh_report.h"
#include "converters/stages/repair/repair.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz.h"

namespace lumen::fuzz {
namespace {

using namespace lumen::convert;

// Repair takes the time that it needs; the readers are what is tried.
constexpr std::size_t kMostRepaired = 2000;

void checkFile(const MeshFile& file) {
  const TriangleMesh& mesh = file.mesh;
  expect(!mesh.triangle.empty(), "a mesh has a triangle");
  for (const Eigen::Vector3d& p : mesh.position)
    expect(p.cwiseAbs().maxCoeff() <= 1e12, "coordinates are finite and bounded");
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) expect(v < mesh.position.size(), "indices are in range");
  expect(file.groups.empty() ? file.group.empty() : file.group.size() == mesh.triangle.size(),
         "each triangle has a group where there are groups");
  for (const std::uint32_t g : file.group) expect(g < file.groups.size(), "groups are in range");
  for (const std::string& note : file.notes)
    expect(formats::printable(note) == note, "notes are fit to print");
}

void checkRepaired(const TriangleMesh& mesh) {
  const MeshReport report = diagnoseMesh(mesh, Progress());
  expect(report.triangles == mesh.triangle.size(), "a diagnosis is of all triangles");
  const RepairResult repaired = repairMesh(mesh, "mesh", Progress());
  expect(repaired.source.size() == repaired.mesh.triangle.size(), "each triangle has a source");
  for (const std::uint32_t source : repaired.source)
    expect(source == RepairResult::kFilled || source < mesh.triangle.size(), "sources are there");
  const std::vector<Triangle>& triangle = repaired.mesh.triangle;
  forEachEdge(edgeUses(triangle), [&](std::span<const EdgeUse> edge) {
    expect(edge.size() <= 2, "no edge has more than two triangles");
    expect(edge.size() == 1 || startOf(triangle, edge[0].side) != startOf(triangle, edge[1].side),
           "neighbours agree");
  });
}

template <MeshFormat kFormat>
void mesh(std::span<const std::byte> input) {
  try {
    const MeshFile file = readMesh({"mesh", textOf(input)}, kFormat);
    checkFile(file);
    if (file.mesh.triangle.size() <= kMostRepaired) checkRepaired(file.mesh);
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput || error.kind() == ErrorKind::Unsupported,
           "a bad file is invalid or unsupported input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
}

/// Scenes of SOFA: which meshes they load, and where they put them.
void scene(std::span<const std::byte> input) {
  try {
    const auto loaders = sofaLoaders(textOf(input), "scene");
    for (const SofaLoader& loader : loaders)
      expect(loader.toScene.matrix().allFinite(), "what a loader does is finite");
    const SofaLoader& vessels = vesselLoader(loaders, "", "scene");
    expect(&vessels >= loaders.data() && &vessels < loaders.data() + loaders.size(),
           "the vessels' loader is one of the scene's");
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput || error.kind() == ErrorKind::Unsupported,
           "a bad scene is invalid or unsupported input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
}

constexpr Target kTargets[] = {
    {"stl", mesh<MeshFormat::Stl>},   {"dicom_surface", mesh<MeshFormat::DicomSurface>},
    {"obj", mesh<MeshFormat::Obj>},   {"ply", mesh<MeshFormat::Ply>},
    {"gltf", mesh<MeshFormat::Gltf>}, {"vtp", mesh<MeshFormat::Vtp>},
    {"vtk", mesh<MeshFormat::Vtk>},   {"scene", scene}};

}  // namespace

std::span<const Target> meshTargets() {
  return kTargets;
}

}  // namespace lumen::fuzz
