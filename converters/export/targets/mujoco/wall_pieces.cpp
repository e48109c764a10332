// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/mujoco/wall_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "blob.h"
#include "blob_pose.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/mujoco_text.h"
#include "formats/case/motion.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kFewest = 64;

using Corner = WallCorner;
using Facet = WallFacet;
using Facets = std::vector<Facet>;

/// Point where the plane x[axis] = at cuts the edge; it does not depend on the order of its ends.
Corner cut(const Corner& a, const Corner& b, int axis, double at) {
  const bool ordered = a.position[axis] < b.position[axis];
  const Corner& low = ordered ? a : b;
  const Corner& high = ordered ? b : a;
  const double s = (at - low.position[axis]) / (high.position[axis] - low.position[axis]);
  Corner made{low.position + s * (high.position - low.position),
              low.radius + s * (high.radius - low.radius), low.branch};
  made.position[axis] = at;
  return made;
}

/// Adds the part of a facet on the side of the plane that `sign` states.
void keepSide(const Facet& facet, int axis, double at, double sign, Facets& kept) {
  std::vector<Corner> corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const Corner& from = facet[c];
    const Corner& to = facet[(c + 1) % 3];
    const double a = sign * (from.position[axis] - at), b = sign * (to.position[axis] - at);
    if (a >= 0) corners.push_back(from);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) corners.push_back(cut(from, to, axis, at));
  }
  for (std::size_t c = 2; c < corners.size(); ++c) {
    const Eigen::Vector3d& o = corners[0].position;
    const Eigen::Vector3d area = (corners[c - 1].position - o).cross(corners[c].position - o);
    if (area.norm() > 0) kept.push_back({corners[0], corners[c - 1], corners[c]});
  }
}

/// Amount of wall that runs along a plane beside it: area, times the share of its normal that is
/// across, squared twice.
double wallAlong(const Facets& facets, int axis, double at) {
  double sum = 0;
  for (const Facet& facet : facets) {
    const Eigen::Vector3d& o = facet[0].position;
    constexpr double kBeside = 0.5;  // share of a radius
    if (std::abs(o[axis] - at) > kBeside * facet[0].radius) continue;
    const Eigen::Vector3d area = (facet[1].position - o).cross(facet[2].position - o);
    if (area.norm() > 0) sum += area.norm() * std::pow(area[axis] / area.norm(), 4);
  }
  return sum;
}

struct Cut {
  int axis = 0;
  double at = 0;
};

/// Across the longest side, in its middle third.
Cut bestCut(const Facets& facets, const Eigen::AlignedBox3d& box) {
  Cut best;
  box.sizes().maxCoeff(&best.axis);
  constexpr int kTried = 17;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTried; ++k) {
    const double share = (1 + k / (kTried - 1.0)) / 3;
    const double at = box.min()[best.axis] + share * box.sizes()[best.axis];
    const double along = wallAlong(facets, best.axis, at);
    if (along < least) {
      least = along;
      best.at = at;
    }
  }
  return best;
}

/// The sizes and the rule by which a piece stays whole.
struct Whole {
  std::size_t cells;
  double share;
  const PieceRule& rule;
};

void split(Facets facets, const Whole& whole, std::vector<Facets>& pieces) {
  Eigen::AlignedBox3d box;
  double radius = std::numeric_limits<double>::infinity();
  for (const Facet& facet : facets)
    for (const Corner& corner : facet) {
      box.extend(corner.position);
      radius = std::min(radius, corner.radius);
    }
  const bool fits =
      box.sizes().maxCoeff() <= static_cast<double>(whole.cells) * whole.share * radius;
  const bool isFew = facets.size() <= kFewest;
  if (isFew || (fits && (!whole.rule || whole.rule(facets)))) {
    if (!facets.empty()) pieces.push_back(std::move(facets));
    return;
  }
  const Cut plane = bestCut(facets, box);
  for (const double sign : {-1.0, 1.0}) {
    Facets side;
    for (const Facet& facet : facets) keepSide(facet, plane.axis, plane.at, sign, side);
    split(std::move(side), whole, pieces);
  }
}

SurfaceMesh makeMesh(const Facets& facets) {
  SurfaceMesh mesh;
  mesh.groups = {{"wall", FaceKind::Wall}};
  std::map<Float3, std::uint32_t> known;
  for (const Facet& facet : facets) {
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f p = facet[c].position.cast<float>();
      const Float3 key = {p[0], p[1], p[2]};
      const auto [place, isNew] =
          known.emplace(key, static_cast<std::uint32_t>(mesh.position.size()));
      if (isNew) {
        mesh.position.push_back(key);
        mesh.normal.push_back({0, 0, 0});
        mesh.radius.push_back(static_cast<float>(facet[c].radius));
        mesh.branch.push_back(facet[c].branch);
      }
      triangle[c] = place->second;
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      continue;
    mesh.triangle.push_back(triangle);
    mesh.group.push_back(0);
  }
  return mesh;
}

}  // namespace

std::vector<WallFacet> wallFacets(const SurfaceMesh& mesh) {
  Facets facets(mesh.triangle.size());
  for (std::size_t t = 0; t < facets.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangle[t][c];
      const Float3& p = mesh.position[v];
      facets[t][c] = {{p[0], p[1], p[2]}, mesh.radius[v], mesh.branch[v]};
    }
  return facets;
}

std::vector<SurfaceMesh> cutIntoPieces(const SurfaceMesh& mesh, std::size_t cells, double share,
                                       const PieceRule& rule) {
  std::vector<Facets> pieces;
  split(wallFacets(mesh), {cells, share, rule}, pieces);
  if (pieces.size() == 1) return {mesh};
  std::vector<SurfaceMesh> meshes;
  for (const Facets& piece : pieces) {
    meshes.push_back(makeMesh(piece));
    meshes.back().labels = mesh.labels;
    meshes.back().systems = mesh.systems;
  }
  return meshes;
}

namespace {

constexpr std::size_t kMostWeights = 24;  // libblob's: nodes that answer at a point

field::Vec vecOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void addWords(std::string& text, const std::string& words) {
  text += (text.empty() ? "" : " ") + words;
}

}  // namespace

WallBodies::WallBodies(const formats::Case& source)
    : m_tree(source.tree), m_model(openModels(source)), m_times(source.motion->time) {
  for (const double time : m_times)
    m_poses.push_back(formats::posesAt(source.tree, *source.motion, time));
}

// Where a point of the wall is at each time, m; `node` is set to the one that answers at it.
std::vector<Eigen::Vector3d> WallBodies::wayOf(const Eigen::Vector3d& position,
                                               std::uint32_t& node) const {
  const Eigen::Vector3d mm = position / kMetres;
  node = blob_cursor_locate(m_model.get(), mm.data());
  std::uint32_t nodes[kMostWeights];
  double weights[kMostWeights];
  const std::size_t found =
      std::min(kMostWeights, blob_query_weights(m_model.get(), BLOB_BLENDED, mm.data(), &node,
                                                nodes, weights, kMostWeights));
  std::vector<Eigen::Vector3d> way;
  for (const std::vector<field::NodePose>& poses : m_poses) {
    field::Vec sum{0, 0, 0};
    for (std::size_t k = 0; k < found; ++k)
      sum = sum + weights[k] * field::carried(poses[nodes[k]],
                                              vecOf(toEigen(m_tree.centre[nodes[k]])), vecOf(mm));
    way.emplace_back(kMetres * Eigen::Vector3d(sum.x, sum.y, sum.z));
  }
  return way;
}

RidingBody WallBodies::carrying(std::span<const WallFacet> piece) const {
  const auto corners = static_cast<Eigen::Index>(3 * piece.size());
  Eigen::Matrix3Xd rest(3, corners);
  std::vector<Eigen::Matrix3Xd> moved(m_times.size(), Eigen::Matrix3Xd(3, corners));
  for (Eigen::Index i = 0; i < corners; ++i) {
    const auto at = static_cast<std::size_t>(i);
    rest.col(i) = piece[at / 3][at % 3].position;
    std::uint32_t node = 0;
    const std::vector<Eigen::Vector3d> way = wayOf(rest.col(i), node);
    for (std::size_t t = 0; t < way.size(); ++t) moved[t].col(i) = way[t];
  }
  RidingBody body;
  body.centre = rest.rowwise().mean();
  for (const Eigen::Matrix3Xd& to : moved) {
    const Eigen::Isometry3d fit(Eigen::umeyama(rest, to, false));
    body.turn.emplace_back(fit.linear());
    body.place.push_back(fit * body.centre);
    for (Eigen::Index i = 0; i < corners; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double off = (fit * rest.col(i) - to.col(i)).norm();
      body.misfit = std::max(body.misfit, off / piece[at / 3][at % 3].radius);
    }
  }
  return body;
}

RidingBody WallBodies::carrying(const SurfaceMesh& piece) const {
  return carrying(wallFacets(piece));
}

RidingBody WallBodies::carrying(const Eigen::Vector3d& place) const {
  RidingBody body;
  std::uint32_t node = 0;
  body.centre = place;
  body.place = wayOf(place, node);
  for (const std::vector<field::NodePose>& poses : m_poses) {
    const field::Quaternion& q = poses[node].rotation;
    body.turn.emplace_back(q[3], q[0], q[1], q[2]);
  }
  return body;
}

std::string WallBodies::keyframes(std::span<const RidingBody> bodies) const {
  std::string text;
  for (std::size_t t = 0; t < m_times.size(); ++t) {
    std::string places, turns;
    for (const RidingBody& body : bodies) {
      const Eigen::Quaterniond& q = body.turn[t];
      addWords(places, mujocoNumbers(body.place[t]));
      addWords(turns, mujocoNumbers({q.w(), q.x(), q.y(), q.z()}));
    }
    text += "    <key name=\"motion_" + std::to_string(t) + "\" time=\"" + numberText(m_times[t]) +
            "\" mpos=\"" + places + "\" mquat=\"" + turns + "\"/>\n";
  }
  return text;
}

}  // namespace lumen::convert
