// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document_packs.h"

#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/geometry/tube_tree_distance.h"
#include "formats/case/case_encoding.h"
#include "viewer/session/document/document_labels.h"
#include "viewer/session/packs/case_pack.h"
#include "viewer/session/packs/mesh_deviation.h"
#include "viewer/session/packs/pack.h"
#include "viewer/session/packs/surface_pack.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kAtOnce = 1024;  // vertices between two looks whether to go on

}  // namespace

Tagged DocumentPacks::casePack(const Moment& now, Progress& progress) {
  if (!now.document.value) return {};
  const std::string tag = std::to_string(now.parts.value);
  {
    const std::lock_guard lock(m_mutex);
    if (m_case.tag == tag) return m_case;
  }
  Tagged made = tagged(tag, viewer::casePack(*now.document.value, true, progress));
  const std::lock_guard lock(m_mutex);
  return m_case = std::move(made);
}

std::shared_ptr<const VolumePack> DocumentPacks::volumePack(const Moment& now, FileRole role,
                                                            std::string& tag) {
  const bool isSecond = role == FileRole::Second, isLabels = role == FileRole::Labels;
  const auto& [document, revision, parts] = now;
  const std::shared_ptr<const OpenLabels>& labels = document.labels;
  const auto volume = isSecond    ? document.second
                      : !isLabels ? document.volume
                      : labels    ? labels->voxels
                                  : nullptr;
  if (!volume) return nullptr;
  tag = std::to_string(isSecond ? parts.second : isLabels ? parts.labels : parts.volume);
  const std::lock_guard lock(m_mutex);
  Packed& packed = isSecond ? m_second : isLabels ? m_labels : m_volume;
  if (packed.volume != volume) {
    VolumeSending sending;
    sending.isLabels = isLabels;
    const auto sent =
        isLabels ? std::make_shared<const convert::Volume>(placesOf(*labels)) : volume;
    packed = {volume, std::make_shared<const VolumePack>(sent, document.labelOf(role), sending)};
  }
  return packed.pack;
}

Tagged proposalsPack(const Moment& now, Progress& progress) {
  if (!now.document.proposals) return {};
  return tagged(std::to_string(now.parts.proposals),
                viewer::casePack(*now.document.proposals, false, progress));
}

Tagged caseFile(const Moment& now) {
  if (!now.document.value) return {};
  const std::vector<std::byte> bytes = formats::encodeBinary(*now.document.value);
  return tagged(std::to_string(now.parts.value),
                {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Tagged meshPack(const Moment& now, int id) {
  for (const OpenMesh& mesh : now.document.meshes)
    if (mesh.id == id) return tagged(std::to_string(id), meshPack(*mesh.mesh));
  return {};
}

Tagged deviationPack(const Moment& now, int id, Progress& progress) {
  if (!now.document.hasModels()) return {};
  for (const OpenMesh& mesh : now.document.meshes) {
    if (mesh.id != id) continue;
    const MeshDeviation made =
        meshDeviation(*now.document.value, mesh.mesh->mesh.position, progress);
    PackWriter pack;
    pack.add("distance_mm", made.distance);
    pack.set("figures", {{"vertices", made.distance.size()},
                         {"median_mm", made.median},
                         {"percentile90_mm", made.percentile90},
                         {"greatest_mm", made.greatest}});
    // the same meshes and the same case have the same distances
    return tagged(std::to_string(id) + "-" + std::to_string(now.parts.meshes) + "-" +
                      std::to_string(now.parts.value),
                  pack.bytes());
  }
  return {};
}

Tagged distancePack(const Moment& now, const std::shared_ptr<const ReadySurface>& surface,
                    const Json& figures, Progress& progress) {
  if (!now.document.truth || !surface) return {};
  const TubeTreeDistance wall(now.document.truth->tree);
  const auto& position = surface->position;
  std::vector<float> distance(position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kAtOnce == 0) progress.check();
    const auto& p = position[v];
    distance[v] =
        static_cast<float>(wall.nearest({double{p[0]}, double{p[1]}, double{p[2]}}).distance);
  });
  PackWriter pack;
  pack.add("distance_mm", distance);
  pack.set("figures", figures);
  // the same surface and the same truth have the same distances
  return tagged(surface->tag + "-" + std::to_string(now.parts.truth), pack.bytes());
}

}  // namespace lumen::viewer
