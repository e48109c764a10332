// SPDX-License-Identifier: Apache-2.0
// Guidewires that are pushed, pulled and turned at random in cases: steps per second, and whether any leaves the lumen.
//   wire_bench WIRES STEPS THREADS CASE...
// Every 10th step, five places of each element are asked anew, with the cursor of their node, whether they are in the lumen.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <random>
#include <vector>

#include "blob_wire.h"

namespace {

constexpr std::size_t kNodes = 100;
constexpr int kEpisode = 300, kCheckEvery = 10;

struct Vessel {
  blob_model* model = nullptr;
  std::vector<blob_wire_place> places;
};

double random(std::mt19937_64& source, double least, double most) {
  return least + (most - least) * static_cast<double>(source() >> 11) * 0x1p-53;
}

/// Entries three nodes behind each root, along the first children.
Vessel opened(const char* path) {
  Vessel v;
  if (blob_model_open(path, nullptr, &v.model) != BLOB_OK) {
    std::fprintf(stderr, "%s: no case with models\n", path);
    std::exit(1);
  }
  const auto count = static_cast<std::uint32_t>(blob_model_describe(v.model).node_count);
  std::vector<std::uint32_t> child(count, BLOB_NOWHERE);
  for (std::uint32_t i = count; i-- > 0;)
    if (const std::int32_t parent = blob_model_node(v.model, i).parent; parent >= 0)
      child[static_cast<std::uint32_t>(parent)] = i;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t at = i;
    for (int k = 0; k < 3 && at != BLOB_NOWHERE; ++k) at = child[at];
    if (blob_model_node(v.model, i).parent >= 0 || at == BLOB_NOWHERE || child[at] == BLOB_NOWHERE)
      continue;
    const blob_node here = blob_model_node(v.model, at), next = blob_model_node(v.model, child[at]);
    blob_wire_place place{};
    for (int a = 0; a < 3; ++a) {
      place.entry[a] = here.centre[a];
      place.direction[a] = next.centre[a] - here.centre[a];
    }
    if (here.radius > 0.4) v.places.push_back(place);
  }
  return v;
}

struct Tally {
  std::uint64_t places = 0, outside = 0;
  double deepest = -1e9;  ///< mm of the wire's surface in the wall
};

void check(const blob_wires_state& s, std::size_t w, const Vessel& vessel, double radius,
           Tally& tally) {
  for (std::size_t i = 0; i + 1 < s.free[w]; ++i)
    for (int k = 0; k < 5; ++k) {
      double at[3];
      const double* x = s.position + 3 * (w * s.nodes + i);
      for (int a = 0; a < 3; ++a) at[a] = x[a] + 0.2 * k * (x[a + 3] - x[a]);
      std::uint32_t cursor = s.node[w * s.nodes + i];
      blob_sample sample;
      blob_query(vessel.model, BLOB_BLENDED, at, &cursor, &sample);
      tally.places += 1;
      tally.outside += (sample.state & BLOB_INSIDE) == 0 ? 1 : 0;
      if (sample.distance + radius > tally.deepest) tally.deepest = sample.distance + radius;
    }
}

double processorTime() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("Usage: wire_bench WIRES STEPS THREADS CASE...\n", stderr);
    return 2;
  }
  const auto count = static_cast<std::size_t>(std::atoll(argv[1]));
  const int steps = std::atoi(argv[2]);
  std::vector<Vessel> vessels;
  for (int i = 4; i < argc; ++i) vessels.push_back(opened(argv[i]));
  blob_wires* wires = nullptr;
  if (blob_wires_create(count, kNodes, static_cast<std::size_t>(std::atoll(argv[3])), &wires) !=
      BLOB_OK)
    return 1;
  const blob_wires_state state = blob_wires_describe(wires);
  std::mt19937_64 source(1);
  std::vector<std::size_t> vessel(count);
  std::vector<double> push(count), turn(count), drift(count);
  Tally tally;
  const blob_wire_def def = blob_wire_def_default();
  double wall = 0.0, processor = 0.0, in = 0.0;
  std::uint64_t held = 0;
  for (int k = 0; k < steps; ++k) {
    for (std::size_t w = 0; w < count; ++w) {
      if ((static_cast<std::size_t>(k) + w) % kEpisode == 0 || k == 0) {
        held += state.held[w];
        blob_wire_def own = def;
        own.friction = random(source, 0.0, 0.2);
        blob_status status = BLOB_ERROR_RANGE;
        while (status != BLOB_OK) {
          vessel[w] = static_cast<std::size_t>(source() % vessels.size());
          const auto& places = vessels[vessel[w]].places;
          blob_wire_place place = places[source() % places.size()];
          place.inserted = random(source, 0.0, 95.0);
          status = blob_wires_set(wires, w, vessels[vessel[w]].model, &own, &place);
        }
        drift[w] = random(source, -0.2, 0.6);
      }
      push[w] = drift[w] + random(source, -1.0, 1.0);
      turn[w] = random(source, -0.5, 0.5);
      in += state.free[w];
    }
    const auto begin = std::chrono::steady_clock::now();
    const double before = processorTime();
    blob_wires_step(wires, push.data(), turn.data());
    processor += processorTime() - before;
    wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (k % kCheckEvery == 0)
      for (std::size_t w = 0; w < count; ++w)
        check(state, w, vessels[vessel[w]], def.radius, tally);
  }
  const double all = static_cast<double>(count) * steps;
  std::printf(
      "{\"steps\": %.0f, \"steps_per_second\": %.0f, \"processor_us_per_step\": %.1f, "
      "\"nodes_in\": %.1f, "
      "\"held_per_step\": %.4f, \"places\": %llu, \"outside\": %llu, \"deepest_mm\": %.4f}\n",
      all, all / wall, 1e6 * processor / all, in / all, static_cast<double>(held) / all,
      static_cast<unsigned long long>(tally.places), static_cast<unsigned long long>(tally.outside),
      tally.deepest);
  blob_wires_close(wires);
  for (const Vessel& v : vessels) blob_model_close(v.model);
  return tally.outside == 0 ? 0 : 1;
}
