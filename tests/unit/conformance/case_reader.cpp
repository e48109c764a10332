// SPDX-License-Identifier: Apache-2.0
// Our reader behind the protocol of spec/conformance/README.md: case_reader < lines
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "formats/case/motion.h"
#include "formats/field/posed_field.h"

namespace {

using namespace lumen::formats;
using lumen::field::BlendedField;
using lumen::field::Jet;
using lumen::field::PosedField;
using lumen::field::Vec;
using nlohmann::json;

/// The power of a point with respect to a node, mm^2.
double power(const CenterlineTree& tree, std::size_t node, const Vec& p) {
  const Vec3f& c = tree.centre[node];
  const double x = p.x - c.x, y = p.y - c.y, z = p.z - c.z, r = tree.radius[node];
  return x * x + y * y + z * z - r * r;
}

/// The field of a case; one without blobs, to find nodes by, where it has no models.
BlendedField fieldOf(const Case& value) {
  if (value.models) return caseField(value);
  BlobbyModels none;
  none.offset.assign(value.tree.nodeCount() + 1, 0);
  return {treeViewOf(value.tree), modelsViewOf(none)};
}

json fieldAnswer(double level, const Jet<1>& f) {
  return {{"value", f.value}, {"gradient", f.gradient}, {"inside", f.value > level}};
}

/// The answer at a time, from the posed field.
json answerAt(const Case& value, const BlendedField& rest, const Vec& p, const json& question) {
  const PosedField field(rest, treeViewOf(value.tree),
                         posesAt(value.tree, *value.motion, question["time"].get<double>()));
  const std::uint32_t node = question.contains("current")
                                 ? field.follow(p, question["current"].get<std::uint32_t>())
                                 : field.locate(p);
  json out = {{"node", node}, {"power", field.power(p, node)}};
  if (!value.models) return out;
  out.update(fieldAnswer(field.level(), field.local(p, node)));
  out["blended"] = fieldAnswer(field.level(), field.blended(p, node));
  return out;
}

json answer(const Case& value, const BlendedField& field, const json& question) {
  const auto xyz = question.at("point").get<std::vector<double>>();
  const Vec p{xyz.at(0), xyz.at(1), xyz.at(2)};
  if (question.contains("time")) return answerAt(value, field, p, question);
  const std::uint32_t node = question.contains("current")
                                 ? field.follow(p, question["current"].get<std::uint32_t>())
                                 : field.locate(p);
  json out = {{"node", node}, {"power", power(value.tree, node, p)}};
  if (!value.models) return out;
  out.update(fieldAnswer(field.level(), field.local(p, node)));
  out["blended"] = fieldAnswer(field.level(), field.blended(p, node));
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

std::string reply(const json& request) {
  const auto value = readCaseFile(request.at("file").get<std::string>());
  if (!value) return refusal(value.error()).dump();
  const BlendedField field = fieldOf(*value);
  json answers = json::array();
  for (const json& question : request.at("questions"))
    answers.push_back(answer(*value, field, question));
  // the case is written by the library's own encoder, so that it is tested too
  std::string found = encodeJson(*value);
  std::replace(found.begin(), found.end(), '\n', ' ');
  return R"({"accepted": true, "answers": )" + answers.dump() + ", \"case\": " + found + "}";
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);)
    std::cout << reply(json::parse(line)) << std::endl;
}
