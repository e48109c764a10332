// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "converters/stages/surface/closing/closed_surface.h"

namespace lumen::bench {
namespace {

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

ContactOptions contactOptions(int argc, char** argv, ContactOptions options) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc)
      options.json = argv[++i];
    else if (argument == "--environments" && i + 1 < argc)
      options.environments = std::stoul(argv[++i]);
    else if (argument == "--turns" && i + 1 < argc)
      options.turns = std::stoi(argv[++i]);
    else
      options.cases.push_back(argument);
  }
  if (options.cases.empty() || options.json.empty() || options.environments == 0)
    throw std::runtime_error("usage: " + std::filesystem::path(argv[0]).filename().string() +
                             " --json FILE [--environments N] [--turns N] CASE...");
  return options;
}

Triangles closedMesh(const formats::Case& source) {
  convert::ClosedSurfaceOptions options;
  options.edge.share = 0.5;
  Progress progress;
  const convert::SurfaceMesh surface =
      convert::closedSurface(source, options, progress).levels.front();
  Triangles result;
  result.closed = true;
  for (const convert::Float3& p : surface.position) result.vertex.push_back({p[0], p[1], p[2]});
  for (const convert::Triangle& t : surface.triangle) result.face.push_back({t[0], t[1], t[2]});
  return result;
}

}  // namespace lumen::bench
