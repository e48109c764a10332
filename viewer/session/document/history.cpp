// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/history.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lumen::viewer {

namespace {

bool sameMeshes(const Document& a, const Document& b) {
  return std::equal(a.meshes.begin(), a.meshes.end(), b.meshes.begin(), b.meshes.end(),
                    [](const OpenMesh& m, const OpenMesh& n) { return m.mesh == n.mesh; });
}

/// Another role of a label leaves the voxels as they are.
std::shared_ptr<const convert::Volume> voxelsOfLabels(const Document& document) {
  return document.labels ? document.labels->voxels : nullptr;
}

}  // namespace

Moment History::now() const {
  const std::lock_guard lock(m_mutex);
  return m_now;
}

void History::replace(Document document) {
  const Document& old = m_now.document;
  PartRevisions& parts = m_now.parts;
  parts.value += document.value != old.value;
  parts.volume += document.volume != old.volume;
  parts.second += document.second != old.second;
  parts.labels += voxelsOfLabels(document) != voxelsOfLabels(old);
  parts.seeds += document.seeds != old.seeds;
  parts.proposals += document.proposals != old.proposals;
  parts.truth += document.truth != old.truth;
  parts.meshes += !sameMeshes(document, old);
  m_now.document = std::move(document);
  ++m_now.revision;
}

std::optional<std::uint64_t> History::commit(const std::string& name, std::uint64_t from,
                                             Document document) {
  const std::lock_guard lock(m_mutex);
  if (from != m_now.revision) return std::nullopt;
  m_redo.clear();
  m_undo.push_back({name, m_now.document});
  replace(std::move(document));
  forget();
  return m_now.revision;
}

void History::forget() {
  const auto bytes = [this] {
    std::vector<const Document*> all{&m_now.document};
    for (const Entry& entry : m_undo) all.push_back(&entry.other);
    return countBytes(all) - countBytes({&m_now.document});
  };
  while (!m_undo.empty() && bytes() > m_mostBytes) m_undo.pop_front();
}

std::optional<std::string> History::step(std::deque<Entry>& from, std::deque<Entry>& to) {
  const std::lock_guard lock(m_mutex);
  if (from.empty()) return std::nullopt;
  Entry entry = std::move(from.back());
  from.pop_back();
  to.push_back({entry.name, m_now.document});
  replace(std::move(entry.other));
  return entry.name;
}

void History::begin(Document document) {
  const std::lock_guard lock(m_mutex);
  m_undo.clear();
  m_redo.clear();
  replace(std::move(document));
}

void History::restamp(const std::vector<OpenFile>& files) {
  const std::lock_guard lock(m_mutex);
  const auto apply = [&files](Document& document) {
    for (OpenFile& mine : document.files)
      for (const OpenFile& file : files)
        if (mine.id == file.id) mine.stamp = file.stamp;
  };
  apply(m_now.document);
  for (Entry& entry : m_undo) apply(entry.other);
  for (Entry& entry : m_redo) apply(entry.other);
}

std::optional<std::string> History::undo() {
  return step(m_undo, m_redo);
}

std::optional<std::string> History::redo() {
  return step(m_redo, m_undo);
}

std::optional<std::string> History::undoName() const {
  const std::lock_guard lock(m_mutex);
  return m_undo.empty() ? std::nullopt : std::optional(m_undo.back().name);
}

std::optional<std::string> History::redoName() const {
  const std::lock_guard lock(m_mutex);
  return m_redo.empty() ? std::nullopt : std::optional(m_redo.back().name);
}

}  // namespace lumen::viewer
