// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/changed_files.h"

#include <utility>

namespace lumen::viewer {

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
