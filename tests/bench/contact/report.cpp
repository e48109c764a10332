// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

namespace lumen::bench {
namespace {

std::string number(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

double rateOf(const MethodResult& method, std::size_t environments, int threads) {
  for (const Rate& rate : method.rates)
    if (rate.environments == environments && rate.threads == threads) return rate.queriesPerSecond;
  return 0;
}

// The fastest of several rivals of one name: "Embree" has a coherent form too.
double bestOf(const CaseResult& result, const std::string& prefix, std::size_t environments) {
  double best = 0;
  for (const MethodResult& method : result.methods)
    if (method.name.rfind(prefix, 0) == 0) best = std::max(best, rateOf(method, environments, 1));
  return best;
}

std::string rates(const CaseResult& result) {
  std::ostringstream out;
  std::vector<std::size_t> counts;
  for (const Rate& rate : result.methods.front().rates)
    if (rate.threads == 1) counts.push_back(rate.environments);
  out << "| million queries/s |";
  for (const std::size_t n : counts) out << " " << n << " |";
  const std::size_t most = counts.back();
  out << " " << most << ", 2 threads | times libblob's time | MB |\n|---|";
  for (std::size_t i = 0; i < counts.size() + 3; ++i) out << "---:|";
  out << "\n";
  const double own = rateOf(result.methods.front(), most, 1);
  for (const MethodResult& method : result.methods) {
    out << "| " << method.name << " |";
    for (const std::size_t n : counts) out << " " << number(rateOf(method, n, 1) * 1e-6, 3) << " |";
    out << " " << number(rateOf(method, most, 2) * 1e-6, 3) << " | "
        << number(own / rateOf(method, most, 1), 1) << " | " << number(method.megabytes, 1)
        << " |\n";
  }
  if (const double embree = bestOf(result, "Embree", most); embree > 0)
    out << "\nlibblob beside the faster form of Embree, one thread, " << most
        << " environments: " << number(own / embree, 1) << " times\n";
  return out.str();
}

nlohmann::json jsonOf(const MethodResult& method) {
  const Tally& tally = method.tally;
  nlohmann::json rateList = nlohmann::json::array();
  for (const Rate& rate : method.rates)
    rateList.push_back({{"environments", rate.environments},
                        {"threads", rate.threads},
                        {"queries_per_s", std::round(rate.queriesPerSecond)}});
  return {{"name", method.name},
          {"megabytes", method.megabytes},
          {"points", tally.points},
          {"wrong_signs", tally.wrongSigns},
          {"false_contacts", tally.falseContacts},
          {"missed_contacts", tally.missed},
          {"kisses", tally.kisses},
          {"leaks", tally.leaks},
          {"rates", rateList}};
}

}  // namespace

CaseResult describeCase(const Vessel& vessel, const std::vector<Truth>& truth,
                        const formats::CenterlineTree& tree) {
  CaseResult result;
  result.name = vessel.name;
  result.nodes = tree.nodeCount();
  result.triangles = vessel.mesh.face.size();
  result.voxelMm = vessel.voxel;
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] < 0) continue;
    const formats::Vec3f &a = tree.centre[i],
                         &b = tree.centre[static_cast<std::size_t>(tree.parent[i])];
    result.lengthMm += std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  }
  result.points = truth.size();
  for (const Truth& t : truth) {
    result.touching += t.distance + kWireRadius > 0 ? 1U : 0U;
    result.past += t.distance > 0 ? 1U : 0U;
  }
  return result;
}

std::string markdown(const CaseResult& result) {
  std::ostringstream out;
  out << "### " << result.name << "\n\n"
      << result.nodes << " nodes, " << number(result.lengthMm, 0) << " mm, voxels of "
      << number(result.voxelMm, 2) << " mm, " << result.triangles << " triangles. Of "
      << result.points << " points " << result.touching << " touch, " << result.past
      << " are past the wall.\n\n"
      << rates(result) << "\n| of " << result.points
      << " points | wrong signs | false contacts | missed contacts | leaks of "
      << result.methods.front().tally.kisses << " |\n|---|---:|---:|---:|---:|\n";
  for (const MethodResult& method : result.methods)
    out << "| " << method.name << " | " << method.tally.wrongSigns << " | "
        << method.tally.falseContacts << " | " << method.tally.missed << " | " << method.tally.leaks
        << " |\n";
  return out.str();
}

std::string json(const std::vector<CaseResult>& results) {
  nlohmann::json list = nlohmann::json::array();
  for (const CaseResult& result : results) {
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodResult& method : result.methods) methods.push_back(jsonOf(method));
    list.push_back({{"name", result.name},
                    {"nodes", result.nodes},
                    {"triangles", result.triangles},
                    {"length_mm", result.lengthMm},
                    {"voxel_mm", result.voxelMm},
                    {"points", result.points},
                    {"touching", result.touching},
                    {"past", result.past},
                    {"methods", methods}});
  }
  return list.dump(1) + "\n";
}

}  // namespace lumen::bench
