// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/cut_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/stages/surface/closing/end_cut.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

constexpr double kWideEnough = 0.8;  // radii: narrower is where the field closes the vessel
constexpr int kMoves = 8;            // an eighth of a radius each
constexpr double kReachRadii = 3;    // radii along the branch in which an end's vertices have nodes

// The cuts at one end: one for each surface.
struct Cuts {
  EndPlane plane;
  double moved = 0;  ///< mm
  double width = 0;  ///< radius of the circle of the opening's area, in radii of the vessel
  std::vector<EndCut> cut;
};

std::string quoted(const std::string& label) {
  std::string text = formats::printable(label);
  text.insert(text.begin(), '"');
  return text.append(1, '"');
}

std::string reasonOf(NoCut reason) {
  switch (reason) {
    case NoCut::Before:
      return "the vessel closes before every plane within a radius";
    case NoCut::Other:
      return "another vessel, or a bend, begins behind the plane";
    case NoCut::Handle:
      return "what lies behind the plane is not one rounded end";
    case NoCut::Crooked:
      break;
  }
  return "the rim would cross itself";
}

class EndCutter {
public:
  EndCutter(std::span<const FieldSurface> surfaces, const std::vector<EndPlane>& planes,
            Progress& progress)
      : m_surfaces(surfaces),
        m_source(surfaces[0].field->source()),
        m_planes(planes),
        m_progress(progress) {
    for (const FieldSurface& surface : surfaces) {
      m_fans.emplace_back(*surface.surface);
      m_verticesOf.push_back(verticesNearEnds(*surface.surface));
      surface.surface->groups = {{"wall", FaceKind::Wall}};
      surface.surface->ends.clear();
    }
  }

  EndsReport run() {
    for (const EndPlane& plane : m_planes) {
      m_progress.check();
      m_nodes = nodesNearEnd(m_source, plane, kReachRadii * radiusOf(plane));
      m_reason = NoCut::Other;
      const auto cuts = plane.staysRound ? std::nullopt : findCuts(plane);
      if (cuts)
        closeFlat(plane, *cuts);
      else
        keepRound(plane);
    }
    for (SurfaceFans& fans : m_fans) fans.compact();
    return std::move(m_report);
  }

private:
  [[nodiscard]] double radiusOf(const EndPlane& plane) const {
    return m_source.tree.radius[plane.node];
  }
  [[nodiscard]] const std::string& labelOf(const EndPlane& plane) const {
    return m_source.tree.branches[plane.branch].label;
  }

  // The vertices of the nodes that are near an end.
  std::map<std::uint32_t, std::vector<std::uint32_t>> verticesNearEnds(const CaseSurface& surface) {
    std::vector<bool> isNear(m_source.tree.nodeCount(), false);
    for (const EndPlane& plane : m_planes)
      for (const std::uint32_t node : nodesNearEnd(m_source, plane, kReachRadii * radiusOf(plane)))
        isNear[node] = true;
    std::map<std::uint32_t, std::vector<std::uint32_t>> found;
    for (std::uint32_t v = 0; v < surface.node.size(); ++v)
      if (isNear[surface.node[v]]) found[surface.node[v]].push_back(v);
    return found;
  }

  [[nodiscard]] std::vector<std::uint32_t> candidates(std::size_t surface) const {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t node : m_nodes) {
      const auto found = m_verticesOf[surface].find(node);
      if (found != m_verticesOf[surface].end())
        vertices.insert(vertices.end(), found->second.begin(), found->second.end());
    }
    return vertices;
  }

  // The cuts of all surfaces by one plane; nothing if a cut is impossible, or two are not nested.
  std::optional<Cuts> cutAll(const EndPlane& plane) {
    Cuts cuts;
    cuts.plane = plane;
    for (std::size_t s = 0; s < m_fans.size(); ++s) {
      auto plan = planCut(m_fans[s], *m_surfaces[s].field, plane, m_nodes, candidates(s));
      if (const NoCut* reason = std::get_if<NoCut>(&plan)) {
        m_reason = *reason;
        return std::nullopt;
      }
      cuts.cut.push_back(std::move(std::get<EndCut>(plan)));
      if (s > 0 && !isWithin(cuts.cut[s - 1].loop, cuts.cut[s].loop)) {
        m_reason = NoCut::Crooked;
        return std::nullopt;
      }
    }
    cuts.width = std::sqrt(signedArea(cuts.cut[0].loop) / M_PI) / radiusOf(plane);
    return cuts;
  }

  std::optional<Cuts> findCuts(const EndPlane& plane) {
    std::optional<Cuts> best;
    for (int move = 0; move <= kMoves; ++move) {
      const double distance = move * radiusOf(plane) / kMoves;
      const auto moved = movedInward(m_source, plane, distance);
      if (!moved) break;
      auto cuts = cutAll(*moved);
      if (!cuts || (best && best->width >= cuts->width)) continue;
      cuts->moved = distance;
      best = std::move(cuts);
      if (best->width >= kWideEnough) break;
    }
    return best;
  }

  // A name that no group has yet.
  [[nodiscard]] std::string unique(const std::string& name) const {
    const std::vector<FaceGroup>& groups = m_surfaces[0].surface->groups;
    for (int number = 1;; ++number) {
      std::string candidate = number == 1 ? name : name + "-" + std::to_string(number);
      if (std::none_of(groups.begin(), groups.end(),
                       [&](const FaceGroup& group) { return group.name == candidate; }))
        return candidate;
    }
  }

  std::uint32_t addGroup(const std::string& name, FaceKind kind, const EndPlane& plane) {
    const auto group = static_cast<std::uint32_t>(m_surfaces[0].surface->groups.size());
    const FaceGroup added{unique(name), kind};
    for (const FieldSurface& surface : m_surfaces) {
      surface.surface->groups.push_back(added);
      surface.surface->ends.push_back(
          {group, plane.branch, plane.node, plane.centre, plane.normal});
    }
    return group;
  }

  void closeFlat(const EndPlane& plane, const Cuts& cuts) {
    const auto inlets = std::count_if(m_planes.begin(), m_planes.end(),
                                      [](const EndPlane& other) { return other.isInlet; });
    std::string name = plane.isInlet ? "inlet" : "outlet";
    if (!plane.isInlet || inlets > 1) name += "-" + labelOf(plane);
    const std::uint32_t group =
        addGroup(name, plane.isInlet ? FaceKind::Inlet : FaceKind::Outlet, cuts.plane);
    for (std::size_t s = 0; s < m_fans.size(); ++s)
      applyCut(m_fans[s], cuts.plane, cuts.cut[s], group);
    ++m_report.flat;
    if (cuts.moved > 0)
      m_report.moved.push_back(name + ": cut " + formats::shortText(float(cuts.moved)) +
                               " mm farther in, where the vessel is open");
  }

  // The faces behind the plane, as far as they belong to the end; or those around its tip.
  std::vector<std::uint32_t> findFaces(std::size_t s, const EndPlane& plane) const {
    const SurfaceFans& fans = m_fans[s];
    const CaseSurface& surface = fans.surface();
    bool leaves = false;
    const auto part = partBeyond(fans, plane, m_nodes, candidates(s), leaves);
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t v : part)
      for (const std::uint32_t t : fans.of(v)) {
        const Triangle& corner = surface.mesh.triangle[t];
        if (std::all_of(corner.begin(), corner.end(), [&part](std::uint32_t w) {
              return std::binary_search(part.begin(), part.end(), w);
            }))
          faces.push_back(t);
      }
    if (!faces.empty()) return faces;
    double farthest = 0;
    std::optional<std::uint32_t> tip;
    for (const std::uint32_t v : candidates(s)) {
      const double along = plane.normal.dot(surface.mesh.position[v] - plane.centre);
      if (fans.of(v).empty() || surface.node[v] != plane.node || (tip && along <= farthest))
        continue;
      tip = v;
      farthest = along;
    }
    if (tip) faces.assign(fans.of(*tip).begin(), fans.of(*tip).end());
    return faces;
  }

  void keepRound(const EndPlane& plane) {
    std::string what = plane.isInlet ? "the beginning of branch " : "the end of branch ";
    what += quoted(labelOf(plane));
    const auto faces = findFaces(0, plane);
    if (faces.empty()) {
      m_report.messages.push_back(what + " has no surface: it lies within another vessel");
      return;
    }
    const std::uint32_t group = addGroup("cap-" + labelOf(plane), FaceKind::Cap, plane);
    for (std::size_t s = 0; s < m_fans.size(); ++s)
      for (const std::uint32_t t : s == 0 ? faces : findFaces(s, plane))
        if (m_fans[s].surface().group[t] == 0) m_fans[s].surface().group[t] = group;
    ++m_report.rounded;
    m_report.messages.push_back(what + " stays round: " + reasonOf(m_reason));
  }

  std::span<const FieldSurface> m_surfaces;
  const formats::Case& m_source;
  const std::vector<EndPlane>& m_planes;
  Progress& m_progress;
  std::vector<SurfaceFans> m_fans;
  std::vector<std::map<std::uint32_t, std::vector<std::uint32_t>>> m_verticesOf;
  std::vector<std::uint32_t> m_nodes;  ///< near the end that is being cut
  NoCut m_reason = NoCut::Before;
  EndsReport m_report;
};

// The triangles of flat groups.
bool isFlat(const CaseSurface& surface, std::uint32_t group) {
  const FaceKind kind = surface.groups[group].kind;
  return kind == FaceKind::Inlet || kind == FaceKind::Outlet;
}

}  // namespace

EndsReport cutEnds(std::span<const FieldSurface> surfaces, const std::vector<EndPlane>& planes,
                   Progress& progress) {
  return EndCutter(surfaces, planes, progress).run();
}

EndsReport cutEnds(CaseSurface& surface, const SeparatedField& field, Progress& progress) {
  const std::array<FieldSurface, 1> one{{{&surface, &field}}};
  return cutEnds(one, endPlanes(field.source()), progress);
}

std::vector<std::string> cutLike(CaseSurface& outer, const SeparatedField& field,
                                 CaseSurface& inner, Progress& progress) {
  std::vector<std::string> messages;
  SurfaceFans fans(outer);
  const std::vector<std::uint32_t> nodeOf = outer.node;
  for (const SurfaceEnd& end : inner.ends) {
    FaceGroup& group = inner.groups[end.group];
    if (!isFlat(inner, end.group)) continue;
    progress.check();
    const EndPlane plane{end.branch, end.node, group.kind == FaceKind::Inlet, end.centre,
                         end.normal};
    const auto nodes = nodesNearEnd(field.source(), plane, kReachRadii * field.radius(end.node));
    std::vector<std::uint32_t> candidates;
    for (std::uint32_t v = 0; v < nodeOf.size(); ++v)
      if (std::binary_search(nodes.begin(), nodes.end(), nodeOf[v])) candidates.push_back(v);
    const auto plan = planCut(fans, field, plane, nodes, candidates);
    if (const NoCut* reason = std::get_if<NoCut>(&plan)) {
      messages.push_back("the wall stays closed at " + formats::printable(group.name) + ": " +
                         reasonOf(*reason));
      group.kind = FaceKind::Cap;
    } else {
      applyCut(fans, plane, std::get<EndCut>(plan), end.group);
    }
  }
  fans.compact();
  outer.groups = inner.groups;
  outer.ends = inner.ends;
  return messages;
}

void openEnds(CaseSurface& surface) {
  SurfaceFans fans(surface);
  for (std::uint32_t t = 0; t < surface.group.size(); ++t)
    if (isFlat(surface, surface.group[t])) fans.remove(t);
  fans.compact();
}

std::vector<std::vector<std::uint32_t>> findRims(const CaseSurface& surface) {
  std::vector<std::map<std::uint32_t, std::vector<std::uint32_t>>> edges(surface.groups.size());
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (!isFlat(surface, surface.group[t])) continue;
    const Triangle& corner = surface.mesh.triangle[t];
    for (std::size_t i = 0; i < 3; ++i)
      edges[surface.group[t]][corner[i]].push_back(corner[(i + 1) % 3]);
  }
  std::vector<std::vector<std::uint32_t>> rims;
  for (const SurfaceEnd& end : surface.ends) {
    std::map<std::uint32_t, std::vector<std::uint32_t>>& from = edges[end.group];
    std::map<std::uint32_t, std::uint32_t> next;
    std::vector<std::uint32_t>& rim = rims.emplace_back();
    bool isSimple = true;
    for (const auto& [a, targets] : from)
      for (const std::uint32_t b : targets) {
        const std::vector<std::uint32_t>& back = from[b];
        if (std::find(back.begin(), back.end(), a) == back.end())
          isSimple = next.try_emplace(a, b).second && isSimple;
      }
    if (next.empty()) continue;
    for (std::uint32_t v = next.begin()->first; isSimple && rim.size() < next.size(); v = next[v])
      rim.push_back(v);
    if (!isSimple || rim.size() < 3 || next[rim.back()] != rim[0])
      throw failed("the surface has no simple rim around " +
                   formats::printable(surface.groups[end.group].name));
  }
  return rims;
}

}  // namespace lumen::convert
