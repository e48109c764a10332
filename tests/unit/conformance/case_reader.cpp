// SPDX-License-Identifier: Apache-2.0
// Our reader behind the protocol of spec/conformance/README.md: case_reader FILE < questions.json
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/blobby.h"
#include "formats/case/case_file.h"
#include "formats/case/topology.h"

namespace {

using namespace lumen::formats;
using nlohmann::json;

/// The power of a point with respect to a node, mm^2.
double power(const CenterlineTree& tree, std::size_t node, const Vec3d& p) {
  const Vec3f& c = tree.centre[node];
  const double x = p.x - c.x, y = p.y - c.y, z = p.z - c.z, r = tree.radius[node];
  return x * x + y * y + z * z - r * r;
}

std::uint32_t nodeOfPoint(const CenterlineTree& tree, const Vec3d& p) {
  std::uint32_t best = 0;
  for (std::uint32_t node = 1; node < tree.nodeCount(); ++node)
    if (power(tree, node, p) < power(tree, best, p)) best = node;
  return best;
}

/// From a node to its neighbour of smallest power, for as long as that lowers the power.
std::uint32_t walk(const CenterlineTree& tree, const Neighbours& neighbours, std::uint32_t node,
                   const Vec3d& p) {
  for (;;) {
    std::uint32_t best = node;
    for (const std::uint32_t next : neighbours.of(node))
      if (power(tree, next, p) < power(tree, best, p)) best = next;
    if (best == node) return node;
    node = best;
  }
}

json fieldAnswer(const BlobbyModels& models, std::uint32_t node, const Vec3d& p) {
  const FieldValue field = evaluateField(models, node, p);
  return {{"value", field.f},
          {"gradient", {field.gradient.x, field.gradient.y, field.gradient.z}},
          {"inside", field.f > models.isoLevel}};
}

json answer(const Case& value, const Neighbours& neighbours, const json& question) {
  const auto xyz = question.at("point").get<std::vector<double>>();
  const Vec3d p{xyz.at(0), xyz.at(1), xyz.at(2)};
  const std::uint32_t node =
      question.contains("current")
          ? walk(value.tree, neighbours, question["current"].get<std::uint32_t>(), p)
          : nodeOfPoint(value.tree, p);
  json out = {{"node", node}, {"power", power(value.tree, node, p)}};
  if (value.models) out.update(fieldAnswer(*value.models, node, p));
  return out;
}

json refusal(const Issue& error) {
  json out = {{"accepted", false}, {"code", errorName(error.code)}, {"place", error.place()}};
  if (error.pointer) out["pointer"] = *error.pointer;
  // a message may quote bytes of the file that are not UTF-8
  out["message"] =
      json::parse(json(error.message).dump(-1, ' ', true, json::error_handler_t::replace));
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto value = readCaseFile(argv[1]);
  if (!value) {
    std::cout << refusal(value.error()).dump() << '\n';
    return 0;
  }
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  const Neighbours neighbours(value->tree);
  json answers = json::array();
  for (const json& question : json::parse(text))
    answers.push_back(answer(*value, neighbours, question));
  // the case is written by the library's own encoder, so that it is tested too
  std::cout << R"({"accepted": true, "answers": )" << answers.dump()
            << ", \"case\": " << encodeJson(*value) << "}\n";
}
