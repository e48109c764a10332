// SPDX-License-Identifier: Apache-2.0
// By CGAL, which is GPL: for tests and measurements alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "converters/geometry/self_intersections.h"
#include "converters/geometry/triangle_quality.h"
#include "tests/evaluation/reproduce/surface_facts.h"

namespace lumen::reproduce {
namespace {

namespace Pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh cgalMesh(const convert::TriangleMesh& mesh) {
  Mesh target;
  for (const Eigen::Vector3d& p : mesh.position) target.add_vertex({p.x(), p.y(), p.z()});
  for (const convert::Triangle& t : mesh.triangle)
    target.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
  return target;
}

// V - E + F of each part, and whether each encloses a positive volume.
void measureParts(const Mesh& mesh, ShapeFacts& facts) {
  const auto part =
      const_cast<Mesh&>(mesh).add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
  const std::size_t parts = Pmp::connected_components(mesh, part);
  facts.euler.assign(parts, 0);
  std::vector<double> volume(parts, 0);
  for (const Mesh::Vertex_index v : mesh.vertices())
    if (!mesh.is_isolated(v))
      ++facts.euler[part[*mesh.faces_around_target(mesh.halfedge(v)).begin()]];
  for (const Mesh::Edge_index e : mesh.edges()) {
    const auto h = mesh.halfedge(e);
    --facts.euler[part[mesh.face(mesh.is_border(h) ? mesh.opposite(h) : h)]];
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    ++facts.euler[part[f]];
    std::array<Kernel::Point_3, 3> p;
    std::size_t i = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
      p[i++] = mesh.point(v);
    volume[part[f]] += CGAL::volume(Kernel::Point_3(0, 0, 0), p[0], p[1], p[2]);
  }
  facts.outward = facts.closed && std::ranges::all_of(volume, [](double v) { return v > 0; });
  std::ranges::sort(facts.euler);
}

}  // namespace

ShapeFacts measureShape(const convert::TriangleMesh& mesh) {
  ShapeFacts facts;
  const convert::TriangleQuality quality = convert::triangleQuality(mesh);
  facts.medianAngle = quality.medianAngle;
  facts.leastAngle = quality.leastAngle;
  facts.intersections = convert::selfIntersections(mesh).pairs.size();
  std::vector<std::vector<std::size_t>> polygons;
  for (const convert::Triangle& t : mesh.triangle) polygons.push_back({t[0], t[1], t[2]});
  facts.isMesh = Pmp::is_polygon_soup_a_polygon_mesh(polygons);
  if (!facts.isMesh) return facts;
  const Mesh target = cgalMesh(mesh);
  facts.closed = CGAL::is_closed(target);
  measureParts(target, facts);
  facts.volume = CGAL::to_double(Pmp::volume(target));
  facts.area = CGAL::to_double(Pmp::area(target));
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  Pmp::self_intersections(target, std::back_inserter(found));
  facts.cgalIntersections = found.size();
  return facts;
}

}  // namespace lumen::reproduce
