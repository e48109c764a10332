// SPDX-License-Identifier: Apache-2.0
// Thousands of guidewires in one vessel on a graphics processor: one step of contact queries by
// libblob, by the nearest point of a mesh and by a texture, and what each gets wrong.
// docs/benchmarks.md says what is counted.
//
//   contact_cuda --json FILE [--environments N] [--turns N] CASE...
//
// Points and answers stay on the device, and so does what is measured: the events of its stream.
// Exit code 77: there is no device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "device_methods.h"
#include "exact_field.h"
#include "report.h"
#include "tally.h"
#include "vessel.h"
#include "wires.h"

namespace lumen::bench {
namespace {

using cuda_device::Column;
using cuda_device::Device;

/// Frames of wires on the device.
using Frames = std::vector<Column<float>>;

Frames upload(const Wires& wires) {
  Frames frames;
  for (const std::vector<double>& position : wires.position)
    frames.emplace_back(std::vector<float>(position.begin(), position.end()));
  return frames;
}

// Frame of a step: forth and back through all frames, so that no point jumps.
std::size_t frameOf(std::size_t step, std::size_t frames) {
  const std::size_t turn = 2 * (frames - 1), at = frames > 1 ? step % turn : 0;
  return at < frames ? at : turn - at;
}

// Queries per second of steps that take some fifty milliseconds together.
double rateOf(DeviceMethod& method, const Wires& wires, const Frames& frames,
              std::size_t environments) {
  constexpr double kTurn = 0.05;  // seconds
  constexpr std::size_t kMostSteps = 2000;
  const std::size_t count = environments * wires.points;
  method.place({count, wires.position[0].data(), wires.station[0].data()});
  std::size_t step = 0;
  const auto go = [&] {
    method.step(frames[frameOf(step, frames.size())].data(), count);
    ++step;
  };
  go();  // of cold caches, and of searches that have no step before
  const double once = Device::get().seconds(go);
  const auto steps = static_cast<std::size_t>(
      std::clamp(std::ceil(kTurn / once), 1.0, static_cast<double>(kMostSteps)));
  const double seconds = Device::get().seconds([&] {
    for (std::size_t i = 0; i < steps; ++i) go();
  });
  return static_cast<double>(steps * count) / seconds;
}

// Every method follows the wires that are judged from the first frame to the last.
Tally judge(DeviceMethod& method, const Wires& wires, const std::vector<Truth>& truth,
            const std::vector<Kiss>& kisses) {
  std::vector<double> distance(truth.size());
  method.place({truth.size(), wires.position[0].data(), wires.station[0].data()});
  for (const std::vector<double>& position : wires.position)
    method.query(0, position.data(), truth.size(), {distance.data(), {}});
  Tally tally;
  countWires(truth, distance.data(), tally);
  countLeaks(method, kisses, tally);
  return tally;
}

DeviceMethods allMethods() {
  DeviceMethods methods;
  methods.push_back(cudaBlob("libblob", BLOB_BLENDED));
  methods.push_back(cudaBlob("libblob LOCAL", BLOB_LOCAL));
  methods.push_back(cudaBlob("libblob EXACT", BLOB_DISTANCE_EXACT));
  methods.push_back(cudaMesh(false));
  methods.push_back(cudaMesh(true));
  methods.push_back(cudaGrid());
  return methods;
}

std::vector<std::size_t> environmentCounts(std::size_t most) {
  std::vector<std::size_t> counts;
  for (const std::size_t n : {std::size_t{1}, std::size_t{64}, std::size_t{4096}})
    if (n < most) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

CaseResult runCase(const std::string& file, const ContactOptions& options) {
  constexpr double kMostCells = 1e8;
  constexpr std::size_t kJudged = 1024, kRays = 100000, kMostKisses = 20000;
  OwnedVessel owned = openVessel(readCase(file), std::filesystem::path(file).stem().string());
  Vessel& vessel = owned.vessel;
  vessel.mesh = closedMesh(owned.source);
  vessel.gridCell = gridCell(vessel.model, 0.5 * vessel.voxel, kMostCells);
  const ExactField exact(owned.source);
  WireOptions load;
  load.environments = options.environments;
  const Wires wires = makeWires(owned.source.tree, vessel.model, load);
  if (wires.count() == 0) throw std::runtime_error(file + ": no vessel has two nodes");
  const std::vector<Truth> truth =
      computeTruth(exact, wires, wires.frames() - 1, std::min(kJudged, wires.environments));
  const std::vector<Kiss> kisses = findKisses(exact, owned.source.tree, kRays, kMostKisses);
  const Frames frames = upload(wires);

  CaseResult result = describeCase(vessel, truth, owned.source.tree);
  for (const auto& method : allMethods()) {
    method->prepare(vessel);
    MethodResult row;
    row.name = method->name();
    row.megabytes = method->megabytes();
    row.tally = judge(*method, wires, truth, kisses);
    for (const std::size_t environments : environmentCounts(options.environments)) {
      Rate rate{environments, 1, 0};
      for (int turn = 0; turn < options.turns; ++turn)
        rate.queriesPerSecond =
            std::max(rate.queriesPerSecond, rateOf(*method, wires, frames, environments));
      row.rates.push_back(rate);
      std::cerr << "  " << row.name << ", " << environments
                << " environments: " << std::round(rate.queriesPerSecond * 1e-6)
                << " million queries/s\n";
    }
    result.methods.push_back(row);
  }
  return result;
}

int run(int argc, char** argv) {
  const ContactOptions options = contactOptions(argc, argv, {"", 65536, 5, {}});
  std::cerr << Device::get().name() << "\n";
  std::vector<CaseResult> results;
  for (const std::string& file : options.cases) {
    std::cerr << file << "\n";
    results.push_back(runCase(file, options));
    std::ofstream(options.json) << json(results);
  }
  return 0;
}

}  // namespace
}  // namespace lumen::bench

int main(int argc, char** argv) {
  try {
    return lumen::bench::run(argc, argv);
  } catch (const lumen::cuda_device::NoDevice& none) {
    std::cerr << "contact_cuda: " << none.what() << "\n";
    return 77;
  } catch (const std::exception& error) {
    std::cerr << "contact_cuda: " << error.what() << "\n";
    return 1;
  }
}
