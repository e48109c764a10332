// SPDX-License-Identifier: Apache-2.0
// libblob behind the protocol of spec/conformance/README.md, through its public functions alone:
// blob_reader [--doubles] < lines. With --doubles, value and gradient are those of
// blob_query_hessian().
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "blob_pose.h"

namespace {

using nlohmann::json;

/// Why there is no model: the codes that the protocol names, and for all else the status.
json refusal(blob_status status, const char* message) {
  json out = {{"accepted", false}, {"code", "STATUS_" + std::to_string(status)}};
  if (status == BLOB_ERROR_NO_MODELS) out["code"] = "NO_MODELS";
  if (status == BLOB_ERROR_ENCODING) out["code"] = "CHUNK_ENCODING";
  // a message may quote bytes of the file that are not UTF-8
  out["message"] = json::parse(json(message).dump(-1, ' ', true, json::error_handler_t::replace));
  return out;
}

/// Value, gradient and `inside` at a point; the cursor is moved. With the node, as "node".
json sampled(const blob_model* model, std::uint32_t flags, const double* point,
             std::uint32_t& cursor) {
  blob_sample s;
  blob_query(model, flags, point, &cursor, &s);
  return {{"node", s.node},
          {"value", s.value},
          {"gradient", s.gradient},
          {"inside", (s.state & BLOB_INSIDE) != 0}};
}

json differentiated(const blob_model* model, std::uint32_t flags, const double* point,
                    std::uint32_t& cursor) {
  blob_hessian s;
  blob_query_hessian(model, flags, point, &cursor, &s);
  return {{"node", cursor},
          {"value", s.value},
          {"gradient", s.gradient},
          {"inside", blob_inside(model, flags, point, &cursor) != 0}};
}

/// A model at rest, and at any time of its motion if it has one.
class Moving {
public:
  Moving(const char* file, const blob_model* rest) : m_rest(rest) {
    blob_motion* motion = nullptr;
    blob_pose* pose = nullptr;
    if (blob_motion_open(file, nullptr, &motion) != BLOB_OK) return;
    m_motion.reset(motion);
    blob_pose_def def = blob_pose_def_default();
    def.renew = 0;  // neighbours are those of the case at rest
    if (blob_pose_create(rest, &def, &pose) == BLOB_OK) m_pose.reset(pose);
  }
  const blob_model* at(const json& question) {
    if (!question.contains("time")) return m_rest;
    blob_pose_set_time(m_pose.get(), m_motion.get(), question["time"].get<double>(), nullptr);
    return blob_pose_model(m_pose.get());
  }

private:
  struct Closer {
    void operator()(blob_motion* motion) const { blob_motion_close(motion); }
    void operator()(blob_pose* pose) const { blob_pose_close(pose); }
  };
  const blob_model* m_rest;
  std::unique_ptr<blob_motion, Closer> m_motion;
  std::unique_ptr<blob_pose, Closer> m_pose;
};

/// Both fields are asked from where the point came from, so that either has to follow.
json answer(const blob_model* model, bool doubles, const json& question) {
  const auto point = question.at("point").get<std::vector<double>>();
  const std::uint32_t start = question.value("current", BLOB_NOWHERE);
  const auto query = doubles ? differentiated : sampled;
  std::uint32_t local = start, blended = start;
  json out = query(model, BLOB_LOCAL, point.data(), local);
  out["blended"] = query(model, BLOB_BLENDED, point.data(), blended);
  if (local != blended) out["node"] = nullptr;
  return out;
}

json reply(const std::string& file, bool doubles, const json& questions) {
  char message[512] = "";
  blob_open_def how = blob_open_def_default();
  how.message = message;
  how.message_size = sizeof message;
  blob_model* model;
  const blob_status status = blob_model_open(file.c_str(), &how, &model);
  if (status != BLOB_OK) return refusal(status, message);
  json answers = json::array();
  {
    Moving moving(file.c_str(), model);
    for (const json& question : questions)
      answers.push_back(answer(moving.at(question), doubles, question));
  }
  blob_model_close(model);
  return {{"accepted", true}, {"answers", answers}};
}

}  // namespace

int main(int argc, char** argv) {
  const bool doubles = argc == 2 && std::string_view(argv[1]) == "--doubles";
  if (argc != 1 && !doubles) return 2;
  for (std::string line; std::getline(std::cin, line);) {
    const json request = json::parse(line);
    std::cout << reply(request.at("file"), doubles, request.at("questions")) << std::endl;
  }
}
