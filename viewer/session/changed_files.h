// SPDX-License-Identifier: Apache-2.0
// Open files that another program has changed on disk.
#pragma once

#include <mutex>
#include <set>

#include "viewer/session/document.h"

namespace lumen::viewer {

/// The numbers of these files, as of the last look. All calls are thread-safe.
class ChangedFiles {
public:
  /// Compares the files on disk with the document; true if the answer is another one than before.
  bool look(const Document& document);
  [[nodiscard]] std::set<int> ids() const;

private:
  mutable std::mutex m_mutex;  ///< guards the next
  std::set<int> m_ids;
};

}  // namespace lumen::viewer
