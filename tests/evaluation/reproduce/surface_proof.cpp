// SPDX-License-Identifier: Apache-2.0
// Facts of the surface in a file, beside the case that it was made of, as one JSON object.
#include <cstdio>
#include <exception>
#include <string>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "tests/evaluation/reproduce/surface_facts.h"

namespace {

using Json = nlohmann::ordered_json;
using namespace lumen;

Json placeOf(const reproduce::Farthest& at, const formats::Case& source) {
  return {{"radii", at.radii},
          {"place", {at.place.x(), at.place.y(), at.place.z()}},
          {"node", at.node},
          {"branch", source.tree.branches[source.tree.branch[at.node]].label}};
}

Json factsOf(const formats::Case& source, const std::string& file, double gap) {
  const reproduce::WrittenSurface surface = reproduce::readSurface(file);
  const field::BlendedField blended = formats::caseField(source);
  const convert::SeparatedField field(source, blended, {gap, 0, 0});
  const reproduce::ShapeFacts shape = reproduce::measureShape(surface.mesh);
  const reproduce::FieldFacts off = reproduce::distanceFrom(field, surface);
  const reproduce::EndFacts ends = reproduce::measureEnds(source, surface);
  return {{"triangles", surface.mesh.triangle.size()},
          {"closed", shape.closed},
          {"manifold", shape.isMesh},
          {"outward", shape.outward},
          {"euler", shape.euler},
          {"euler_of_trees", reproduce::eulerOfTrees(source)},
          {"links", source.tree.links.size()},
          {"volume_mm3", shape.volume},
          {"area_mm2", shape.area},
          {"intersections", shape.intersections},
          {"cgal_intersections", shape.cgalIntersections},
          {"median_angle", shape.medianAngle},
          {"least_angle", shape.leastAngle},
          {"vertices", off.vertices},
          {"vertices_far", off.verticesFar},
          {"vertex", placeOf(off.vertex, source)},
          {"middle", placeOf(off.middle, source)},
          {"field", placeOf(off.field, source)},
          {"rays", off.rays},
          {"ends", ends.groups},
          {"flat_ends", ends.flat},
          {"tilt", ends.tilt}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: lumen_surface_proof CASE SURFACE.vtp GAP_MM\n", stderr);
    return 2;
  }
  try {
    const auto source = formats::readCaseFile(argv[1]);
    if (!source || !source->models)
      throw invalidInput(std::string(argv[1]) + " is no case with models");
    std::puts(factsOf(*source, argv[2], std::stod(argv[3])).dump(1).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lumen_surface_proof: %s\n", error.what());
    return 1;
  }
  return 0;
}
