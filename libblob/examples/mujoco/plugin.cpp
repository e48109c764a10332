// SPDX-License-Identifier: Apache-2.0
// libblob as a plugin of MuJoCo 3 (capability SDF): a vessel without triangles as a geom.
//
//   <extension><plugin plugin="lumen.sdf.vessel"><instance name="v">
//     <config key="file" value="/folder/head.lumen"/><config key="unit" value="0.001"/>
//   </instance></plugin></extension>
//   <asset><mesh name="v"><plugin instance="v"/></mesh></asset>
//   <geom type="sdf" mesh="v"><plugin instance="v"/></geom>
//
// `unit` is the model's length of a millimetre, 0.001 by default. Everything outside of the lumen
// is solid. The engine queries a point without a tool, so no cursor is kept: where vessels touch,
// the nearer one answers. The collision functions for MuJoCo 2 (vessel.c) know the tool and keep
// its cursor.
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "wall.h"

namespace {

constexpr const char* kAttributes[] = {"file", "unit"};
constexpr double kMetres = 0.001;
constexpr double kAround = 5;  // mm of wall around the vessels' box

struct CloseModel {
  void operator()(blob_model* model) const { blob_model_close(model); }
};

/// List of vessels, which stay open from the first use on. The engine refers to a mesh before there
/// is an instance, by numbers only: the number is the place in this list, which never shrinks.
class Vessels {
public:
  /// The place of the vessel, or -1 if it cannot be opened; the engine warns then.
  int find(const std::string& file, double unit) {
    const std::lock_guard lock(m_mutex);
    const auto key = std::make_pair(file, unit);
    if (const auto known = m_place.find(key); known != m_place.end()) return known->second;
    blob_model* opened = nullptr;
    const blob_status status = blob_model_open(file.c_str(), nullptr, &opened);
    if (status != BLOB_OK) {
      mju_warning("lumen.sdf.vessel: %s: %s", file.c_str(), blob_status_text(status));
      return -1;
    }
    m_models.emplace_back(opened);
    m_walls.push_back(std::make_unique<wall>(wall{opened, unit}));
    return m_place[key] = static_cast<int>(m_walls.size()) - 1;
  }
  const wall* at(int place) {
    const std::lock_guard lock(m_mutex);
    return place >= 0 && place < static_cast<int>(m_walls.size())
               ? m_walls[static_cast<std::size_t>(place)].get()
               : nullptr;
  }

private:
  std::mutex m_mutex;
  std::map<std::pair<std::string, double>, int> m_place;
  std::vector<std::unique_ptr<blob_model, CloseModel>> m_models;
  std::vector<std::unique_ptr<wall>> m_walls;
};

Vessels& vessels() {
  static Vessels all;
  return all;
}

double unitOf(const char* text) {
  const double unit = text == nullptr || *text == 0 ? kMetres : std::strtod(text, nullptr);
  return unit > 0 ? unit : kMetres;
}

int init(const mjModel* m, mjData* d, int instance) {
  const char* file = mj_getPluginConfig(m, instance, "file");
  const int place =
      vessels().find(file == nullptr ? "" : file, unitOf(mj_getPluginConfig(m, instance, "unit")));
  d->plugin_data[instance] = reinterpret_cast<uintptr_t>(vessels().at(place));
  return place < 0 ? -1 : 0;
}

/// The gap: positive in the lumen, where the engine has no solid; mjMAXVAL without a vessel.
mjtNum gapAt(const wall* w, const mjtNum point[3]) {
  std::uint32_t cursor = BLOB_NOWHERE;
  return w == nullptr ? mjMAXVAL : wall_at(w, point, &cursor).gap;
}

mjtNum distanceOf(const mjtNum point[3], const mjData* d, int instance) {
  return gapAt(reinterpret_cast<const wall*>(d->plugin_data[instance]), point);
}

void gradientOf(mjtNum gradient[3], const mjtNum point[3], const mjData* d, int instance) {
  const auto* w = reinterpret_cast<const wall*>(d->plugin_data[instance]);
  std::uint32_t cursor = BLOB_NOWHERE;
  const wall_answer answer = wall_at(w, point, &cursor);
  for (int a = 0; a < 3; ++a) gradient[a] = -answer.normal[a];
}

void attributesOf(mjtNum attribute[], const char* name[], const char* value[]) {
  std::string file;
  double unit = kMetres;
  for (int k = 0; k < 2; ++k) {
    if (std::strcmp(name[k], "file") == 0 && value[k] != nullptr) file = value[k];
    if (std::strcmp(name[k], "unit") == 0) unit = unitOf(value[k]);
  }
  attribute[0] = vessels().find(file, unit);
  attribute[1] = unit;
}

mjtNum staticDistanceOf(const mjtNum point[3], const mjtNum* attributes) {
  return gapAt(vessels().at(static_cast<int>(attributes[0])), point);
}

void boundingBox(mjtNum box[6], const mjtNum* attributes) {
  const wall* w = vessels().at(static_cast<int>(attributes[0]));
  for (int a = 0; a < 6; ++a) box[a] = a < 3 ? 0 : 1;
  if (w != nullptr) wall_box(w, kAround * w->unit, box);
}

void registerVessel() {
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = "lumen.sdf.vessel";
  plugin.capabilityflags |= mjPLUGIN_SDF;
  plugin.nattribute = 2;
  plugin.attributes = kAttributes;
  plugin.nstate = [](const mjModel*, int) { return 0; };
  plugin.init = init;
  plugin.destroy = [](mjData* d, int instance) { d->plugin_data[instance] = 0; };
  plugin.reset = [](const mjModel*, mjtNum*, void*, int) {};
  plugin.compute = [](const mjModel*, mjData*, int, int) {};
  plugin.sdf_distance = distanceOf;
  plugin.sdf_gradient = gradientOf;
  plugin.sdf_staticdistance = staticDistanceOf;
  plugin.sdf_attribute = attributesOf;
  plugin.sdf_aabb = boundingBox;
  mjp_registerPlugin(&plugin);
}

// Registers the plugin without the engine's macro, whose arguments changed from version to version.
__attribute__((constructor)) void onLoad() {
  registerVessel();
}

}  // namespace
