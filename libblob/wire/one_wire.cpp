// SPDX-License-Identifier: Apache-2.0
#include "libblob/wire/one_wire.h"

#include <algorithm>
#include <cmath>

namespace lumen::wire {

namespace {

constexpr double kLongestMove = 0.5;  ///< elements, of a node in a step
constexpr int kRelaxations = 3;       ///< of a step, besides the first
constexpr double kLeastShare = 1.0 / 64.0;
constexpr double kLeastCell = 0.1;  ///< of an element that bends at the entry

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Adds scale * (v v^T) and `even` times the identity.
void add(Symmetric& m, double even, double scale, const Vec3& v) {
  for (std::size_t a = 0; a < 3; ++a) m[a] += even + scale * v[a] * v[a];
  m[3] += scale * v[0] * v[1];
  m[4] += scale * v[0] * v[2];
  m[5] += scale * v[1] * v[2];
}

/// Moves all nodes along the wire, each towards the place of the one before or after it.
void slide(const WireSetup& setup, const WireRows& rows, StepMemory& memory, double push) {
  const double share = push / setup.def.spacing;
  const std::vector<Vec3>& from = memory.before;
  const std::size_t last = std::min<std::size_t>(*rows.free, rows.nodes - 1);
  for (std::size_t i = 0; i < last; ++i) {
    Vec3 along{};
    if (share < 0.0)
      along = plus(from[i + 1], -1.0, from[i]);
    else if (i > 0)
      along = plus(from[i - 1], -1.0, from[i]);
    else
      along = plus(from[0], -1.0, from[1]);
    rows.position[i] = plus(from[i], std::fabs(share), along);
  }
}

/// Tangents and lengths of elements, i between nodes i + 1 and i; `count` of them.
void measure(const WireRows& rows, StepMemory& memory, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 edge = plus(rows.position[i], -1.0, rows.position[i + 1]);
    memory.length[i] = std::sqrt(dot(edge, edge));
    memory.tangent[i] = plus({}, 1.0 / memory.length[i], edge);
  }
}

/// The second differences of the wire at rest: its curve, in directions that are carried along the
/// wire from the guide without twist (R. Bishop, There is more than one way to frame a curve, 1975).
void carryCurve(const WireSetup& setup, const WireRows& rows, StepMemory& memory,
                std::size_t elements) {
  const Vec3 up = cross(setup.direction, setup.side);
  Vec3 side = plus(plus({}, std::cos(*rows.rotation), setup.side), std::sin(*rows.rotation), up);
  Vec3 along = setup.direction;
  for (std::size_t i = elements; i-- > 0;) {
    const Vec3& t = memory.tangent[i];
    const Vec3 old = side;
    side = plus(side, -dot(side, t) / (1.0 + dot(along, t) + 1e-9), plus(along, 1.0, t));
    along = t;
    if (rows.curve[i + 1] == 0.0) continue;
    const Vec3 mean = plus(old, 1.0, side);
    memory.rest[i + 1] = plus({}, rows.curve[i + 1] / std::sqrt(dot(mean, mean)), mean);
  }
}

/// Stiffness of the bend at each node, N/mm, and times its second difference less that at rest, N. At the
/// entry, the part of a node's cell that is on the guide is rigid.
void measureBends(const WireSetup& setup, const WireRows& rows, StepMemory& memory,
                  std::size_t count) {
  memory.stiffness[0] = 0.0;
  memory.bend[0] = {};
  for (std::size_t i = 1; i <= count; ++i) {
    const double cell = *rows.inserted / setup.def.spacing - static_cast<double>(i) + 0.5;
    const double stiffness =
        cell >= 1.0 ? rows.bending[i] : rows.bending[i] / std::max(cell, kLeastCell);
    const double curve = rows.curve[i] == 0.0 ? 0.0 : std::clamp(cell, 0.0, 1.0);
    const Vec3* x = &rows.position[i];
    memory.stiffness[i] = stiffness;
    for (std::size_t a = 0; a < 3; ++a)
      memory.bend[i][a] =
          stiffness * (x[-1][a] - 2.0 * x[0][a] + x[1][a] - curve * memory.rest[i][a]);
  }
}

/// The matrix and the forces of drag, bending and stretch.
void addElastic(const WireSetup& setup, const WireRows& rows, StepMemory& memory,
                std::size_t count) {
  ChainSolver& s = memory.solver;
  measureBends(setup, rows, memory, count);
  Vec3 pullBefore{};
  double acrossBefore = 0.0, shareBefore = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double kl = i == 0 ? 0.0 : memory.stiffness[i - 1], kh = memory.stiffness[i],
                 kr = memory.stiffness[i + 1];
    const Vec3 left = i == 0 ? Vec3{} : memory.bend[i - 1], &here = memory.bend[i],
               &right = memory.bend[i + 1];
    // stretch of element i: under compression the part of the matrix across it is left out
    const Vec3& t = memory.tangent[i];
    const double length = memory.length[i], h = setup.def.spacing;
    const Vec3 pull = plus({}, setup.stretch * (length - h), t);
    const double across = std::max(setup.stretch * (1.0 - h / length), 0.0),
                 share = setup.stretch - across;
    Symmetric& m = s.diagonal[i];
    m = {};
    add(m, setup.drag + kl + 4.0 * kh + kr + across, share, t);
    if (i > 0) add(m, acrossBefore, shareBefore, memory.tangent[i - 1]);
    Block& next = s.next[i];
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) next[3 * a + b] = -share * t[a] * t[b];
    for (std::size_t a = 0; a < 3; ++a) next[4 * a] -= across + 2.0 * (kh + kr);
    s.second[i] = kr;
    for (std::size_t a = 0; a < 3; ++a)
      memory.move[i][a] =
          rows.load[i][a] - (left[a] - 2.0 * here[a] + right[a]) - pull[a] + pullBefore[a];
    pullBefore = pull;
    acrossBefore = across;
    shareBefore = share;
  }
}

/// Shares of a place's node and of the one after it, which has none on the guide.
std::array<double, 2> sharesOf(const WireRows& rows, const Place& place) {
  const double far = place.quarter / static_cast<double>(kQuarters);
  return {1.0 - far, place.node + 1 < *rows.free ? far : 0.0};
}

/// Contact of a place by a spring on the wall's plane, and friction that creeps until it slides.
void addContact(const WireSetup& setup, const WireRows& rows, StepMemory& memory,
                const Place& place) {
  const double depth = place.distance + setup.def.radius;
  double& pressing = rows.pressing[kQuarters * place.node + place.quarter];
  const double limit = setup.def.friction * pressing;
  pressing = std::max(0.0, setup.contact * depth);
  if (!(depth > 0.0)) return;
  const auto [here, far] = sharesOf(rows, place);
  const std::size_t i = place.node, next = i + (far > 0.0 ? 1 : 0);
  const Vec3& n = place.normal;
  Vec3 force = plus({}, -setup.contact * depth, n);
  Symmetric block{};
  add(block, 0.0, setup.contact, n);
  if (limit > 0.0) {
    Vec3 slip = plus({}, here, plus(rows.position[i], -1.0, memory.before[i]));
    slip = plus(slip, far, plus(rows.position[next], -1.0, memory.before[next]));
    slip = plus(slip, -dot(slip, n), n);
    const double size = std::sqrt(dot(slip, slip));
    const double k = size * setup.contact > limit ? limit / size : setup.contact;
    force = plus(force, -k, slip);
    add(block, k, -k, n);
  }
  memory.move[i] = plus(memory.move[i], here, force);
  for (std::size_t e = 0; e < 6; ++e) memory.solver.diagonal[i][e] += here * here * block[e];
  if (next == i) return;
  memory.move[next] = plus(memory.move[next], far, force);
  for (std::size_t e = 0; e < 6; ++e) memory.solver.diagonal[next][e] += far * far * block[e];
  constexpr std::array<std::size_t, 9> kEntry{0, 3, 4, 3, 1, 5, 4, 5, 2};
  for (std::size_t e = 0; e < 9; ++e) memory.solver.next[i][e] += here * far * block[kEntry[e]];
}

/// The hand's push after the whole of the move: the force on the guide, by which the last element and the
/// last bends hold the wire.
double forceOfHand(const WireSetup& setup, const StepMemory& memory, std::size_t count) {
  const std::size_t last = count - 1;
  const std::vector<Vec3>& move = memory.move;
  const double push = setup.stretch * (setup.def.spacing - memory.length[last] -
                                       dot(memory.tangent[last], move[last]));
  Vec3 bend = plus(memory.bend[last], -1.0, memory.bend[count]);
  bend = plus(bend, -2.0 * memory.stiffness[last] - memory.stiffness[count], move[last]);
  if (last > 0) bend = plus(bend, memory.stiffness[last], move[last - 1]);
  return push * dot(memory.tangent[last], setup.direction) + dot(bend, setup.direction);
}

/// Forces on the wall and at the hand after the whole of the move.
void noteForces(const WireSetup& setup, const WireRows& rows, const StepMemory& memory,
                std::size_t count) {
  for (const Place& place : memory.places) {
    double& pressing = rows.pressing[kQuarters * place.node + place.quarter];
    if (!(pressing > 0.0)) continue;
    const auto [here, far] = sharesOf(rows, place);
    double out = here * dot(place.normal, memory.move[place.node]);
    if (far > 0.0) out += far * dot(place.normal, memory.move[place.node + 1]);
    pressing = std::max(0.0, pressing + setup.contact * out);
  }
  *rows.force = forceOfHand(setup, memory, count);
}

/// One of Newton's steps, with contacts at the places that were asked. Nodes move by `most` mm or less.
void relax(const WireSetup& setup, const WireRows& rows, StepMemory& memory, double most) {
  const std::size_t count = *rows.free;
  measure(rows, memory, count + 1);
  carryCurve(setup, rows, memory, count + 1);
  addElastic(setup, rows, memory, count);
  for (const Place& place : memory.places) addContact(setup, rows, memory, place);
  memory.solver.solve(count, memory.move.data());
  noteForces(setup, rows, memory, count);
  double square = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    square = std::max(square, dot(memory.move[i], memory.move[i]));
  const double share = square > most * most ? most / std::sqrt(square) : 1.0;
  for (std::size_t i = 0; i < count; ++i)
    rows.position[i] = plus(rows.position[i], share, memory.move[i]);
}

/// The balance of the wire after it slid: by one of Newton's steps, and by more while it is outside.
bool settle(const WireSetup& setup, const WireRows& rows, StepMemory& memory) {
  const double most = kLongestMove * setup.def.spacing * *rows.share;
  if (setup.model != nullptr)
    askWall(setup, rows, memory);
  else
    memory.places.clear();
  relax(setup, rows, memory, most);
  for (int round = 0; round < kRelaxations; ++round) {
    if (setup.model == nullptr || isInside(setup, rows, memory)) return true;
    relax(setup, rows, memory, most);
  }
  return keepInside(setup, rows, memory);
}

}  // namespace

void placeOnGuide(const WireSetup& setup, const WireRows& rows, std::size_t first) {
  *rows.free = static_cast<std::uint32_t>(first);
  for (std::size_t i = first; i < rows.nodes; ++i) {
    const double past = *rows.inserted - static_cast<double>(i) * setup.def.spacing;
    rows.position[i] = plus(setup.entry, past, setup.direction);
    if (past > 0.0) *rows.free = static_cast<std::uint32_t>(i + 1);
    rows.node[i] = setup.entryNode;
    for (std::uint32_t q = 0; q < kQuarters; ++q) rows.pressing[kQuarters * i + q] = 0.0;
  }
}

void stepWire(const WireSetup& setup, const WireRows& rows, StepMemory& memory, double push,
              double turn) {
  const double h = setup.def.spacing, limit = setup.def.push_limit;
  if ((push > 0.0 && *rows.force > limit) || (push < 0.0 && *rows.force < -limit)) push = 0.0;
  push *= *rows.share;
  turn *= *rows.share;
  const double insertedBefore = *rows.inserted;
  const std::uint32_t freeBefore = *rows.free;
  *rows.inserted = std::clamp(insertedBefore + push, 0.0, static_cast<double>(rows.nodes - 3) * h);
  *rows.rotation += turn;
  for (std::size_t i = 0; i < rows.nodes; ++i) {
    memory.before[i] = rows.position[i];
    memory.cursorBefore[i] = rows.node[i];
  }
  slide(setup, rows, memory, *rows.inserted - insertedBefore);
  const auto inNow = static_cast<std::uint32_t>(std::ceil(*rows.inserted / h));
  placeOnGuide(setup, rows, std::min(freeBefore, inNow));
  // a node that comes in was at the entry
  for (std::size_t i = freeBefore; i < *rows.free; ++i) memory.before[i] = setup.entry;
  if (*rows.free == 0) {
    *rows.force = 0.0;
    return;
  }
  if (settle(setup, rows, memory) && isWhole(setup, rows)) {
    *rows.share = std::min(1.0, 2.0 * *rows.share);
    return;
  }
  *rows.share = std::max(kLeastShare, 0.5 * *rows.share);
  // the state before the step is inside, with its own nodes on the guide
  *rows.held += *rows.free;
  *rows.inserted = insertedBefore;
  for (std::size_t i = 0; i < freeBefore; ++i) {
    rows.position[i] = memory.before[i];
    rows.node[i] = memory.cursorBefore[i];
  }
  placeOnGuide(setup, rows, freeBefore);
}

}  // namespace lumen::wire
