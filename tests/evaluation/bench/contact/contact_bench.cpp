// SPDX-License-Identifier: Apache-2.0
// Thousands of guidewires in one vessel: one step of contact queries by libblob and by what others use, and
// what each gets wrong. docs/benchmarks.md says what is counted.
//
//   contact_bench --json FILE [--environments N] [--turns N] CASE...
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "exact_field.h"
#include "measure.h"
#include "report.h"
#include "tally.h"
#include "vessel.h"
#include "wires.h"

namespace lumen::bench {
namespace {

Methods allMethods() {
  Methods methods;
  methods.push_back(blobMethod("libblob", BLOB_BLENDED, BlobCall::Columns));
  methods.push_back(blobMethod("libblob LOCAL", BLOB_LOCAL, BlobCall::Columns));
  methods.push_back(blobMethod("libblob EXACT", BLOB_DISTANCE_EXACT, BlobCall::Columns));
#ifdef LUMEN_BENCH_EMBREE
  addEmbree(methods, false);
  addEmbree(methods, true);
#endif
#ifdef LUMEN_BENCH_FCL
  addFcl(methods, true);
#endif
#ifdef LUMEN_BENCH_OPENVDB
  addOpenVdb(methods);
#endif
  addGrid(methods);
  return methods;
}

std::vector<std::size_t> environmentCounts(std::size_t most) {
  std::vector<std::size_t> counts;
  for (const std::size_t n : {std::size_t{1}, std::size_t{64}, std::size_t{1024}})
    if (n < most) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

// Every method follows the wires that are judged from the first frame to the last.
Tally judge(Method& method, const Wires& wires, const std::vector<Truth>& truth,
            const std::vector<Kiss>& kisses) {
  const std::size_t judged = truth.size() / wires.points;
  AnswerBuffer answers(wires.count());
  placeWires(method, wires, judged);
  Stepper stepper(method, wires, 0, judged, answers);
  while (stepper.frame() + 1 < wires.frames()) stepper.step();
  Tally tally;
  countWires(truth, answers.distance(), tally);
  countLeaks(method, kisses, tally);
  return tally;
}

CaseResult runCase(const std::string& file, const ContactOptions& options) {
  constexpr double kMostCells = 1e8, kEnough = 2;
  constexpr std::size_t kJudged = 1024, kRays = 100000, kMostKisses = 20000;
  OwnedVessel owned = openVessel(readCase(file), std::filesystem::path(file).stem().string());
  Vessel& vessel = owned.vessel;
  vessel.mesh = closedMesh(owned.source);
  vessel.gridCell = gridCell(vessel.model, 0.5 * vessel.voxel, kMostCells);
  std::cerr << vessel.name << ": " << vessel.mesh.face.size() << " triangles\n";
  const ExactField exact(owned.source);
  WireOptions load;
  load.environments = options.environments;
  const Wires wires = makeWires(owned.source.tree, vessel.model, load);
  if (wires.count() == 0) throw std::runtime_error(file + ": no vessel has two nodes");
  const std::vector<Truth> truth =
      computeTruth(exact, wires, wires.frames() - 1, std::min(kJudged, wires.environments));
  const std::vector<Kiss> kisses = findKisses(exact, owned.source.tree, kRays, kMostKisses);
  std::cerr << "  " << truth.size() << " points, " << kisses.size() << " kisses\n";

  CaseResult result = describeCase(vessel, truth, owned.source.tree);
  Methods methods = allMethods();
  std::vector<Contest> contests;
  for (const auto& method : methods) {
    method->prepare(vessel);
    MethodResult row;
    row.name = method->name();
    row.megabytes = method->megabytes();
    row.tally = judge(*method, wires, truth, kisses);
    result.methods.push_back(row);
    std::cerr << "  " << row.name << ": " << row.tally.wrongSigns << " wrong signs, "
              << row.tally.leaks << " leaks\n";
  }
  for (const std::size_t environments : environmentCounts(options.environments))
    for (const auto& method : methods) contests.push_back({method.get(), environments, 1, 0, 0});
  for (const auto& method : methods)
    contests.push_back({method.get(), options.environments, 2, 0, 0});
  measure(contests, wires, options.turns, kEnough);
  for (std::size_t i = 0; i < contests.size(); ++i)
    result.methods[i % methods.size()].rates.push_back(
        {contests[i].environments, contests[i].threads, contests[i].queriesPerSecond});
  return result;
}

int run(int argc, char** argv) {
  const ContactOptions options = contactOptions(argc, argv, {});
  std::vector<CaseResult> results;
  for (const std::string& file : options.cases) {
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
  } catch (const std::exception& error) {
    std::cerr << "contact_bench: " << error.what() << "\n";
    return 1;
  }
}
