// SPDX-License-Identifier: Apache-2.0
// Writes the files that the glTF validator and VTK look at: mesh_samples DIRECTORY
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "capped_tube.h"
#include "converters/io/mesh/write_gltf.h"
#include "converters/io/mesh/write_plain.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "synthetic.h"

namespace {

using namespace lumen;
using convert::encodeGltf;
using convert::SurfaceMesh;

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

SurfaceMesh patchesOf(const formats::Case& source, double cell = 0) {
  Progress progress;
  return convert::polygonise(source, {cell}, progress).surface;
}

// Lets all nodes but the first turn about z, by their place along it, and grow.
void bend(formats::Case& source) {
  formats::Motion& motion = source.motion.emplace();
  motion.time = {-0.25, 0.5};
  motion.period = 1;
  for (int t = 0; t < 2; ++t)
    for (std::uint32_t i = 1; i < source.tree.nodeCount(); ++i) {
      const float angle = 0.05F * static_cast<float>(t) * source.tree.centre[i].z;
      formats::Pose pose{source.tree.centre[i],
                         {0, 0, std::sin(angle / 2), std::cos(angle / 2)},
                         1 + 0.1F * static_cast<float>(t)};
      pose.centre.y += angle;
      if (t == 0) motion.node.push_back(i);
      motion.pose.push_back(pose);
    }
}

void writeGltfs(const std::filesystem::path& folder) {
  formats::Case source = test::tubeCase(6);
  test::addVessel(source, "c\u00f4t\u00e9 \"B\"", test::straightPath({3, 1.3, 0}, {0.1, 0.7, 0}, 5),
                  0.6, 1.2, 3);
  test::addModels(source);
  const std::array tree{patchesOf(source), patchesOf(source, 0.4), patchesOf(source, 0.8)};
  const std::array fine{patchesOf(test::sphereCase(1.0, 0.43), 0.015)};
  // More vertices than 16-bit indices reach.
  if (fine[0].position.size() <= 65536) throw std::runtime_error("the fine sphere is too coarse");
  const std::array closed{test::cappedTube(test::hostileLabels())};
  const std::array<SurfaceMesh, 1> empty{};
  bend(source);
  const std::vector<SurfaceMesh> moving(tree.begin(), tree.end());
  const convert::MeshSkin skin = convert::skinOf(source, moving);
  using enum convert::MeshPer;
  using convert::ColorBy;
  for (const std::string coding : {"plain", "draco", "meshopt"}) {
    convert::WriteMeshOptions options;
    options.draco = coding == "draco";
    options.meshopt = coding == "meshopt";
    const auto both = [&](const std::string& name, std::span<const SurfaceMesh> levels) {
      write(folder / (name + "_" + coding + ".glb"), encodeGltf(levels, true, options));
      write(folder / (name + "_" + coding + ".gltf"), encodeGltf(levels, false, options));
    };
    both("tree", std::span(tree).first(1));
    write(folder / ("moving_" + coding + ".glb"), encodeGltf(moving, true, options, &skin));
    write(folder / ("moving_" + coding + ".gltf"), encodeGltf(moving, false, options, &skin));
    both("fine", fine);
    both("empty", empty);
    both("closed", closed);
    options.color = ColorBy::Confidence;
    both("confidence", closed);
    options.color = ColorBy::Radius;
    both("lod", tree);
    options.color = ColorBy::Branch;
    options.per = Branch;
    both("lod_per_branch", tree);
  }
}

void writeOthers(const std::filesystem::path& folder, const std::string& name,
                 const SurfaceMesh& surface) {
  write(folder / (name + ".vtp"), convert::encodeVtp(surface));
  write(folder / (name + ".obj"), convert::encodeObj(surface));
  write(folder / (name + ".ply"), convert::encodePly(surface));
  write(folder / (name + ".stl"), convert::encodeStl(surface, false));
  write(folder / (name + "_solids.stl"), convert::encodeStl(surface, true));
  nlohmann::json truth;
  truth["position"] = surface.position;
  truth["normal"] = surface.normal;
  truth["radius"] = surface.radius;
  truth["confidence"] = surface.confidence;
  truth["branch"] = surface.branch;
  truth["triangle"] = surface.triangle;
  truth["group"] = surface.group;
  truth["labels"] = surface.labels;
  truth["groups"] = nlohmann::json::array();
  for (const auto& group : surface.groups) truth["groups"].push_back(group.name);
  write(folder / (name + ".json"), truth.dump());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder(argv[1]);
  try {
    std::filesystem::create_directories(folder);
    writeGltfs(folder);
    writeOthers(folder, "closed", test::cappedTube(test::hostileLabels()));
    // over a megabyte of positions: several blocks of VTP
    writeOthers(folder, "many", test::cappedTube({"a", "b"}, 300, 300));
    writeOthers(folder, "empty", {});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
