// SPDX-License-Identifier: Apache-2.0
#include "formats/case/json_motion.h"

#include <algorithm>
#include <string>
#include <utility>

#include "formats/view/model_rules.h"

namespace lumen::formats {
namespace {

// Whether there is a row for each time with an entry for each moving node.
bool checkRows(const PoseRows& rows, const MotionRows& motion, const std::string& pointer,
               JsonReadState& state) {
  if (!checkLength(rows.rowEnd.size(), motion.time.size(), pointer, state.issues)) return false;
  std::size_t start = 0;
  for (std::size_t t = 0; t < rows.rowEnd.size(); ++t) {
    const std::size_t found = (rows.rowEnd[t] - start) / static_cast<std::size_t>(rows.width);
    if (!checkLength(found, motion.node.size(), at(pointer, t), state.issues)) return false;
    start = rows.rowEnd[t];
  }
  return true;
}

std::vector<Pose> posesOf(const MotionRows& rows) {
  std::vector<Pose> poses(rows.factor.values.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const float* centre = rows.centre.values.data() + 3 * i;
    poses[i].centre = {centre[0], centre[1], centre[2]};
    std::copy_n(rows.rotation.values.data() + 4 * i, 4, poses[i].rotation.begin());
    poses[i].factor = rows.factor.values[i];
  }
  return poses;
}

}  // namespace

void addMotionSlots(MotionRows& rows, ArraySlots& slots) {
  slots.byPointer.insert({{"/motion/time", {&rows.time}},
                          {"/motion/node", {&rows.node}},
                          {"/motion/centre", {&rows.centre}},
                          {"/motion/rotation", {&rows.rotation}},
                          {"/motion/factor", {&rows.factor}}});
}

Motion readMotion(JsonValue value, const ArraySlots& slots, MotionRows& rows,
                  JsonReadState& state) {
  JsonFields fields(value, "/motion", state);
  Motion motion;
  if (fields.find("period").has_value()) {
    motion.period = fields.real("period");
    if (motion.period == 0)  // which a text leaves out
      state.issues.add(foundIssue(ErrorCode::MotionPeriod, "/motion/period", "0", "more than 0"));
  }
  requireArrays(
      slots,
      {"/motion/time", "/motion/node", "/motion/centre", "/motion/rotation", "/motion/factor"},
      state);
  fields.finish();
  if (state.issues.failed()) return motion;
  if (!checkRows(rows.centre, rows, "/motion/centre", state) ||
      !checkRows(rows.rotation, rows, "/motion/rotation", state) ||
      !checkRows(rows.factor, rows, "/motion/factor", state))
    return motion;
  motion.pose = posesOf(rows);
  motion.time = std::move(rows.time);
  motion.node = std::move(rows.node);
  return motion;
}

}  // namespace lumen::formats
