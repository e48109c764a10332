// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh_pieces.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/geometry/mesh_edges.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kPieceTriangles = 20000;  // their halfedges stay in a core's cache
constexpr std::size_t kLeastPieces = 8;         // enough for a few threads to share the work
constexpr std::size_t kLeastTriangles = 3000;   // below, seams are more work than they save

std::size_t pieceSize(std::size_t triangles) {
  return std::clamp(triangles / kLeastPieces, kLeastTriangles, kPieceTriangles);
}

// A part of a mesh with vertices of its own.
struct LocalMesh {
  std::vector<Triangle> triangle;
  std::vector<std::uint32_t> home;  // each vertex' number in the mesh, ascending
};

// A set of vertices, in which each knows how many come before it.
class VertexRanks {
public:
  explicit VertexRanks(std::size_t vertices)
      : m_bits(vertices / kBits + 1, 0), m_before(m_bits.size(), 0) {}

  void add(std::uint32_t v) { m_bits[v / kBits] |= std::uint64_t{1} << v % kBits; }

  // The vertices, ascending; rank() counts those that are there now.
  std::vector<std::uint32_t> list() {
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = 0; i < m_bits.size(); ++i) {
      m_before[i] = static_cast<std::uint32_t>(vertices.size());
      for (std::uint64_t left = m_bits[i]; left != 0; left &= left - 1)
        vertices.push_back(static_cast<std::uint32_t>(
            i * kBits + static_cast<std::size_t>(std::countr_zero(left))));
    }
    return vertices;
  }

  [[nodiscard]] std::uint32_t rank(std::uint32_t v) const {
    const std::uint64_t below = m_bits[v / kBits] & ((std::uint64_t{1} << v % kBits) - 1);
    return m_before[v / kBits] + static_cast<std::uint32_t>(std::popcount(below));
  }

private:
  static constexpr std::size_t kBits = 64;
  std::vector<std::uint64_t> m_bits;
  std::vector<std::uint32_t> m_before;  // vertices in the words before
};

LocalMesh localMesh(const TriangleMesh& mesh, const TriangleList& list) {
  VertexRanks ranks(mesh.position.size());
  for (const std::uint32_t t : list)
    for (const std::uint32_t v : mesh.triangle[t]) ranks.add(v);
  LocalMesh local;
  local.home = ranks.list();
  local.triangle.reserve(list.size());
  for (const std::uint32_t t : list) {
    const auto& [a, b, c] = mesh.triangle[t];
    local.triangle.push_back({ranks.rank(a), ranks.rank(b), ranks.rank(c)});
  }
  return local;
}

std::uint32_t findRoot(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

// The vertices from which two sides without an opposite one start, since two fans of triangles meet
// there; ascending.
std::vector<std::uint32_t> pinchedVertices(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> starts;
  forEachEdge(edgeUses(triangles), [&](std::span<const EdgeUse> edge) {
    const std::uint32_t start = startOf(triangles, edge[0].side);
    const bool isOpen = std::all_of(edge.begin(), edge.end(), [&](const EdgeUse& use) {
      return startOf(triangles, use.side) == start;
    });
    if (isOpen) starts.insert(starts.end(), edge.size(), start);
  });
  std::sort(starts.begin(), starts.end());
  std::vector<std::uint32_t> pinched;
  for (std::size_t i = 1; i < starts.size(); ++i)
    if (starts[i] == starts[i - 1] && (pinched.empty() || pinched.back() != starts[i]))
      pinched.push_back(starts[i]);
  return pinched;
}

PieceVertex makeVertex(const RemeshState& state, std::uint32_t v) {
  return {state.surface.mesh.position[v],
          state.gradient[v],
          state.target[v],
          state.surface.node[v],
          v,
          state.isSeparated[v] != 0,
          state.isOffField[v] != 0,
          state.isBoundary[v] != 0};
}

void keep(RemeshState& state, std::size_t at, const PieceVertex& from) {
  state.surface.mesh.position[at] = from.position;
  state.surface.node[at] = from.node;
  state.gradient[at] = from.gradient;
  state.target[at] = from.target;
  state.isSeparated[at] = from.isSeparated ? 1 : 0;
  state.isOffField[at] = from.isOffField ? 1 : 0;
  state.isBoundary[at] = from.isBoundary ? 1 : 0;
}

void resize(RemeshState& state, std::size_t vertices) {
  state.surface.mesh.position.resize(vertices);
  state.surface.node.resize(vertices);
  state.gradient.resize(vertices);
  state.target.resize(vertices);
  state.isSeparated.resize(vertices);
  state.isOffField.resize(vertices);
  state.isBoundary.resize(vertices);
  state.isKept.resize(vertices);
}

// Drops vertices that no triangle uses; the others keep their order.
void dropUnused(RemeshState& state) {
  TriangleMesh& mesh = state.surface.mesh;
  std::vector<std::uint32_t> index(mesh.position.size(), 0);
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) index[v] = 1;
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < index.size(); ++v) {
    if (index[v] == 0) continue;
    index[v] = count;
    if (count != v) {
      keep(state, count, makeVertex(state, v));
      state.isKept[count] = state.isKept[v];
    }
    ++count;
  }
  resize(state, count);
  for (Triangle& t : mesh.triangle)
    for (std::uint32_t& v : t) v = index[v];
}

}  // namespace

PieceRules pieceRules(const CaseSurface& surface, const SeparatedField& field,
                      const Progress& progress) {
  PieceRules rules{field, progress, {}};
  rules.plane.resize(surface.groups.size());
  for (const SurfaceEnd& end : surface.ends)
    if (surface.groups[end.group].kind != FaceKind::Cap) rules.plane[end.group] = end.normal;
  return rules;
}

std::vector<TriangleList> piecesByNode(const CaseSurface& surface) {
  const auto& triangles = surface.mesh.triangle;
  const auto keyOf = [&](std::uint32_t t) {
    return std::min({surface.node[triangles[t][0]], surface.node[triangles[t][1]],
                     surface.node[triangles[t][2]]});
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = {keyOf(t), t};
  std::sort(order.begin(), order.end());
  const std::size_t size = pieceSize(triangles.size());
  std::vector<TriangleList> pieces;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isNewNode = i == 0 || order[i].first != order[i - 1].first;
    const bool isLastPart = order.size() - i < size / 2;
    if (i == 0 || (isNewNode && !isLastPart && pieces.back().size() >= size)) pieces.emplace_back();
    pieces.back().push_back(order[i].second);
  }
  return pieces;
}

std::vector<TriangleList> piecesAround(const TriangleMesh& mesh, std::vector<std::uint8_t> marked,
                                       int rings) {
  if (std::ranges::none_of(marked, [](std::uint8_t one) { return one != 0; })) return {};
  std::vector<std::uint8_t> isTouched(mesh.triangle.size());
  const auto touch = [&] {
    tbb::parallel_for(std::size_t{0}, isTouched.size(), [&](std::size_t f) {
      const Triangle& t = mesh.triangle[f];
      isTouched[f] = marked[t[0]] | marked[t[1]] | marked[t[2]];
    });
  };
  for (int ring = 1; ring < rings; ++ring) {
    touch();
    for (std::size_t f = 0; f < isTouched.size(); ++f)
      if (isTouched[f] != 0)
        for (const std::uint32_t v : mesh.triangle[f]) marked[v] = 1;
  }
  touch();
  std::vector<std::uint32_t> parent(mesh.position.size());
  std::iota(parent.begin(), parent.end(), 0U);
  TriangleList inside;
  for (std::uint32_t f = 0; f < mesh.triangle.size(); ++f) {
    if (isTouched[f] == 0) continue;
    const Triangle& t = mesh.triangle[f];
    inside.push_back(f);
    const std::uint32_t root = findRoot(parent, t[0]);
    parent[findRoot(parent, t[1])] = root;
    parent[findRoot(parent, t[2])] = root;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  for (const std::uint32_t f : inside) order.emplace_back(findRoot(parent, mesh.triangle[f][0]), f);
  std::sort(order.begin(), order.end());
  std::vector<TriangleList> pieces;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isNew = i == 0 || order[i].first != order[i - 1].first;
    if (i == 0 || (isNew && pieces.back().size() >= kLeastTriangles)) pieces.emplace_back();
    pieces.back().push_back(order[i].second);
  }
  return pieces;
}

RemeshPiece cutOut(const RemeshState& state, TriangleList& triangles) {
  const TriangleMesh& mesh = state.surface.mesh;
  LocalMesh local = localMesh(mesh, triangles);
  for (auto pinched = pinchedVertices(local.triangle); !pinched.empty();
       pinched = pinchedVertices(local.triangle)) {
    for (std::uint32_t& v : pinched) v = local.home[v];
    std::erase_if(triangles, [&](std::uint32_t t) {
      return std::ranges::any_of(mesh.triangle[t], [&](std::uint32_t v) {
        return std::binary_search(pinched.begin(), pinched.end(), v);
      });
    });
    local = localMesh(mesh, triangles);
  }
  RemeshPiece piece;
  for (const std::uint32_t v : local.home) piece.vertex.push_back(makeVertex(state, v));
  piece.triangle = std::move(local.triangle);
  for (const std::uint32_t t : triangles) piece.group.push_back(state.surface.group[t]);
  return piece;
}

void putBack(RemeshState& state, std::span<const TriangleList> triangles,
             std::span<const RemeshPiece> pieces) {
  CaseSurface& surface = state.surface;
  std::vector<std::uint8_t> replaced(surface.mesh.triangle.size(), 0);
  for (const TriangleList& list : triangles)
    for (const std::uint32_t t : list) replaced[t] = 1;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < replaced.size(); ++t) {
    if (replaced[t] != 0) continue;
    surface.mesh.triangle[kept] = surface.mesh.triangle[t];
    surface.group[kept++] = surface.group[t];
  }
  surface.mesh.triangle.resize(kept);
  surface.group.resize(kept);
  for (const RemeshPiece& piece : pieces) {
    std::vector<std::uint32_t> index;
    auto next = static_cast<std::uint32_t>(surface.mesh.position.size());
    for (const PieceVertex& vertex : piece.vertex)
      index.push_back(vertex.home == kNewVertex ? next++ : vertex.home);
    resize(state, next);
    for (std::size_t v = 0; v < index.size(); ++v) keep(state, index[v], piece.vertex[v]);
    for (const Triangle& t : piece.triangle)
      surface.mesh.triangle.push_back({index[t[0]], index[t[1]], index[t[2]]});
    surface.group.insert(surface.group.end(), piece.group.begin(), piece.group.end());
  }
  dropUnused(state);
}

}  // namespace lumen::convert
