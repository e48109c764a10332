// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/print/three_mf.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "converters/export/shared/text_files.h"
#include "converters/export/shared/zip_archive.h"
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

}  // namespace

std::string encode3mf(const SurfaceMesh& mesh, const std::string& name) {
  ZipArchive zip;
  zip.add("[Content_Types].xml", exportText("print/content_types.xml"));
  zip.add("_rels/.rels", exportText("print/relationships.xml"));
  zip.add("3D/3dmodel.model", modelText(mesh, name));
  return zip.bytes();
}

}  // namespace lumen::convert
