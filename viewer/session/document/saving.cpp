// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/saving.h"

#include <utility>

#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/io/seeds/case_seeds.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document_seeds.h"

namespace lumen::viewer {

namespace fs = std::filesystem;

void Saving::saveTo(const fs::path& file) {
  const std::lock_guard lock(m_mutex);
  m_target = fs::absolute(file);
  m_stamp = readFileStamp(m_target);
}

void Saving::saveNowhere(const fs::path& place) {
  const std::lock_guard lock(m_mutex);
  m_target.clear();
  m_stamp = {};
  m_keepAt = fs::absolute(place);
}

void Saving::acceptTarget(const fs::path& file) {
  const std::lock_guard lock(m_mutex);
  if (fs::absolute(file) == m_target) m_stamp = readFileStamp(m_target);
}

void Saving::holdCase(const Document& document) {
  const bool areInCase = caseWithSeeds(document) == document.value;
  const std::lock_guard lock(m_mutex);
  m_case = document.value;
  m_caseSeeds = areInCase ? document.seeds : nullptr;
}

void Saving::holdSeeds(std::shared_ptr<const Seeds> seeds) {
  const std::lock_guard lock(m_mutex);
  m_seeds = std::move(seeds);
}

fs::path Saving::lockedTarget(const Document& document) const {
  const OpenFile* open = document.fileOf(FileRole::Case);
  const bool wasDropped = open != nullptr && open->path.empty();
  return wasDropped && m_stamp != FileStamp{} ? fs::path() : m_target;
}

fs::path Saving::target(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return lockedTarget(document);
}

fs::path Saving::place(const Document& document) const {
  {
    const std::lock_guard lock(m_mutex);
    if (!m_target.empty()) return m_target;
    if (!m_keepAt.empty()) return m_keepAt;
  }
  const OpenFile* volume = document.fileOf(FileRole::Volume);
  return volume != nullptr && !volume->path.empty() ? volume->path : m_unnamed;
}

UnsavedParts Saving::unsaved(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  const bool areHeld = m_seeds ? document.seeds == m_seeds : document.seeds->empty();
  const bool hasCase = document.value != nullptr;
  return {hasCase && (document.value != m_case || (document.seeds != m_caseSeeds && !areHeld)),
          !hasCase && !areHeld, document.proposals != nullptr};
}

fs::path Saving::checkedTarget(const Document& document, bool force) const {
  const fs::path file = lockedTarget(document);
  if (!file.empty() && readFileStamp(file) != m_stamp && !force)
    throw Conflict(file.filename().string() +
                   " was changed by another program since it was read; saving would undo that");
  if (file.empty() || !document.value)
    refuse("there is no case, or no file that it came from; download it");
  return file;
}

void Saving::saveSeeds(const Document& document) {
  const OpenFile* file = document.fileOf(FileRole::Seeds);
  if (file == nullptr || file->path.empty() || document.seeds == m_seeds) return;
  Seeds seeds = *document.seeds;
  convert::dropOtherParents(seeds);
  for (convert::SeedBranch& seed : seeds) seed.isTracked = false;
  if (!seeds.empty()) convert::writeSeeds(seeds, file->path);
  m_seeds = document.seeds;
}

fs::path Saving::save(Document& document, bool force) {
  const std::lock_guard lock(m_mutex);
  const fs::path file = checkedTarget(document, force);
  Progress silent;
  engine::caseOutputFormat(file, "", "the saved case")
      .writeCase(*caseWithSeeds(document), file, {}, silent);
  saveSeeds(document);
  for (OpenFile& open : document.files)
    if ((open.role == FileRole::Case || open.role == FileRole::Seeds) && !open.path.empty())
      open.stamp = readFileStamp(open.path);
  m_case = document.value;
  m_caseSeeds = document.seeds;
  m_stamp = readFileStamp(file);
  return file;
}

bool ChangedFiles::look(const Document& document) {
  std::set<int> changed;
  for (const OpenFile& file : document.files)
    if (!file.path.empty() && readFileStamp(file.path) != file.stamp) changed.insert(file.id);
  const std::lock_guard lock(m_mutex);
  if (changed == m_ids) return false;
  m_ids = std::move(changed);
  return true;
}

std::set<int> ChangedFiles::ids() const {
  const std::lock_guard lock(m_mutex);
  return m_ids;
}

}  // namespace lumen::viewer
