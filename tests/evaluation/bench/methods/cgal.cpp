// SPDX-License-Identifier: Apache-2.0
// Closest point on the triangle mesh by CGAL's AABB tree, whose licence is GPL: this benchmark
// only.
#include <cmath>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "method.h"

namespace lumen::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

class Cgal : public Method {
public:
  [[nodiscard]] std::string name() const override { return "CGAL AABB tree"; }

  void prepare(const Vessel& vessel) override {
    m_triangle.clear();
    for (const auto& face : vessel.mesh.face) {
      const auto corner = [&](std::size_t i) {
        const auto& v = vessel.mesh.vertex[face[i]];
        return Kernel::Point_3(v[0], v[1], v[2]);
      };
      const Triangle triangle(corner(0), corner(1), corner(2));
      if (!triangle.is_degenerate()) m_triangle.push_back(triangle);
    }
    m_tree.clear();
    m_tree.insert(m_triangle.begin(), m_triangle.end());
    m_tree.build();
    m_tree.accelerate_distance_queries();
  }

  void query(std::size_t, const double* points, std::size_t count,
             const Answers& answers) override {
    for (std::size_t i = 0; i < count; ++i) {
      const Kernel::Point_3 p(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
      answers.distance[i] = std::sqrt(CGAL::squared_distance(p, m_tree.closest_point(p)));
    }
  }

  [[nodiscard]] int passes() const override { return 2; }

private:
  std::vector<Triangle> m_triangle;
  Tree m_tree;
};

}  // namespace

void addCgal(Methods& methods) {
  methods.push_back(std::make_unique<Cgal>());
}

}  // namespace lumen::bench
