// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/volume_mesh/wall_layers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/self_intersections.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/surface/closing/flat_region.h"
#include "converters/stages/surface/remesh/remesh_target.h"

namespace lumen::convert {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Greatest height of all layers as a share of the distance to the opposite wall, so that half of it
// is left between layers that face each other.
constexpr double kShareOfWidth = 0.25;
// Least quality of a prism as a share of that of an upright prism on its triangle, and, where the surface
// is so sharp that no prism stands upright, of that of the thinnest one.
constexpr double kLeastQuality = 0.25, kLeastOfSharp = 0.5;
// Factor of heights at a fault, and the number of times that they may shrink: to a thousandth.
constexpr double kShrink = 0.75;
constexpr int kMostRounds = 60;
constexpr double kLeastShare = 1e-3;
constexpr std::size_t kMostCrossings = 100'000;

/// The fault of a vertex for which its height shrinks.
enum class Fault : std::uint8_t { None, Prism, Rim, Crossing };

std::string reasonOf(Fault fault) {
  if (fault == Fault::Rim) return "where they make the rim of a flat end cross itself";
  if (fault == Fault::Crossing) return "where they pass through one another";
  return "where the surface is too sharp for them";
}

class LayerMaker {
public:
  LayerMaker(const LayerBase& base, const std::vector<Vector3d>& direction,
             const SurfaceMesh& surface, const VolumeMeshOptions& options, Progress& progress)
      : m_base(base), m_direction(direction), m_options(options), m_progress(progress) {
    const double heights = options.heights();
    double reached = 0, height = 1;
    for (int layer = 1; layer <= options.layers; ++layer, height *= options.growth)
      m_level.push_back((reached += height) / heights);
    for (const std::uint32_t v : base.vertex)
      m_asked.push_back(heights * options.height.at(static_cast<double>(surface.radius[v])));
    m_height = m_asked;
    findSharp();
    keepFromOpposite(surface);
  }

  WallLayers run() {
    gradeLengths(m_base.mesh, m_height);
    for (int round = 0; round < kMostRounds; ++round) {
      m_progress.check();
      std::vector<Fault> faults(m_height.size(), Fault::None);
      bool isAny = markPrisms(faults);
      isAny = markRims(faults) || isAny;
      if (!isAny) isAny = markCrossings(faults);
      if (!isAny) return result();
      shrink(faults);
    }
    throw failed(
        "the layers could not be made: they cross one another even when they are thin; another " +
        m_options.word("edge") + " may help");
  }

private:
  [[nodiscard]] Vector3d at(std::uint32_t v, double level) const {
    return m_base.mesh.position[v] + level * m_height[v] * m_direction[v];
  }

  void keepFromOpposite(const SurfaceMesh& surface) {
    TriangleMesh whole;
    for (const Float3& p : surface.position) whole.position.push_back(toEigen(p));
    whole.triangle = surface.triangle;
    const TriangleTree tree(whole);
    tbb::parallel_for(std::size_t{0}, m_height.size(), [&](std::size_t v) {
      if (m_base.rimOf[v] != kAbsent) return;
      const double near = 1e-3 * static_cast<double>(surface.radius[m_base.vertex[v]]);
      const auto hit = tree.firstHit(m_base.mesh.position[v], m_direction[v], near);
      if (hit) m_height[v] = std::min(m_height[v], kShareOfWidth * hit->distance);
    });
  }

  /// Finds the least cosine between the direction at each vertex and the normals of its triangles.
  void findSharp() {
    m_cosine.assign(m_height.size(), 1);
    for (const Triangle& t : m_base.mesh.triangle) {
      const Vector3d inward = -vectorArea(m_base.mesh, t).stableNormalized();
      for (const std::uint32_t v : t)
        m_cosine[v] = std::min(m_cosine[v], inward.dot(m_direction[v]));
    }
  }

  [[nodiscard]] VolumeMesh prismsAlone() const {
    VolumeMesh mesh;
    const auto count = static_cast<std::uint32_t>(m_base.vertex.size());
    mesh.position = m_base.mesh.position;
    for (const double level : m_level)
      for (std::uint32_t v = 0; v < count; ++v) mesh.position.push_back(at(v, level));
    for (const Triangle& t : m_base.mesh.triangle)
      for (std::uint32_t layer = 0; layer < m_level.size(); ++layer) {
        const std::uint32_t outer = layer * count, inner = outer + count;
        mesh.prism.push_back(
            {t[0] + outer, t[1] + outer, t[2] + outer, t[0] + inner, t[1] + inner, t[2] + inner});
      }
    return mesh;
  }

  /// The quality of an upright prism on a triangle of the base.
  [[nodiscard]] double uprightQuality(const Triangle& t) const {
    const double area = 2 * vectorArea(m_base.mesh, t).norm();
    std::array<double, 3> side{};
    for (std::size_t k = 0; k < 3; ++k)
      side[k] = (m_base.mesh.position[t[(k + 1) % 3]] - m_base.mesh.position[t[k]]).norm();
    std::sort(side.begin(), side.end());
    return area / (side[1] * side[2]) * 2 / std::sqrt(3.0);
  }

  bool markPrisms(std::vector<Fault>& faults) const {
    const VolumeMesh mesh = prismsAlone();
    const std::size_t layers = m_level.size();
    std::vector<char> fails(m_base.mesh.triangle.size(), 0);
    tbb::parallel_for(std::size_t{0}, fails.size(), [&](std::size_t t) {
      const Triangle& corners = m_base.mesh.triangle[t];
      const double thinnest =
          std::min({m_cosine[corners[0]], m_cosine[corners[1]], m_cosine[corners[2]]});
      const double least =
          std::min(kLeastQuality, kLeastOfSharp * thinnest) * uprightQuality(corners);
      for (std::size_t layer = 0; layer < layers; ++layer) {
        const std::size_t cell = t * layers + layer;
        const double quality = cellQuality(mesh, cell);
        if (!(quality > 0 && quality >= least && cellVolume(mesh, cell) > 0)) fails[t] = 1;
      }
    });
    bool isAny = false;
    for (std::size_t t = 0; t < fails.size(); ++t)
      if (fails[t] != 0) {
        isAny = true;
        for (const std::uint32_t v : m_base.mesh.triangle[t]) faults[v] = Fault::Prism;
      }
    return isAny;
  }

  /// Cuts the inner ends into triangles; marks the rims of those that cannot be cut.
  bool markRims(std::vector<Fault>& faults) {
    m_caps.clear();
    bool isAny = false;
    for (const LayerRim& rim : m_base.rims) {
      const auto basis = planeBasis(rim.normal);
      const auto flat = [&](const Vector3d& p) {
        return Vector2d((p - rim.centre).dot(basis.first), (p - rim.centre).dot(basis.second));
      };
      Loop2 outer, inner;
      double around = 0;
      for (std::size_t k = 0; k < rim.loop.size(); ++k) {
        outer.push_back(flat(m_base.mesh.position[rim.loop[k]]));
        inner.push_back(flat(at(rim.loop[k], 1)));
        if (k > 0) around += (inner[k] - inner[k - 1]).norm();
      }
      FlatMesh cap;
      if (isSimple(inner) && signedArea(inner) > 0 && isWithin(inner, outer))
        cap = triangulateRegion(inner, {}, around / static_cast<double>(inner.size() - 1));
      if (cap.triangle.empty()) {
        isAny = true;
        for (const std::uint32_t w : rim.loop) faults[w] = Fault::Rim;
      }
      m_caps.push_back(std::move(cap));
    }
    return isAny;
  }

  bool markCrossings(std::vector<Fault>& faults) {
    makeInner();
    bool isAny = false;
    for (const auto& pair : selfIntersections(m_inner, kMostCrossings, &m_progress).pairs)
      for (const std::uint32_t t : pair)
        for (const std::uint32_t v : m_inner.triangle[t])
          if (v < m_height.size()) {
            faults[v] = Fault::Crossing;
            isAny = true;
          }
    return isAny;
  }

  /// The surface within the layers: the base's vertices at the last level, then new ones of ends.
  void makeInner() {
    m_inner = {};
    for (std::uint32_t v = 0; v < m_height.size(); ++v) m_inner.position.push_back(at(v, 1));
    m_inner.triangle = m_base.mesh.triangle;
    for (std::size_t r = 0; r < m_caps.size(); ++r) {
      const LayerRim& rim = m_base.rims[r];
      const auto [u, v] = planeBasis(rim.normal);
      const auto first = static_cast<std::uint32_t>(m_inner.position.size());
      const auto onRim = static_cast<std::uint32_t>(rim.loop.size());
      for (std::size_t k = onRim; k < m_caps[r].point.size(); ++k)
        m_inner.position.emplace_back(rim.centre + m_caps[r].point[k].x() * u +
                                      m_caps[r].point[k].y() * v);
      for (Triangle t : m_caps[r].triangle) {
        for (std::uint32_t& c : t) c = c < onRim ? rim.loop[c] : first + c - onRim;
        m_inner.triangle.push_back(t);
      }
    }
  }

  void shrink(const std::vector<Fault>& faults) {
    for (std::size_t v = 0; v < m_height.size(); ++v) {
      if (faults[v] == Fault::None) continue;
      m_height[v] *= kShrink;
      if (m_height[v] < kLeastShare * m_asked[v])
        throw failed("the layers could not be made at " +
                     joinedNumbers(m_base.mesh.position[v], ", ", 5) + " mm, " +
                     reasonOf(faults[v]) + "; another " + m_options.word("edge") +
                     " may help, or no " + m_options.word("layers"));
    }
    gradeLengths(m_base.mesh, m_height);
  }

  WallLayers result() {
    WallLayers made;
    made.mesh = prismsAlone();
    const auto count = static_cast<std::uint32_t>(m_height.size());
    const auto last = count * static_cast<std::uint32_t>(m_level.size());
    made.mesh.position.insert(made.mesh.position.end(), m_inner.position.begin() + count,
                              m_inner.position.end());
    made.inner = m_inner.triangle;
    for (Triangle& t : made.inner)
      for (std::uint32_t& v : t) v += last;
    addBoundary(made);
    for (std::uint32_t v = 0; v < count; ++v) made.share.push_back(m_height[v] / m_asked[v]);
    return made;
  }

  void addBoundary(WallLayers& made) const {
    std::vector<BoundaryFace>& boundary = made.mesh.boundary;
    const auto count = static_cast<std::uint32_t>(m_height.size());
    for (std::size_t t = 0; t < m_base.mesh.triangle.size(); ++t) {
      const Triangle& c = m_base.mesh.triangle[t];
      boundary.push_back({{c[0], c[1], c[2], kAbsent}, m_base.group[t]});
    }
    std::size_t next = m_base.mesh.triangle.size();
    for (std::size_t r = 0; r < m_base.rims.size(); ++r) {
      const LayerRim& rim = m_base.rims[r];
      for (std::size_t k = 0; k < rim.loop.size(); ++k) {
        const std::uint32_t a = rim.loop[k], b = rim.loop[(k + 1) % rim.loop.size()];
        for (std::uint32_t from = 0; from < count * m_level.size(); from += count)
          boundary.push_back({{a + from, b + from, b + from + count, a + from + count}, rim.group});
      }
      for (std::size_t k = 0; k < m_caps[r].triangle.size(); ++k, ++next) {
        const Triangle& c = made.inner[next];
        boundary.push_back({{c[0], c[1], c[2], kAbsent}, rim.group});
      }
    }
  }

  const LayerBase& m_base;
  const std::vector<Vector3d>& m_direction;
  const VolumeMeshOptions& m_options;
  Progress& m_progress;
  std::vector<double> m_level;   // height at the end of each layer, as a share of all
  std::vector<double> m_asked;   // mm, of all layers at each vertex
  std::vector<double> m_height;  // as it is
  std::vector<double> m_cosine;  // least, of the direction with normals around
  std::vector<FlatMesh> m_caps;  // of the rims
  TriangleMesh m_inner;
};

}  // namespace

double VolumeMeshOptions::heights() const {
  double sum = 0, next = 1;
  for (int layer = 0; layer < layers; ++layer, next *= growth) sum += next;
  return sum;
}

WallLayers wallLayers(const LayerBase& base, const std::vector<Vector3d>& direction,
                      const SurfaceMesh& surface, const VolumeMeshOptions& options,
                      Progress& progress) {
  return LayerMaker(base, direction, surface, options, progress).run();
}

}  // namespace lumen::convert
