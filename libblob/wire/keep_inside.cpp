// SPDX-License-Identifier: Apache-2.0
// Places that a step would take out of the lumen go back.
#include <algorithm>

#include "libblob/wire/one_wire.h"

namespace lumen::wire {

namespace {

constexpr int kShifts = 2;  ///< rounds that move nodes to the wall, before others take them back
constexpr int kRounds = 5;
constexpr double kNear = 0.75;  ///< elements: an end that is deeper has its whole element inside
constexpr double kShortest = 0.5, kLongest = 1.5;  ///< elements

/// Puts a node back to where it was before the step.
void takeBack(const WireRows& rows, StepMemory& memory, std::size_t i) {
  if (memory.isBack[i] != 0) return;
  memory.isBack[i] = 1;
  rows.position[i] = memory.before[i];
  rows.node[i] = memory.cursorBefore[i];
  *rows.held += 1;
}

/// Treats a place that is too near to the wall.
void moveBack(const WireSetup& setup, const WireRows& rows, StepMemory& memory, const Place& place,
              int round) {
  const std::size_t last =
      std::min<std::size_t>(place.node + (place.quarter == 0 ? 0 : 1), *rows.free - 1);
  for (std::size_t i = place.node; i <= last; ++i) {
    if (round >= kShifts) takeBack(rows, memory, i);
    if (memory.isBack[i] == 0)
      rows.position[i] = plus(rows.position[i], -place.distance - setup.def.radius, place.normal);
  }
}

/// Adds a place, whose cursor begins at its node's.
void addPlace(const WireSetup& setup, const WireRows& rows, StepMemory& memory, std::size_t node,
              std::uint32_t quarter) {
  const Vec3& next = node + 1 < *rows.free ? rows.position[node + 1] : setup.entry;
  const double share = quarter / static_cast<double>(kQuarters);
  const Vec3 at = plus(plus({}, 1.0 - share, rows.position[node]), share, next);
  memory.places.push_back(
      {static_cast<std::uint32_t>(node), quarter, rows.node[node], at, 0.0, {}});
}

/// Asks at the places from `first` on.
void ask(const WireSetup& setup, StepMemory& memory, std::size_t first) {
  if (first == memory.places.size()) return;
  Place& begin = memory.places[first];
  blob_columns c = blob_columns_default();
  c.count = memory.places.size() - first;
  for (std::size_t a = 0; a < 3; ++a) {
    c.point[a] = &begin.at[a];
    c.normal[a] = &begin.normal[a];
  }
  c.cursor = &begin.cursor;
  c.distance = &begin.distance;
  c.point_stride = c.cursor_stride = c.answer_stride = sizeof(Place);
  blob_query_columns(setup.model, BLOB_BLENDED, &c);
}

bool isTooNear(const WireSetup& setup, const Place& place) {
  return !(place.distance <= -0.5 * setup.def.radius);
}

}  // namespace

bool isWhole(const WireSetup& setup, const WireRows& rows) {
  const double h = setup.def.spacing, least = kShortest * h, most = kLongest * h;
  for (std::size_t i = 0; i < *rows.free; ++i) {
    const Vec3 edge = plus(rows.position[i + 1], -1.0, rows.position[i]);
    const double square = dot(edge, edge);
    if (!(square >= least * least && square <= most * most)) return false;
  }
  return true;
}

void askWall(const WireSetup& setup, const WireRows& rows, StepMemory& memory) {
  const std::size_t count = *rows.free;
  std::vector<Place>& places = memory.places;
  places.clear();
  for (std::size_t i = 0; i < count; ++i) addPlace(setup, rows, memory, i, 0);
  ask(setup, memory, 0);
  for (std::size_t i = 0; i < count; ++i) rows.node[i] = places[i].cursor;
  const double near = -setup.def.radius - kNear * setup.def.spacing;
  for (std::size_t i = 0; i < count; ++i) {
    const bool isNear =
        places[i].distance > near || (i + 1 < count && places[i + 1].distance > near);
    for (std::uint32_t q = 1; q < kQuarters; ++q) {
      if (isNear)
        addPlace(setup, rows, memory, i, q);
      else
        rows.pressing[kQuarters * i + q] = 0.0;
    }
  }
  ask(setup, memory, count);
}

bool isInside(const WireSetup& setup, const WireRows& rows, StepMemory& memory) {
  askWall(setup, rows, memory);
  return std::none_of(memory.places.begin(), memory.places.end(),
                      [&](const Place& place) { return isTooNear(setup, place); });
}

bool keepInside(const WireSetup& setup, const WireRows& rows, StepMemory& memory) {
  std::fill_n(memory.isBack.begin(), *rows.free, std::uint8_t{0});
  for (int round = 0; round < kRounds; ++round) {
    if (isInside(setup, rows, memory)) return true;
    for (const Place& place : memory.places)
      if (isTooNear(setup, place)) moveBack(setup, rows, memory, place, round);
  }
  return isInside(setup, rows, memory);
}

}  // namespace lumen::wire
