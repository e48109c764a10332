// SPDX-License-Identifier: Apache-2.0
// One wire: its parameters, its rows of the columns of all wires, and its steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libblob/wire/blob_wire.h"
#include "libblob/wire/chain_solver.h"

namespace lumen::wire {

/// Values that do not change between steps.
struct WireSetup {
  const blob_model* model = nullptr;
  blob_wire_def def{};
  Vec3 entry{}, direction{},
      side{};  ///< unit vectors; the bent tip lies towards `side` at rotation 0
  std::uint32_t entryNode = BLOB_NOWHERE;
  double stretch = 0.0, contact = 0.0, drag = 0.0;  ///< N/mm
  bool isPlaced = false;
};

/// The rows of one wire in the columns of all.
struct WireRows {
  std::size_t nodes = 0;
  Vec3* position = nullptr;
  double* pressing = nullptr;  ///< N, of quarter q of element i at kQuarters * i + q
  std::uint32_t* node = nullptr;
  const Vec3* load = nullptr;
  const double* bending = nullptr;  ///< N/mm, EI / h^3 at each node
  const double* curve = nullptr;    ///< mm, h^2 times the curvature at rest
  double* inserted = nullptr;
  double* rotation = nullptr;
  double* force = nullptr;
  double* share = nullptr;  ///< of what is asked for that a step does; less after steps that failed
  std::uint32_t* free = nullptr;
  std::uint32_t* held = nullptr;
};

/// A place on the wire, and the wall there.
struct Place {
  std::uint32_t node = 0;  ///< on the element from this node towards the next one
  std::uint32_t quarter = 0;
  std::uint32_t cursor = 0;
  Vec3 at{};
  double distance = 0.0;  ///< mm, negative in the lumen
  Vec3 normal{};
};

constexpr std::uint32_t kQuarters = 4;  ///< of an element, at whose ends the wall is asked

/// Memory of one thread's step.
struct StepMemory {
  /// Makes room for wires of so many nodes; allocates nothing where there is room.
  void fit(std::size_t nodes) {
    if (before.size() == nodes) return;
    solver.resize(nodes);
    for (std::vector<Vec3>* const column : {&before, &move, &tangent, &rest, &bend})
      column->resize(nodes);
    length.resize(nodes);
    stiffness.resize(nodes);
    cursorBefore.resize(nodes);
    isBack.resize(nodes);
    places.reserve(kQuarters * nodes);
  }
  ChainSolver solver;
  std::vector<Vec3> before, move, tangent, rest, bend;
  std::vector<double> length, stiffness;
  std::vector<std::uint32_t> cursorBefore;
  std::vector<std::uint8_t> isBack;
  std::vector<Place> places;
};

/// Pushes by `push` mm, at most half an element, and turns by `turn` radians.
void stepWire(const WireSetup& setup, const WireRows& rows, StepMemory& memory, double push,
              double turn);

/// Places the nodes from `first` on by the guide, and counts those past the entry.
void placeOnGuide(const WireSetup& setup, const WireRows& rows, std::size_t first);

/// Makes the places of a wire anew and asks for the wall there: all free nodes, and quarters of elements
/// with an end near the wall, the last one towards the entry. Cursors of nodes follow.
void askWall(const WireSetup& setup, const WireRows& rows, StepMemory& memory);

/// Asks for the wall. Whether all places are half the wire's radius inside of the
/// lumen.
bool isInside(const WireSetup& setup, const WireRows& rows, StepMemory& memory);

/// Moves nodes back that isInside() has found not to be: to the wall, or else to where they were
/// before the step. False: that did not suffice.
bool keepInside(const WireSetup& setup, const WireRows& rows, StepMemory& memory);

/// Whether all elements have nearly their length.
bool isWhole(const WireSetup& setup, const WireRows& rows);

}  // namespace lumen::wire
