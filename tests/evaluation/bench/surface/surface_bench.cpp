// SPDX-License-Identifier: Apache-2.0
// Processor time of the stages of a case's surface. One argument: the case.
#include <ctime>
#include <cstdio>
#include <string>
#include <algorithm>
#include <cmath>
#include <vector>

#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/extract.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/simplify/collapse_edges.h"
#include "converters/stages/surface/simplify/split_edges.h"
#include "converters/geometry/self_intersections.h"
#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "formats/case/topology.h"

namespace {
using namespace lumen;
double now() { return double(std::clock()) / CLOCKS_PER_SEC; }
struct Timed : Progress {
  std::string name; double t = 0;
  void begin(std::string_view stage, std::size_t total) override { name = stage; t = now(); n = total; }
  void end() override { std::printf("  %-16s %8zu  %.2f s\n", name.c_str(), n, now() - t); }
  std::size_t n = 0;
};
}
int main(int argc, char** argv) {
  const auto read = formats::readCaseFile(argv[1]);
  const formats::Case& c = *read;
  Timed progress;
  for (int i = 2; i < argc; ++i) {
    const double share = std::stod(argv[i]);
    double t = now();
    const auto blended = formats::caseField(c);
    std::printf("field %.2f s\n", now() - t); t = now();
    convert::SeparatedField field(c, blended, {.gap = 0.1});
    std::printf("separated %.2f s\n", now() - t); t = now();
    convert::ExtractionReport report;
    auto s = convert::extractSurface(field, share, report, progress);
    std::printf("share %g: %.2f s, %zu triangles, cuts %zu opened %zu\n", share, now() - t, s.mesh.triangle.size(), report.cuts.size(), report.openedEdges);
    t = now();
    const auto pairs = convert::selfIntersections(s.mesh, 1000, &progress).pairs.size();
    std::printf("crossings %zu %.2f s\n", pairs, now() - t);
    t = now();
    const auto ends = convert::cutEnds(s, field, progress);
    std::printf("ends %zu %.2f s\n", ends.flat, now() - t); t = now();
    { std::vector<double> e; for (std::size_t v = 0; v < s.mesh.position.size(); ++v) { auto q = field.at(s.mesh.position[v], s.node[v]); e.push_back(std::abs(q.distance)); }
      std::sort(e.begin(), e.end()); std::printf("raw vertices: median %.4f 90 %% %.4f 99 %% %.4f 99.9 %% %.4f most %.4f\n", e[e.size()/2], e[e.size()*9/10], e[e.size()*99/100], e[e.size()*999/1000], e.back()); 
      e.clear(); for (auto& q : s.mesh.triangle) { auto k = field.at((s.mesh.position[q[0]]+s.mesh.position[q[1]]+s.mesh.position[q[2]])/3, s.node[q[0]]); e.push_back(std::abs(k.distance)); }
      std::sort(e.begin(), e.end()); std::printf("raw centroids: median %.4f 90 %% %.4f 99 %% %.4f 99.9 %% %.4f most %.4f\n", e[e.size()/2], e[e.size()*9/10], e[e.size()*99/100], e[e.size()*999/1000], e.back()); }
    const convert::Length bound{0.1, 0};
    const auto radii = convert::vesselRadii(s, field);
    std::printf("radii %.2f s\n", now() - t); t = now();
    convert::CollapseRules rules;
    for (double r : radii) rules.allowed.push_back(std::max(0.1, 0.03 * r));
    convert::collapseEdges(s, rules, progress);
    std::printf("collapsed to %zu: %.2f s\n", s.mesh.triangle.size(), now() - t); t = now();
    { auto cc = s; convert::roundToFloats(cc.mesh);
    std::printf("crossings after collapse %zu\n", convert::selfIntersections(cc.mesh, 100000, &progress).pairs.size()); t = now(); 
      std::vector<double> e; for (std::size_t v = 0; v < s.mesh.position.size(); ++v) { auto q = field.at(s.mesh.position[v], s.node[v]); e.push_back(std::abs(q.distance)); }
      std::sort(e.begin(), e.end()); std::printf("vertices: median %.4f 90 %% %.4f 99 %% %.4f 99.9 %% %.4f most %.4f\n", e[e.size()/2], e[e.size()*9/10], e[e.size()*99/100], e[e.size()*999/1000], e.back()); 
      e.clear(); for (auto& q : s.mesh.triangle) { auto k = field.at((s.mesh.position[q[0]]+s.mesh.position[q[1]]+s.mesh.position[q[2]])/3, s.node[q[0]]); e.push_back(std::abs(k.distance)); }
      std::sort(e.begin(), e.end()); std::printf("centroids: median %.4f 90 %% %.4f 99 %% %.4f 99.9 %% %.4f most %.4f\n", e[e.size()/2], e[e.size()*9/10], e[e.size()*99/100], e[e.size()*999/1000], e.back()); }
    const auto error = convert::splitFarEdges(s, field, bound, progress);
    std::printf("split to %zu: %.2f s; greatest %.3f 90 %% %.3f beyond %zu\n", s.mesh.triangle.size(), now() - t, error.greatest, error.ninetieth, error.beyond); t = now();
    convert::roundToFloats(s.mesh);
    std::printf("crossings %zu ", convert::selfIntersections(s.mesh, 100000, &progress).pairs.size());
    std::printf("%.2f s euler %ld open %zu\n", now() - t, (long)convert::eulerCharacteristic(s.mesh), [&]{ std::size_t n = 0; for (auto o : convert::oppositeSides(s.mesh.triangle)) n += o == convert::kNoSide; return n; }());
    const auto quality = convert::triangleQuality(s.mesh);
    std::printf("least %.3f median %.1f\n", quality.leastAngle, quality.medianAngle);
  }
}
