// SPDX-License-Identifier: Apache-2.0
#include "signed_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lumen::bench {
namespace {

using Vector = SignedMesh::Vector;

void add(Vector& sum, const Vector& v, float times) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] += times * v[i];
}

Vector between(const Vector& from, const Vector& to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

Vector unit(const Vector& v) {
  const float length = std::sqrt(dot3(v.data(), v.data()));
  if (!(length > 0)) return {0, 0, 0};
  return {v[0] / length, v[1] / length, v[2] / length};
}

Vector faceNormal(const Vector& a, const Vector& b, const Vector& c) {
  const Vector u = unit(between(a, b)), v = unit(between(a, c));
  return unit({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]});
}

float angleAt(const Vector& at, const Vector& b, const Vector& c) {
  const Vector u = unit(between(at, b)), v = unit(between(at, c));
  return std::acos(std::clamp(dot3(u.data(), v.data()), -1.0f, 1.0f));
}

}  // namespace

void SignedMesh::prepare(const Triangles& mesh) {
  m_mesh = &mesh;
  m_vertex.clear();
  m_edge.clear();
  m_face.clear();
  if (!mesh.closed) return;
  m_vertex.assign(mesh.vertex.size(), Vector{});
  m_edge.assign(3 * mesh.face.size(), Vector{});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> other;
  for (std::size_t f = 0; f < mesh.face.size(); ++f) {
    const auto& corner = mesh.face[f];
    const auto at = [&](std::size_t i) -> const Vector& { return mesh.vertex[corner[i % 3]]; };
    const Vector normal = faceNormal(at(0), at(1), at(2));
    m_face.push_back(normal);
    for (std::size_t i = 0; i < 3; ++i) {
      add(m_vertex[corner[i]], normal, angleAt(at(i), at(i + 1), at(i + 2)));
      add(m_edge[3 * f + i], normal, 1);
      const std::uint32_t from = corner[i], to = corner[(i + 1) % 3];
      const auto [entry, isNew] = other.try_emplace(std::minmax(from, to), 3 * f + i);
      if (isNew) continue;
      add(m_edge[3 * f + i], m_face[entry->second / 3], 1);
      add(m_edge[entry->second], normal, 1);
    }
  }
  for (Vector& v : m_vertex) v = unit(v);
  for (Vector& v : m_edge) v = unit(v);
}

const SignedMesh::Vector& SignedMesh::normalOf(std::uint32_t face, Feature feature) const {
  const auto i = static_cast<std::size_t>(feature);
  if (feature == Feature::Face) return m_face[face];
  if (i < 3) return m_vertex[m_mesh->face[face][i]];
  return m_edge[3 * std::size_t{face} + i - 3];
}

void SignedMesh::answer(const float* p, const float* q, std::uint32_t face, Feature feature,
                        std::size_t i, const Answers& answers) const {
  const float offset[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  const float distance = std::sqrt(dot3(offset, offset));
  float sign = 1;
  Vector pseudo{};
  if (!m_face.empty()) {
    pseudo = normalOf(face, feature);
    sign = dot3(offset, pseudo.data()) < 0 ? -1.0f : 1.0f;
  }
  answers.distance[i] = static_cast<double>(sign * distance);
  if (answers.normal[0] == nullptr) return;
  for (std::size_t k = 0; k < 3; ++k)
    answers.normal[k][i] =
        static_cast<double>(distance > 1e-6f ? sign * offset[k] / distance : pseudo[k]);
}

double SignedMesh::megabytes() const {
  const std::size_t vectors = m_vertex.size() + m_edge.size() + m_face.size();
  return static_cast<double>(vectors * sizeof(Vector)) * 1e-6;
}

}  // namespace lumen::bench
