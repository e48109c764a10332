// SPDX-License-Identifier: Apache-2.0
// Session: what the page fetches.
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/geometry/tube_tree_distance.h"
#include "formats/case/binary_encode.h"
#include "viewer/session/case_pack.h"
#include "viewer/session/pack.h"
#include "viewer/session/session.h"
#include "viewer/session/surface_pack.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kAtOnce = 1024;  // vertices between two looks whether to go on

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

Tagged Session::casePack(Progress& progress) {
  const Moment now = m_history.now();
  if (!now.document.value) return {};
  const std::string tag = std::to_string(now.parts.value);
  {
    const std::lock_guard lock(m_mutex);
    if (m_casePack.tag == tag) return m_casePack;
  }
  Tagged made{tag, shared(viewer::casePack(*now.document.value, true, progress))};
  const std::lock_guard lock(m_mutex);
  return m_casePack = std::move(made);
}

Tagged Session::caseFile() {
  const Moment now = m_history.now();
  if (!now.document.value) return {};
  const std::vector<std::byte> bytes = formats::encodeBinary(*now.document.value);
  return {std::to_string(now.parts.value),
          shared({reinterpret_cast<const char*>(bytes.data()), bytes.size()})};
}

Tagged Session::surfacePack(int level, bool quick) {
  const auto surface = quick ? m_surfaces.quick() : m_surfaces.get(level);
  if (!surface) return {};
  return {surface->tag, {surface, &surface->pack}};
}

Tagged Session::finishedSurface(int level, const Progress& progress) {
  m_surfaces.waitFor(level, progress);
  return surfacePack(level, false);
}

Tagged Session::meshPack(int id) {
  const Moment now = m_history.now();
  for (const OpenMesh& mesh : now.document.meshes)
    if (mesh.id == id) return {std::to_string(id), shared(viewer::meshPack(*mesh.mesh))};
  return {};
}

Tagged Session::distancePack(int level, bool quick, Progress& progress) {
  const Moment now = m_history.now();
  if (!now.document.truth) return {};
  const auto surface = quick ? m_surfaces.quick() : m_surfaces.get(level);
  if (!surface) return {};
  const TubeTreeDistance wall(now.document.truth->tree);
  const auto& position = surface->mesh->position;
  std::vector<float> distance(position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kAtOnce == 0) progress.check();
    const auto& p = position[v];
    distance[v] =
        static_cast<float>(wall.nearest({double{p[0]}, double{p[1]}, double{p[2]}}).distance);
  });
  PackWriter pack;
  pack.add("distance", distance);
  const std::lock_guard lock(m_mutex);
  const bool isNew = m_comparedCase == now.document.value && m_comparedTruth == now.document.truth;
  pack.set("figures", isNew ? m_figures : Json(nullptr));
  // the same surface, and the same truth
  return {surface->tag + "-" + std::to_string(now.parts.truth), shared(pack.bytes())};
}

std::shared_ptr<const VolumePack> Session::volumePack(std::string& tag) {
  const Moment now = m_history.now();
  if (!now.document.volume) return nullptr;
  tag = std::to_string(now.parts.volume);
  const std::lock_guard lock(m_mutex);
  if (m_packedVolume != now.document.volume) {
    m_volumePack = std::make_shared<const VolumePack>(now.document.volume,
                                                      now.document.labelOf(FileRole::Volume));
    m_packedVolume = now.document.volume;
  }
  return m_volumePack;
}

}  // namespace lumen::viewer
