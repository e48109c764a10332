// SPDX-License-Identifier: Apache-2.0
#include "libblob/wire/blob_wire.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "libblob/wire/one_wire.h"

namespace {

using lumen::wire::StepMemory;
using lumen::wire::Vec3;
using lumen::wire::WireRows;
using lumen::wire::WireSetup;

constexpr std::uint32_t kCookie = 0x77697265;
constexpr double kLongestPush = 0.5;                   // elements
constexpr double kWidestTurn = 3.14159265358979 / 12;  // radians
constexpr double kStretch = 100.0;                     // in stiffnesses of an element's bending
constexpr double kContact = 2.0;
constexpr double kDrag = 1e-5;

bool isIn(double value, double least, double most) {
  return value >= least && value <= most;
}

bool isValid(const blob_wire_def& d) {
  return isIn(d.spacing, 1e-3, 1e3) && isIn(d.radius, 1e-4, 1e3) && isIn(d.bending, 1e-9, 1e12) &&
         isIn(d.tip_bending, 1e-9, 1e12) && isIn(d.tip_length, 0.0, 1e6) &&
         isIn(d.curve_length, 0.0, 1e6) && isIn(d.curve_angle, -100.0, 100.0) &&
         isIn(d.friction, 0.0, 10.0) && isIn(d.push_limit, 0.0, 1e12);
}

double norm(const Vec3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// A unit vector across `along`, the same for equal arguments.
Vec3 sideOf(const Vec3& along) {
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::fabs(along[a]) < std::fabs(along[least])) least = a;
  Vec3 side{};
  for (std::size_t a = 0; a < 3; ++a) side[a] = (a == least ? 1.0 : 0.0) - along[least] * along[a];
  const double size = norm(side);
  for (double& s : side) s /= size;
  return side;
}

}  // namespace

struct blob_wires {
  blob_wires(std::size_t wires, std::size_t nodesOfEach, int threads)
      : count(wires),
        nodes(nodesOfEach),
        arena(threads),
        setups(wires),
        position(wires * nodes),
        load(wires * nodes),
        inserted(wires),
        rotation(wires),
        force(wires),
        share(wires),
        pressing(lumen::wire::kQuarters * wires * nodes),
        bending(wires * nodes),
        curve(wires * nodes),
        node(wires * nodes),
        free(wires),
        held(wires) {
    ownMemory();
  }

  /// The memory of the calling thread, which is made when that first steps a wire.
  StepMemory& ownMemory() {
    StepMemory& own = memory.local();
    own.fit(nodes);
    return own;
  }

  [[nodiscard]] WireRows rows(std::size_t wire) {
    const std::size_t first = wire * nodes;
    return {nodes,         &position[first], &pressing[lumen::wire::kQuarters * first],
            &node[first],  &load[first],     &bending[first],
            &curve[first], &inserted[wire],  &rotation[wire],
            &force[wire],  &share[wire],     &free[wire],
            &held[wire]};
  }

  std::size_t count, nodes;
  tbb::task_arena arena;
  std::vector<WireSetup> setups;
  std::vector<Vec3> position, load;
  std::vector<double> inserted, rotation, force, share, pressing, bending, curve;
  std::vector<std::uint32_t> node, free, held;
  tbb::enumerable_thread_specific<StepMemory> memory;
};

namespace {

/// Stiffness and curve of each node.
void shape(const blob_wire_def& def, std::size_t nodes, double* bending, double* curve) {
  const double h = def.spacing;
  const double bent = std::floor(def.curve_length / h + 0.5);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double at = h * static_cast<double>(i);
    const double share = at < def.tip_length ? at / def.tip_length : 1.0;
    bending[i] = (def.tip_bending + share * (def.bending - def.tip_bending)) / (h * h * h);
    const bool isBent = i > 0 && static_cast<double>(i) <= bent;
    curve[i] = isBent ? 2.0 * h * std::sin(0.5 * def.curve_angle / bent) : 0.0;
  }
}

void step(blob_wires& wires, std::size_t wire, StepMemory& memory, double push, double turn) {
  const WireSetup& setup = wires.setups[wire];
  if (!setup.isPlaced) return;
  const double most = kLongestPush * setup.def.spacing;
  const double count = std::max({2.0, std::ceil(std::fabs(push) / most - 1e-9),
                                 std::ceil(std::fabs(turn) / kWidestTurn - 1e-9)});
  const WireRows rows = wires.rows(wire);
  for (double k = 0.0; k < count; k += 1.0)
    lumen::wire::stepWire(setup, rows, memory, push / count, turn / count);
}

}  // namespace

blob_wire_def blob_wire_def_default(void) noexcept {
  return {1.0, 0.18, 50.0, 2.0, 30.0, 8.0, 0.8, 0.05, 2.0, kCookie};
}

blob_status blob_wires_create(size_t count, size_t nodes, size_t threads,
                              blob_wires** wires) noexcept {
  if (wires == nullptr) return BLOB_ERROR_ARGUMENT;
  *wires = nullptr;
  if (count < 1 || count > 1000000 || nodes < 8 || nodes > 1000 || threads > 4096)
    return BLOB_ERROR_RANGE;
  try {
    *wires = new blob_wires(
        count, nodes,
        threads == 0 ? tbb::this_task_arena::max_concurrency() : static_cast<int>(threads));
  } catch (...) {
    return BLOB_ERROR_MEMORY;
  }
  return BLOB_OK;
}

void blob_wires_close(blob_wires* wires) noexcept {
  delete wires;
}

blob_status blob_wires_set(blob_wires* wires, size_t wire, const blob_model* model,
                           const blob_wire_def* def, const blob_wire_place* place) noexcept {
  if (wires == nullptr || place == nullptr || wire >= wires->count) return BLOB_ERROR_ARGUMENT;
  WireSetup setup;
  setup.model = model;
  setup.def = def == nullptr ? blob_wire_def_default() : *def;
  if (setup.def.cookie != kCookie) return BLOB_ERROR_ARGUMENT;
  std::copy_n(place->entry, 3, setup.entry.begin());
  std::copy_n(place->direction, 3, setup.direction.begin());
  const double size = norm(setup.direction);
  const bool isPlace = isIn(size, 1e-6, 1e6) && isIn(norm(setup.entry), 0.0, 1e6) &&
                       isIn(place->inserted, 0.0, 1e6) && isIn(place->rotation, -1e6, 1e6);
  if (!isValid(setup.def) || !isPlace) return BLOB_ERROR_RANGE;
  for (double& d : setup.direction) d /= size;
  setup.side = sideOf(setup.direction);
  if (model != nullptr) {
    blob_sample sample;
    setup.entryNode = blob_cursor_locate(model, place->entry);
    blob_query(model, BLOB_BLENDED, place->entry, &setup.entryNode, &sample);
    if (!(sample.distance <= -0.5 * setup.def.radius)) return BLOB_ERROR_RANGE;
  }
  const double h = setup.def.spacing, stiffness = setup.def.bending / (h * h * h);
  setup.stretch = kStretch * stiffness;
  setup.contact = kContact * stiffness;
  setup.drag = kDrag * stiffness;
  setup.isPlaced = true;
  wires->setups[wire] = setup;
  const WireRows rows = wires->rows(wire);
  shape(setup.def, wires->nodes, &wires->bending[wire * wires->nodes],
        &wires->curve[wire * wires->nodes]);
  *rows.inserted = *rows.force = 0.0;
  *rows.rotation = place->rotation;
  *rows.share = 1.0;
  std::fill_n(&wires->load[wire * wires->nodes], wires->nodes, Vec3{});
  lumen::wire::placeOnGuide(setup, rows, 0);
  // a wire that does not get there ends where it is
  for (double pushed = 0.0; pushed < place->inserted; pushed += h)
    step(*wires, wire, wires->ownMemory(), std::min(h, place->inserted - pushed), 0.0);
  *rows.held = 0;
  return BLOB_OK;
}

void blob_wires_step(blob_wires* wires, const double* push, const double* turn) noexcept {
  if (wires->count == 1) return step(*wires, 0, wires->ownMemory(), push[0], turn[0]);
  wires->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, wires->count, [&](std::size_t w) {
      step(*wires, w, wires->ownMemory(), push[w], turn[w]);
    });
  });
}

blob_wires_state blob_wires_describe(const blob_wires* wires) noexcept {
  const blob_wires& w = *wires;
  return {w.count,
          w.nodes,
          w.position[0].data(),
          w.inserted.data(),
          w.rotation.data(),
          w.force.data(),
          w.pressing.data(),
          w.node.data(),
          w.free.data(),
          w.held.data(),
          const_cast<double*>(w.load[0].data())};
}
