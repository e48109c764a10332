// SPDX-License-Identifier: Apache-2.0
// Copies of unsaved work on disk, beside the file that it would be saved in: they survive the
// program.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "viewer/session/document/document.h"
#include "viewer/session/document/saving.h"

namespace lumen::viewer {

/// The files that hold unsaved work of `file`: `head.v1.unsaved.lumen`,
/// `head.v1.unsaved.seeds.json` and `head.v1.unsaved.proposals.lumen` for `head.v1.lumen`, then
/// `head.v1.unsaved.2.lumen`; sorted by name.
std::vector<std::filesystem::path> findUnsavedWork(const std::filesystem::path& file);

/// Whether a file of unsaved work holds proposals, by its name.
bool holdsProposals(const std::filesystem::path& file);

/// Writes the copies of one session, and knows those of an earlier program, which it never touches:
/// it takes the first free name and keeps it. All calls are thread-safe.
class UnsavedWork {
public:
  /// Writes those parts of the document that have changed, each atomically, beside `place`, the case
  /// with all seeds. The copy of a part that is not among `parts`, as it is saved, is removed. Copies beside another place stay there. Returns the copies that there are.
  /// Throws as the writers.
  std::vector<std::filesystem::path> keep(const std::filesystem::path& place,
                                          const Document& document, const UnsavedParts& parts);

  /// Looks for copies of an earlier program beside `place`, and returns them.
  std::vector<std::filesystem::path> find(const std::filesystem::path& place);
  /// The copies that were found and not removed since.
  [[nodiscard]] std::vector<std::filesystem::path> found() const;
  /// Removes a copy that was found. Throws Error(Failed) if it cannot be removed.
  void remove(const std::filesystem::path& file);

private:
  /// The content of a copy: a case with its seeds, or one part alone.
  using Parts = std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>;
  struct Copy {
    std::filesystem::path file;  ///< empty: there is none
    Parts parts;
  };
  void keepPart(Copy& copy, const Parts& parts, const char* ending,
                const std::function<void(const std::filesystem::path&)>& write);

  std::mutex m_keepMutex;  ///< guards the next four; never held with the other mutex
  std::filesystem::path m_place;
  Copy m_case, m_seeds, m_proposals;

  mutable std::mutex m_foundMutex;  ///< guards the next
  std::vector<std::filesystem::path> m_found;
};

}  // namespace lumen::viewer
