// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh_mesh.h"

#include <algorithm>
#include <cmath>

#include "converters/geometry/triangle_quality.h"

namespace lumen::convert {
namespace {

constexpr double kLargestTurn = 0.5;    // cosine: 60 degrees from where a face should look
constexpr std::uint32_t kRimEdges = 8;  // least number of edges of a rim

Eigen::Vector3d normalOf(const RemeshMesh::Corners& c) {
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

// The vectors may have any length.
double cosine(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double lengths = std::sqrt(a.squaredNorm() * b.squaredNorm());
  return lengths > 0 ? a.dot(b) / lengths : -1;
}

// True if a face of the normal is turned away from `outward`, and further than `before` was.
bool isTurned(const Eigen::Vector3d& normal, const RemeshMesh::Corners& before,
              const Eigen::Vector3d& outward) {
  if (outward.isZero(0)) return cosine(normal, normalOf(before)) < kLargestTurn;
  const double along = normal.dot(outward);
  constexpr double kSquare = kLargestTurn * kLargestTurn;
  if (along > 0 && along * along >= kSquare * normal.squaredNorm() * outward.squaredNorm())
    return false;
  return cosine(normal, outward) < cosine(normalOf(before), outward);
}

}  // namespace

RemeshMesh::RemeshMesh(const RemeshPiece& piece, const PieceRules& rules) : m_rules(rules) {
  reserve(2 * piece.vertex.size(), 6 * piece.vertex.size(), 4 * piece.vertex.size());
  for (const PieceVertex& vertex : piece.vertex) {
    auto& kept = data(add_vertex(vertex.position));
    kept.gradient = vertex.gradient;
    kept.target = vertex.target;
    kept.node = vertex.node;
    kept.home = vertex.home;
    kept.isSeparated = vertex.isSeparated;
    kept.isOffField = vertex.isOffField;
  }
  const auto handle = [](std::uint32_t v) { return VertexHandle(static_cast<int>(v)); };
  for (std::size_t f = 0; f < piece.triangle.size(); ++f) {
    const Triangle& t = piece.triangle[f];
    const FaceHandle face = add_face(handle(t[0]), handle(t[1]), handle(t[2]));
    if (face.is_valid()) data(face).group = piece.group[f];
  }
  m_rimEdges.assign(rules.plane.size(), 0);
  findKinds();
}

void RemeshMesh::findKinds() {
  std::vector<std::uint8_t> rims(n_vertices(), 0);
  for (const EdgeHandle edge : edges()) {
    const HalfedgeHandle h = halfedge_handle(edge, 0), back = opposite_halfedge_handle(h);
    if (is_boundary(edge)) continue;
    const std::uint32_t a = data(face_handle(h)).group, b = data(face_handle(back)).group;
    if (a == b) continue;
    data(edge).isRim = true;
    ++m_rimEdges[a];
    ++m_rimEdges[b];
    for (const VertexHandle v : {to_vertex_handle(h), to_vertex_handle(back)})
      rims[static_cast<std::size_t>(v.idx())] =
          static_cast<std::uint8_t>(std::min(rims[static_cast<std::size_t>(v.idx())] + 1, 3));
  }
  for (const VertexHandle v : vertices()) {
    auto& here = data(v);
    const std::uint8_t rim = rims[static_cast<std::size_t>(v.idx())];
    std::uint32_t flat = 0, flats = 0;
    for (const FaceHandle face : vf_range(v)) {
      const std::uint32_t group = data(face).group;
      if (!m_rules.plane[group] || (flats > 0 && group == flat)) continue;
      flat = group;
      ++flats;
    }
    here.end = flat;
    if (is_boundary(v) || (rim != 0 && rim != 2) || flats > 1)
      here.kind = VertexKind::Locked;
    else if (rim == 2)
      here.kind = VertexKind::Rim;
    else
      here.kind = flats > 0 ? VertexKind::Flat : VertexKind::Wall;
  }
}

RemeshPiece RemeshMesh::toPiece() const {
  RemeshPiece piece;
  std::vector<std::uint32_t> index(n_vertices(), kNewVertex);
  for (const VertexHandle v : vertices()) {
    const auto& from = data(v);
    index[static_cast<std::size_t>(v.idx())] = static_cast<std::uint32_t>(piece.vertex.size());
    piece.vertex.push_back({point(v), from.gradient, from.target, from.node, from.home,
                            from.isSeparated, from.isOffField, is_boundary(v)});
  }
  for (const FaceHandle face : faces()) {
    const auto corner = verticesOf(face);
    Triangle& t = piece.triangle.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) t[i] = index[static_cast<std::size_t>(corner[i].idx())];
    piece.group.push_back(data(face).group);
  }
  return piece;
}

RemeshMesh::EdgeHandle RemeshMesh::longestEdge(FaceHandle face) const {
  EdgeHandle longest;
  for (const EdgeHandle edge : fe_range(face))
    if (!longest.is_valid() || lengthOf(edge) > lengthOf(longest)) longest = edge;
  return longest;
}

double RemeshMesh::measureQuality(const Corners& c, const Eigen::Vector3d& outward) const {
  return (c[1] - c[0]).cross(c[2] - c[0]).dot(outward) < 0 ? 0 : squaredSine(c[0], c[1], c[2]);
}

double RemeshMesh::measureQuality(FaceHandle face) const {
  return measureQuality(cornersOf(face), outward(data(face).group, verticesOf(face)));
}

void RemeshMesh::gatherStar(VertexHandle vertex, std::vector<StarFace>& star) const {
  star.clear();
  const double target = data(vertex).target;
  eachFaceAround(vertex, [&](FaceHandle face, VertexHandle a, VertexHandle b) {
    star.push_back({point(a), point(b), outward(data(face).group, {vertex, a, b}),
                    target + data(a).target + data(b).target});
  });
}

double RemeshMesh::starQuality(const std::vector<StarFace>& star, const Eigen::Vector3d& position,
                               double least) const {
  double quality = 4;
  for (const StarFace& face : star) {
    quality = std::min(quality, measureQuality({position, face.a, face.b}, face.outward));
    if (quality <= least) break;
  }
  return quality;
}

bool RemeshMesh::mayMove(const std::vector<StarFace>& star, const Eigen::Vector3d& here,
                         const Eigen::Vector3d& position) const {
  return std::ranges::none_of(star, [&](const StarFace& face) {
    return isTurned(normalOf({position, face.a, face.b}), {here, face.a, face.b}, face.outward);
  });
}

// The conditions of OpenMesh's is_collapse_ok(), without its marks on vertices.
bool RemeshMesh::keepsManifold(HalfedgeHandle h) const {
  const HalfedgeHandle back = opposite_halfedge_handle(h);
  const VertexHandle gone = from_vertex_handle(h), kept = to_vertex_handle(h);
  std::array<VertexHandle, 2> tips;
  for (const std::size_t side : {0U, 1U}) {
    const HalfedgeHandle inner = side == 0 ? h : back;
    if (is_boundary(inner)) continue;
    const HalfedgeHandle one = next_halfedge_handle(inner), other = next_halfedge_handle(one);
    tips[side] = to_vertex_handle(one);
    if (is_boundary(opposite_halfedge_handle(one)) && is_boundary(opposite_halfedge_handle(other)))
      return false;
  }
  if (tips[0] == tips[1]) return false;
  const bool shareNoOther = eachAround(gone, [&](VertexHandle v) {
    return v == tips[0] || v == tips[1] ||
           eachAround(kept, [v](VertexHandle other) { return other != v; });
  });
  return shareNoOther &&
         (!is_boundary(gone) || !is_boundary(kept) || is_boundary(h) || is_boundary(back));
}

bool RemeshMesh::mayCollapse(HalfedgeHandle h) const {
  const VertexHandle gone = from_vertex_handle(h), kept = to_vertex_handle(h);
  const VertexKind kind = data(gone).kind;
  if (kind == VertexKind::Locked) return false;
  const EdgeHandle edge = edge_handle(h);
  if (kind == VertexKind::Rim) {
    if (!data(edge).isRim) return false;
    for (const HalfedgeHandle side : {h, opposite_halfedge_handle(h)})
      if (m_rimEdges[data(face_handle(side)).group] <= kRimEdges) return false;
  }
  if (!keepsManifold(h)) return false;
  if (!is_boundary(kept)) return true;
  for (const VertexHandle w : vv_range(gone))
    if (w != kept && is_boundary(w) && !find_halfedge(w, kept).is_valid()) return false;
  return true;
}

RemeshMesh::Outcome RemeshMesh::afterCollapse(HalfedgeHandle h) const {
  const VertexHandle gone = from_vertex_handle(h), kept = to_vertex_handle(h);
  Outcome outcome{false, 4, 4, 0};
  for (const FaceHandle face : vf_range(gone)) {
    auto v = verticesOf(face);
    const Corners c = cornersOf(face);
    const std::uint32_t group = data(face).group;
    outcome.before = std::min(outcome.before, measureQuality(c, outward(group, v)));
    if (std::find(v.begin(), v.end(), kept) != v.end()) continue;
    Corners moved = c;
    for (std::size_t i = 0; i < 3; ++i)
      if (v[i] == gone) {
        v[i] = kept;
        moved[i] = point(kept);
      }
    const Eigen::Vector3d out = outward(group, v);
    if (isTurned(normalOf(moved), c, out)) outcome.isTurned = true;
    outcome.quality = std::min(outcome.quality, measureQuality(moved, out));
  }
  for (const VertexHandle w : vv_range(gone))
    outcome.longest = std::max(outcome.longest, (point(w) - point(kept)).norm() * 2 /
                                                    (data(w).target + data(kept).target));
  return outcome;
}

bool RemeshMesh::makesLonger(HalfedgeHandle h, double share) const {
  const VertexHandle kept = to_vertex_handle(h);
  const Eigen::Vector3d position = point(kept);
  const double target = data(kept).target;
  for (HalfedgeHandle side = next_halfedge_handle(opposite_halfedge_handle(h)); side != h;
       side = next_halfedge_handle(opposite_halfedge_handle(side))) {
    const VertexHandle w = to_vertex_handle(side);
    const double longest = 0.5 * share * (data(w).target + target);
    if ((point(w) - position).squaredNorm() > longest * longest) return true;
  }
  return false;
}

void RemeshMesh::collapse(HalfedgeHandle h) {
  const HalfedgeHandle back = opposite_halfedge_handle(h);
  if (data(edge_handle(h)).isRim)
    for (const HalfedgeHandle side : {h, back}) --m_rimEdges[data(face_handle(side)).group];
  // When a face vanishes, its edge at the removed vertex is merged into its other edge or takes the
  // other's place: both get the same rim mark.
  for (const HalfedgeHandle side : {h, back}) {
    if (!face_handle(side).is_valid()) continue;
    const EdgeHandle a = edge_handle(next_halfedge_handle(side)),
                     b = edge_handle(prev_halfedge_handle(side));
    const bool isRim = data(a).isRim || data(b).isRim;
    data(a).isRim = data(b).isRim = isRim;
  }
  TriMesh_ArrayKernelT::collapse(h);
}

bool RemeshMesh::mayFlip(EdgeHandle edge) const {
  if (is_boundary(edge) || data(edge).isRim) return false;
  const HalfedgeHandle h = halfedge_handle(edge, 0);
  const VertexHandle left = opposite_vh(h), right = opposite_he_opposite_vh(h);
  return left != right && !(is_boundary(left) && is_boundary(right)) &&
         eachAround(left, [right](VertexHandle v) { return v != right; });
}

RemeshMesh::Outcome RemeshMesh::afterFlip(EdgeHandle edge) const {
  const HalfedgeHandle h = halfedge_handle(edge, 0);
  const VertexHandle from = from_vertex_handle(h), to = to_vertex_handle(h), left = opposite_vh(h),
                     right = opposite_he_opposite_vh(h);
  const std::uint32_t group = data(face_handle(h)).group;
  const auto cornersAt = [&](const std::array<VertexHandle, 3>& v) {
    return Corners{point(v[0]), point(v[1]), point(v[2])};
  };
  using Corner = std::array<VertexHandle, 3>;
  const Corner old0{from, to, left}, old1{to, from, right}, new0{from, right, left},
      new1{to, left, right};
  Outcome outcome{false, 4, 4, 0};
  for (const Corner& v : {old0, old1})
    outcome.before = std::min(outcome.before, measureQuality(cornersAt(v), outward(group, v)));
  // Neither new face may be worse than the worse of the two before.
  const Corners before0 = cornersAt(old0), before1 = cornersAt(old1);
  for (const Corner& v : {new0, new1}) {
    const Eigen::Vector3d out = outward(group, v), normal = normalOf(cornersAt(v));
    if (isTurned(normal, before0, out) && isTurned(normal, before1, out)) outcome.isTurned = true;
    outcome.quality = std::min(outcome.quality, measureQuality(cornersAt(v), out));
  }
  outcome.longest =
      (point(left) - point(right)).norm() * 2 / (data(left).target + data(right).target);
  return outcome;
}

RemeshMesh::VertexHandle RemeshMesh::splitEdge(EdgeHandle edge) {
  const HalfedgeHandle h = halfedge_handle(edge, 0), back = opposite_halfedge_handle(h);
  const VertexHandle from = from_vertex_handle(h), to = to_vertex_handle(h), left = opposite_vh(h);
  const std::uint32_t groupLeft = data(face_handle(h)).group,
                      groupRight = data(face_handle(back)).group;
  const bool isRim = data(edge).isRim;
  const VertexHandle middle = add_vertex(Point(0.5 * (point(from) + point(to))));
  split(edge, middle);
  for (const FaceHandle face : vf_range(middle)) {
    const auto v = verticesOf(face);
    data(face).group = std::find(v.begin(), v.end(), left) != v.end() ? groupLeft : groupRight;
  }
  for (const HalfedgeHandle spoke : voh_range(middle)) {
    const VertexHandle w = to_vertex_handle(spoke);
    data(edge_handle(spoke)).isRim = isRim && (w == from || w == to);
  }
  auto& made = data(middle);
  const auto &a = data(from), &b = data(to);
  made.gradient = (a.gradient + b.gradient).normalized();
  made.target = 0.5 * (a.target + b.target);
  made.drift = made.target;
  made.node = a.node;
  made.isSeparated = a.isSeparated || b.isSeparated;
  made.isOffField = a.isOffField && b.isOffField;
  const std::uint32_t flat = m_rules.plane[groupLeft] ? groupLeft : groupRight;
  if (m_rules.plane[flat]) made.end = flat;
  made.kind = isRim ? VertexKind::Rim : made.end != 0 ? VertexKind::Flat : VertexKind::Wall;
  if (isRim) {
    ++m_rimEdges[groupLeft];
    ++m_rimEdges[groupRight];
  }
  return middle;
}

}  // namespace lumen::convert
