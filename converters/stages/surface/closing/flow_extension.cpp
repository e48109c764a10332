// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/flow_extension.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/box.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/closing/flat_region.h"
#include "converters/stages/surface/surface_fans.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace {

constexpr double kBlend = 1.5;     // radii until the section is round
constexpr double kSteepest = 1.0;  // slope of the wall at the rim: beyond 45 degrees it is no tube
constexpr int kSlopeSmoothings = 3;  // passes over the tangents, which triangles roughen
constexpr double kEvenAfter = 8;     // rows until the vertices of a ring are evenly spaced

using Vector = Eigen::Vector3d;

Eigen::Vector2d centroidOf(const Loop2& loop) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Eigen::Vector2d a = loop[i] - loop[0], b = loop[i + 1] - loop[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    sum += area * (a + b) / 3;
    total += area;
  }
  return loop[0] + sum / total;
}

// Between entries i and i + 1 of a list that goes up by `period` all around.
double interpolate(const std::vector<double>& list, double i, double period) {
  const auto low = static_cast<std::size_t>(i);
  const auto at = [&](std::size_t k) {
    return list[k % list.size()] + period * double(k / list.size());
  };
  return at(low) + (i - double(low)) * (at(low + 1) - at(low));
}

Vector between(const std::vector<Vector>& list, double index) {
  const auto low = static_cast<std::size_t>(index) % list.size();
  const double share = index - std::floor(index);
  return (1 - share) * list[low] + share * list[(low + 1) % list.size()];
}

}  // namespace

FlowTube::FlowTube(const SurfaceFans& fans, const SurfaceEnd& end,
                   const std::vector<std::uint32_t>& rim)
    : m_end(end) {
  const TriangleMesh& mesh = fans.surface().mesh;
  const auto [along, across] = planeBasis(end.normal);
  m_along = along;
  m_across = across;
  Vector middle = Vector::Zero();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector& p = mesh.position[rim[i]];
    m_point.push_back(p);
    m_slope.push_back(slopeAt(fans, rim, i));
    const double length = (mesh.position[rim[(i + 1) % rim.size()]] - p).norm();
    m_share.push_back(m_length);
    m_length += length;
    middle += p;
  }
  for (double& share : m_share) share *= static_cast<double>(rim.size()) / m_length;
  smoothSlopes();
  Loop2 loop;
  for (const Vector& p : m_point) loop.push_back(flat(p));
  m_radius = std::sqrt(signedArea(loop) / M_PI);
  m_centre = centroidOf(loop);
  m_turn = measureTurn(loop);
}

std::size_t FlowTube::rows(double length) const {
  return static_cast<std::size_t>(std::max(1L, std::lround(length / (kRowHeight * edge()))));
}

Vector FlowTube::place(std::size_t j, std::size_t k, std::size_t rows, double length) const {
  const double n = double(around()), height = length * double(j) / double(rows);
  const double even = double(k) + 0.5 * double(j), blend = std::min(length, kBlend * m_radius);
  // at the rim vertices are where they are; farther out they are evenly spaced
  const double part = std::min(1.0, double(j) / kEvenAfter);
  const double at = (1 - part) * interpolate(m_share, even, n) + part * even;
  const double index = indexAt(at);
  const double t = std::min(1.0, height / blend);
  const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
  const double angle = m_turn + 2 * M_PI * at / n;
  const Vector circle = m_end.centre + (m_centre.x() + m_radius * std::cos(angle)) * m_along +
                        (m_centre.y() + m_radius * std::sin(angle)) * m_across;
  return h00 * between(m_point, index) + h10 * blend * between(m_slope, index) +
         (1 - h00) * circle + height * m_end.normal;
}

Eigen::Vector2d FlowTube::flat(const Vector& p) const {
  return {m_along.dot(p - m_end.centre), m_across.dot(p - m_end.centre)};
}

Vector FlowTube::lift(const Eigen::Vector2d& p, double height) const {
  return m_end.centre + p.x() * m_along + p.y() * m_across + height * m_end.normal;
}

// Slope of the wall at the rim: sideways by this many mm for each mm along the normal.
Vector FlowTube::slopeAt(const SurfaceFans& fans, const std::vector<std::uint32_t>& rim,
                         std::size_t i) const {
  const TriangleMesh& mesh = fans.surface().mesh;
  const std::size_t n = rim.size();
  Vector normal = Vector::Zero();
  for (const std::uint32_t t : fans.of(rim[i])) {
    const Triangle& corner = mesh.triangle[t];
    if (fans.surface().group[t] != m_end.group)
      normal += (mesh.position[corner[1]] - mesh.position[corner[0]])
                    .cross(mesh.position[corner[2]] - mesh.position[corner[0]]);
  }
  const Vector tangent = mesh.position[rim[(i + 1) % n]] - mesh.position[rim[(i + n - 1) % n]];
  Vector ahead = normal.cross(tangent);
  if (ahead.dot(m_end.normal) < 0) ahead = -ahead;
  const double forward = ahead.dot(m_end.normal);
  if (!(forward > 0)) return Vector::Zero();
  Vector slope = ahead / forward - m_end.normal;
  // only the part across the rim counts: sliding along it changes no shape
  const Vector outward = tangent.cross(m_end.normal).normalized();
  slope = slope.dot(outward) * outward;
  return slope * std::min(1.0, kSteepest / std::max(slope.norm(), 1e-12));
}

void FlowTube::smoothSlopes() {
  const std::size_t n = m_slope.size();
  for (int round = 0; round < kSlopeSmoothings; ++round) {
    const std::vector<Vector> before = m_slope;
    for (std::size_t i = 0; i < n; ++i)
      m_slope[i] = 0.25 * before[(i + n - 1) % n] + 0.5 * before[i] + 0.25 * before[(i + 1) % n];
  }
}

// The angle on the circle at which the rim begins: the mean over all vertices.
double FlowTube::measureTurn(const Loop2& loop) const {
  double x = 0, y = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d offset = loop[i] - m_centre;
    const double angle = -2 * M_PI * m_share[i] / double(loop.size());
    x += std::cos(angle) * offset.x() - std::sin(angle) * offset.y();
    y += std::sin(angle) * offset.x() + std::cos(angle) * offset.y();
  }
  return std::atan2(y, x);
}

// The inverse of m_share: the rim's vertex, and the share of the step to the next, at a parameter.
double FlowTube::indexAt(double around) const {
  const double n = double(m_point.size());
  const double turns = std::floor(around / n), rest = around - turns * n;
  const auto above = std::upper_bound(m_share.begin(), m_share.end(), rest);
  const auto low = static_cast<std::size_t>(above - m_share.begin()) - 1;
  const double begin = m_share[low], end = low + 1 < m_share.size() ? m_share[low + 1] : n;
  return double(low) + (end > begin ? (rest - begin) / (end - begin) : 0);
}

namespace {

constexpr double kMostTriangles = 5e6;  // bound for one tube

void closeTube(SurfaceFans& fans, const FlowTube& tube, const SurfaceEnd& end,
               const std::vector<std::uint32_t>& ring, double length) {
  Loop2 loop;
  for (const std::uint32_t v : ring) loop.push_back(tube.flat(fans.surface().mesh.position[v]));
  const FlatMesh cap = triangulateRegion(loop, {}, tube.edge());
  if (cap.triangle.empty())
    throw failed("the tube at " + formats::printable(fans.surface().groups[end.group].name) +
                 " has no simple section");
  std::vector<std::uint32_t> number = ring;
  for (std::size_t i = ring.size(); i < cap.point.size(); ++i)
    number.push_back(fans.addVertex(tube.lift(cap.point[i], length), end.node));
  for (const Triangle& t : cap.triangle)
    fans.add({number[t[0]], number[t[1]], number[t[2]]}, end.group);
}

// Replaces the faces of an end by a tube with the same faces at its far side.
void extend(SurfaceFans& fans, SurfaceEnd& end, const std::vector<std::uint32_t>& rim,
            const std::vector<std::uint32_t>& faces, const Length& wanted) {
  const FlowTube tube(fans, end, rim);
  const double length = wanted.at(tube.radius());
  if (!(length / tube.edge() * double(tube.around()) < kMostTriangles))
    throw invalidInput("an extension of " + formats::shortText(length) + " mm at " +
                       formats::printable(fans.surface().groups[end.group].name) +
                       " needs too many triangles; expected a shorter one, or longer edges");
  for (const std::uint32_t t : faces) fans.remove(t);
  const std::size_t rows = tube.rows(length), n = rim.size();
  std::vector<std::uint32_t> ring = rim, next(n);
  for (std::size_t j = 1; j <= rows; ++j) {
    for (std::size_t k = 0; k < n; ++k)
      next[k] = fans.addVertex(tube.place(j, k, rows, length), end.node);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t l = (k + 1) % n;
      fans.add({ring[k], ring[l], next[k]}, 0);
      fans.add({ring[l], next[l], next[k]}, 0);
    }
    ring = next;
  }
  closeTube(fans, tube, end, ring, length);
  end.centre += length * end.normal;
}

// The length for each end; nothing where none was asked for.
std::vector<std::optional<Length>> lengthsOf(const CaseSurface& surface,
                                             const formats::Case& source,
                                             const std::vector<EndLength>& lengths,
                                             const std::vector<std::vector<std::uint32_t>>& rims,
                                             std::vector<std::string>& messages) {
  std::map<std::string, Length> byLabel;
  for (const EndLength& length : lengths) {
    const auto& branches = source.tree.branches;
    const std::string label = formats::printable(length.label);
    if (!length.label.empty() &&
        std::none_of(branches.begin(), branches.end(),
                     [&](const formats::Branch& b) { return b.label == length.label; }))
      throw Error(ErrorKind::Usage, "extend: no branch of the case is called " + label);
    if (!byLabel.try_emplace(length.label, length.length).second)
      throw Error(ErrorKind::Usage,
                  "extend: two lengths for " + (label.empty() ? "all ends" : label));
  }
  std::vector<std::optional<Length>> found(surface.ends.size());
  std::set<std::string> used;
  for (std::size_t e = 0; e < found.size(); ++e) {
    auto length = byLabel.find(source.tree.branches[surface.ends[e].branch].label);
    if (length == byLabel.end()) length = byLabel.find("");
    if (length == byLabel.end() || rims[e].empty()) continue;
    found[e] = length->second;
    used.insert(length->first);
  }
  for (const auto& entry : byLabel)
    if (used.count(entry.first) == 0)
      messages.push_back(
          "nothing to extend: " +
          (entry.first.empty() ? std::string("the case") : formats::printable(entry.first)) +
          " has no flat end");
  return found;
}

std::string nameOfEnd(const CaseSurface& surface, std::uint32_t end) {
  return formats::printable(surface.groups[surface.ends[end].group].name);
}

using Met = std::set<std::pair<std::uint32_t, std::string>>;  // an end, and what its tube runs into

// Collisions of tubes. Vertices from `firstNew` on are those of tubes; `owner` is the end of each.
class Collisions {
public:
  Collisions(const CaseSurface& surface, const formats::Case& source, std::size_t firstNew,
             const std::vector<std::uint32_t>& owner)
      : m_surface(surface), m_source(source), m_firstNew(firstNew), m_owner(owner) {}

  [[nodiscard]] Met find() const {
    const TriangleMesh near = trianglesNear();
    Met met;
    for (const auto& [one, other] : selfIntersections(near).pairs) {
      const Triangle &a = near.triangle[one], &b = near.triangle[other];
      if (const auto end = ownerOf(a)) met.insert({*end, nameOf(b)});
      if (const auto end = ownerOf(b)) met.insert({*end, nameOf(a)});
    }
    return met;
  }

private:
  // The last vertex of a tube's triangle is one of its own: rims come first.
  [[nodiscard]] std::optional<std::uint32_t> ownerOf(const Triangle& t) const {
    const std::uint32_t last = std::max({t[0], t[1], t[2]});
    if (last < m_firstNew) return std::nullopt;
    return m_owner[last - m_firstNew];
  }
  [[nodiscard]] std::string nameOf(const Triangle& t) const {
    if (const auto end = ownerOf(t)) return "the extension of " + nameOfEnd(m_surface, *end);
    const std::uint32_t branch = m_source.tree.branch[m_surface.node[t[0]]];
    return "branch " + formats::printable(m_source.tree.branches[branch].label);
  }
  [[nodiscard]] TriangleMesh trianglesNear() const {
    std::map<std::uint32_t, Box3d> boxes;
    for (std::size_t i = 0; i < m_owner.size(); ++i)
      boxes[m_owner[i]].add(m_surface.mesh.position[m_firstNew + i]);
    TriangleMesh near{m_surface.mesh.position, {}};
    for (const Triangle& t : m_surface.mesh.triangle) {
      Box3d box;
      for (const std::uint32_t v : t) box.add(near.position[v]);
      if (std::any_of(boxes.begin(), boxes.end(),
                      [&box](const auto& entry) { return entry.second.meets(box); }))
        near.triangle.push_back(t);
    }
    return near;
  }

  const CaseSurface& m_surface;
  const formats::Case& m_source;
  std::size_t m_firstNew;
  const std::vector<std::uint32_t>& m_owner;
};

// Prolongs the ends that have a length.
Met extendBy(CaseSurface& surface, const formats::Case& source,
             const std::vector<std::optional<Length>>& lengths,
             const std::vector<std::vector<std::uint32_t>>& rims) {
  std::vector<std::vector<std::uint32_t>> faces(surface.groups.size());
  for (std::uint32_t t = 0; t < surface.group.size(); ++t) faces[surface.group[t]].push_back(t);
  const std::size_t before = surface.mesh.position.size();
  std::vector<std::uint32_t> owner;  // end of each new vertex
  SurfaceFans fans(surface);
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    if (lengths[e])
      extend(fans, surface.ends[e], rims[e], faces[surface.ends[e].group], *lengths[e]);
    owner.resize(surface.mesh.position.size() - before, static_cast<std::uint32_t>(e));
  }
  fans.compact();  // new vertices stay the last ones
  return Collisions(surface, source, surface.mesh.position.size() - owner.size(), owner).find();
}

}  // namespace

std::vector<std::string> extendEnds(CaseSurface& surface, const formats::Case& source,
                                    const std::vector<EndLength>& lengths) {
  std::vector<std::string> messages;
  const auto rims = findRims(surface);
  const auto wanted = lengthsOf(surface, source, lengths, rims, messages);
  for (const auto& [end, what] : extendBy(surface, source, wanted, rims))
    messages.push_back("the extension of " + nameOfEnd(surface, end) + " runs into " + what +
                       "; expected a shorter extend there");
  return messages;
}

void extendFreeEnds(CaseSurface& surface, const formats::Case& source, const Length& length) {
  const auto rims = findRims(surface);
  std::vector<std::optional<Length>> lengths(surface.ends.size());
  for (std::size_t e = 0; e < lengths.size(); ++e)
    if (!rims[e].empty()) lengths[e] = length;
  CaseSurface all = surface;
  const Met met = extendBy(all, source, lengths, rims);
  if (met.empty()) {
    surface = std::move(all);
    return;
  }
  for (const auto& [end, what] : met) lengths[end].reset();
  extendBy(surface, source, lengths, rims);
}

}  // namespace lumen::convert
