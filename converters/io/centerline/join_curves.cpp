// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/join_curves.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/geometry/box.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
using Index = std::int32_t;

constexpr double kSameCourse = 0.1;  // radii
// distance, in radii, within which a curve that ends beside another one's axis meets it
constexpr double kMet = 1.0;
constexpr double kStated = -1;             // distance that stands for a stated contact
constexpr double kAsNear = 0.25;           // radii: contacts within this difference are equal
constexpr std::size_t kMostContacts = 16;  // limit; more begin together only where any serves
constexpr double kSamePlace = 1e-3;        // relative to a curve's step

// A place on the axis of a curve.
struct Contact {
  Index curve = -1;
  std::size_t sample = 0;  // the nearer end of the nearest segment
  double distance = std::numeric_limits<double>::infinity();  // in radii
};

double distanceTo(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

class Joiner {
public:
  explicit Joiner(const std::vector<CenterlineCurve>& curves)
      : m_curves(curves), m_reach(curves.size()), m_point(curves.size()), m_box(curves.size()) {
    for (std::size_t c = 0; c < curves.size(); ++c) measure(c);
  }

  CenterlineFile join() {
    for (const CenterlineCurve& curve : m_curves) m_file.vessels.push_back(curve.name);
    const std::size_t count = m_curves.size();
    m_first.resize(count);
    m_last.resize(count);
    for (std::size_t c = 0; c < count; ++c) findContacts(static_cast<Index>(c));
    for (const Index root : roots()) grow(root);
    for (const Index root : byWidth()) grow(root);  // cycles, which have no root
    return std::move(m_file);
  }

private:
  // Measures the largest extent of a curve's lumen from its axis, and its box.
  void measure(std::size_t c) {
    double step = 0, widest = 0;
    const auto& points = m_curves[c].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      widest = std::max(widest, points[i].radius);
      if (i > 0) step = std::max(step, (points[i].position - points[i - 1].position).norm());
      m_box[c].add(points[i].position);
    }
    m_reach[c] = std::max(kMet * widest, kSamePlace * step);
  }

  [[nodiscard]] const std::vector<CurvePoint>& points(Index curve) const {
    return m_curves[std::size_t(curve)].points;
  }

  // All curves but `self` whose lumen contains the point, the nearest axis first.
  [[nodiscard]] std::vector<Contact> contacts(Index self, const CurvePoint& point) const {
    std::vector<Contact> found;
    for (Index c = 0; c < static_cast<Index>(m_curves.size()); ++c) {
      if (c == self || isBeyond(c, point.position)) continue;
      const Contact contact = nearestOn(c, point.position);
      if (contact.distance < kMet) found.push_back(contact);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Contact& a, const Contact& b) { return a.distance < b.distance; });
    if (found.size() > kMostContacts) found.resize(kMostContacts);
    return found;
  }

  [[nodiscard]] bool isBeyond(Index curve, const Vector3d& p) const {
    const Box3d& box = m_box[std::size_t(curve)];
    const double reach = m_reach[std::size_t(curve)];
    return ((box.low - p).array() > reach).any() || ((p - box.high).array() > reach).any();
  }

  [[nodiscard]] Contact nearestOn(Index curve, const Vector3d& p) const {
    const auto& on = points(curve);
    Contact best{curve, 0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < on.size(); ++i) {
      const std::size_t next = std::min(i + 1, on.size() - 1);
      const double step = (on[next].position - on[i].position).norm();
      const double radius =
          std::max({on[i].radius, on[next].radius, kSamePlace * step, 1e-12 * p.norm(), 1e-300});
      const double distance = distanceTo(p, on[i].position, on[next].position) / radius;
      if (distance >= best.distance) continue;
      const bool isNextNearer =
          (on[next].position - p).squaredNorm() < (on[i].position - p).squaredNorm();
      best = {curve, isNextNearer ? next : i, distance};
    }
    return best;
  }

  void findContacts(Index c) {
    if (points(c).empty()) return;
    m_first[std::size_t(c)] = contacts(c, points(c).front());
    m_last[std::size_t(c)] = contacts(c, points(c).back());
    // stated contacts precede geometric ones
    const Index parent = m_curves[std::size_t(c)].parent;
    if (parent < 0 || points(parent).empty()) return;
    m_first[std::size_t(c)] = {nearestOn(parent, points(c).front().position)};
    m_first[std::size_t(c)][0].distance = 0;
    const std::int64_t point = m_curves[std::size_t(c)].parentPoint;
    if (point >= 0 && point < static_cast<std::int64_t>(points(parent).size()))
      m_first[std::size_t(c)][0] = {parent, static_cast<std::size_t>(point), kStated};
  }

  // Curves that begin in no other one; among several that begin together, the first.
  [[nodiscard]] std::vector<Index> roots() const {
    std::vector<Index> found;
    for (const Index c : byWidth())
      if (m_first[std::size_t(c)].empty()) found.push_back(c);
    return found;
  }

  [[nodiscard]] std::vector<Index> byWidth() const {
    std::vector<Index> order;
    for (Index c = 0; c < static_cast<Index>(m_curves.size()); ++c)
      if (!points(c).empty()) order.push_back(c);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      return points(a).front().radius > points(b).front().radius;
    });
    return order;
  }

  [[nodiscard]] bool isPlaced(Index curve) const { return !m_point[std::size_t(curve)].empty(); }

  // The curve and all its descendants, breadth first.
  void grow(Index root) {
    if (isPlaced(root)) return;
    place(root, std::nullopt, false);
    std::vector<Index> open{root};
    for (std::size_t at = 0; at < open.size(); ++at) {
      for (Index c = 0; c < static_cast<Index>(m_curves.size()); ++c) {
        if (isPlaced(c) || points(c).empty()) continue;
        const auto first = contactWith(m_first[std::size_t(c)], open[at]);
        // a root that ends here is reversed; a curve that begins in a later one waits
        const bool isRoot = m_first[std::size_t(c)].empty();
        const auto last = isRoot ? contactWith(m_last[std::size_t(c)], open[at]) : std::nullopt;
        if (!first && !last) continue;
        place(c, first ? first : last, !first);
        open.push_back(c);
      }
    }
  }

  static std::optional<Contact> contactWith(const std::vector<Contact>& contacts, Index curve) {
    for (const Contact& contact : contacts)
      if (contact.curve == curve && contact.distance <= contacts.front().distance + kAsNear)
        return contact;
    return std::nullopt;
  }

  // Adds the points of a curve that do not exist yet.
  void place(Index curve, const std::optional<Contact>& on, bool turned) {
    std::vector<CurvePoint> path = points(curve);
    if (turned) std::reverse(path.begin(), path.end());
    std::vector<Index>& mine = m_point[std::size_t(curve)];
    Index at = kNoPoint;
    if (on) {
      at = m_point[std::size_t(on->curve)][on->sample];
      if (on->distance != kStated) mine = follow(path, at);
      if (!mine.empty()) at = mine.back();
    }
    const std::size_t shared = mine.size();
    for (std::size_t i = shared; i < path.size(); ++i) {
      at = add(path[i], at, curve);
      mine.push_back(at);
    }
    if (on && !turned && shared < path.size()) close(curve, path.size() - shared);
    if (turned) std::reverse(mine.begin(), mine.end());
  }

  Index add(const CurvePoint& point, Index parent, Index vessel) {
    const auto index = static_cast<Index>(m_file.points.size());
    m_file.points.push_back({point.position, point.radius, parent, 0, vessel});
    m_children.emplace_back();
    if (parent != kNoPoint) m_children[std::size_t(parent)].push_back(index);
    return index;
  }

  // The points of the tree along which the beginning of the path runs, from `at` on.
  [[nodiscard]] std::vector<Index> follow(const std::vector<CurvePoint>& path, Index at) const {
    std::vector<Index> same;
    for (const CurvePoint& point : path) {
      at = descend(point.position, at);
      if (offCourse(point.position, at)) break;
      same.push_back(at);
    }
    return same;
  }

  // Descends from a point of the tree to children while the distance decreases.
  [[nodiscard]] Index descend(const Vector3d& p, Index at) const {
    for (;;) {
      Index best = at;
      for (const Index child : m_children[std::size_t(at)])
        if (distance(p, child) < distance(p, best)) best = child;
      if (best == at) return at;
      at = best;
    }
  }
  [[nodiscard]] double distance(const Vector3d& p, Index point) const {
    return (m_file.points[std::size_t(point)].position - p).norm();
  }

  [[nodiscard]] bool offCourse(const Vector3d& p, Index at) const {
    const CenterlinePoint& here = m_file.points[std::size_t(at)];
    double best = distance(p, at);
    const auto look = [&](Index other) {
      best =
          std::min(best, distanceTo(p, here.position, m_file.points[std::size_t(other)].position));
    };
    if (here.parent != kNoPoint) look(here.parent);
    for (const Index child : m_children[std::size_t(at)]) look(child);
    return best > kSameCourse * here.radius + 1e-9 * p.norm();
  }

  // Adds a link from the last of the curve's own points, if it ends in a placed curve, but beside
  // its own course. The last point is dropped if it coincides with that place.
  void close(Index curve, std::size_t own) {
    std::vector<Index>& mine = m_point[std::size_t(curve)];
    Index last = mine.back();
    for (const Contact& end : m_last[std::size_t(curve)]) {
      if (!isPlaced(end.curve)) continue;
      const Index other = m_point[std::size_t(end.curve)][end.sample];
      if (isNear(other, last)) continue;
      const CenterlinePoint& tip = m_file.points[std::size_t(last)];
      if (own > 1 && distance(tip.position, other) <= kSameCourse * tip.radius) {
        const Index before = tip.parent;
        m_children[std::size_t(before)].pop_back();
        m_children.pop_back();
        m_file.points.pop_back();
        mine.back() = other;
        last = before;
      }
      m_file.links.push_back({std::min(other, last), std::max(other, last)});
      return;
    }
  }

  // Whether the path along the tree is short, so that the curve has not left it for another place.
  [[nodiscard]] bool isNear(Index ancestor, Index point) const {
    const CenterlinePoint& end = m_file.points[std::size_t(point)];
    double length = 0;
    const double far = 4 * std::max(end.radius, m_file.points[std::size_t(ancestor)].radius);
    for (Index at = point; at != ancestor;) {
      const Index parent = m_file.points[std::size_t(at)].parent;
      if (parent == kNoPoint || length > far) return false;
      length += distance(m_file.points[std::size_t(at)].position, parent);
      at = parent;
    }
    return true;
  }

  const std::vector<CenterlineCurve>& m_curves;
  std::vector<double> m_reach;
  std::vector<std::vector<Index>> m_point;  // file's index of each point of each placed curve
  std::vector<Box3d> m_box;
  std::vector<std::vector<Contact>> m_first, m_last;
  std::vector<std::vector<Index>> m_children;  // children of the file's points
  CenterlineFile m_file;
};

}  // namespace

CenterlineFile joinCurves(const std::vector<CenterlineCurve>& curves) {
  return Joiner(curves).join();
}

namespace {

// The nearest radius in one direction along the tree, with its distance.
struct Known {
  double radius = 0;
  double distance = std::numeric_limits<double>::infinity();
};

double between(const Known& a, const Known& b) {
  if (b.radius <= 0) return a.radius;
  if (a.radius <= 0) return b.radius;
  const double whole = a.distance + b.distance;
  return whole > 0 ? (a.radius * b.distance + b.radius * a.distance) / whole : a.radius;
}

}  // namespace

void fillRadii(CenterlineFile& file, const std::string& name, const char* expected) {
  const std::size_t missing = file.radiiMissing();
  if (missing == 0) return;
  std::vector<CenterlinePoint>& points = file.points;
  std::vector<Known> above(points.size()), below(points.size());
  const auto step = [&](std::size_t i) {
    return (points[i].position - points[std::size_t(points[i].parent)].position).norm();
  };
  for (std::size_t i = points.size(); i-- > 0;) {
    if (points[i].radius > 0) below[i] = {points[i].radius, 0};
    if (points[i].parent == kNoPoint || below[i].radius <= 0) continue;
    Known& parent = below[std::size_t(points[i].parent)];
    const double distance = below[i].distance + step(i);
    if (distance < parent.distance) parent = {below[i].radius, distance};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].parent != kNoPoint) {
      above[i] = above[std::size_t(points[i].parent)];
      above[i].distance += step(i);
    }
    if (points[i].radius > 0) above[i] = {points[i].radius, 0};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].radius > 0)) points[i].radius = between(above[i], below[i]);
    if (!(points[i].radius > 0))
      throw invalidInput(name + ": has no radius at any point of " +
                         (missing == points.size() ? "it" : "one of its trees") + "; expected " +
                         expected);
  }
  file.remarks.push_back(std::to_string(missing) + " of " + std::to_string(points.size()) +
                         " points have no radius (0 or less); theirs are taken from the points "
                         "before and behind them");
}

}  // namespace lumen::convert
