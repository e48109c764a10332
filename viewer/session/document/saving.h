// SPDX-License-Identifier: Apache-2.0
// Files on disk: the place where the document is saved, the parts of it that they hold, and those that have
// changed since.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// The parts of a document that no file holds.
struct UnsavedParts {
  bool hasCase = false;   ///< or its seeds
  bool hasSeeds = false;  ///< where there is no case
  /// Proposals wait: they are kept, but a document without a decision on them can be saved.
  bool hasProposals = false;
  [[nodiscard]] bool any() const { return hasCase || hasSeeds; }
};

/// All calls are thread-safe. The stamp is that of the target when this program last read or wrote
/// it, so a target with another stamp was changed by another program.
class Saving {
public:
  /// `unnamed`: unsaved work of a document without any named file is kept beside it.
  explicit Saving(std::filesystem::path unnamed) : m_unnamed(std::move(unnamed)) {}
  /// The document is saved into this file from now on.
  void saveTo(const std::filesystem::path& file);
  /// The document has no file, so pages download it; its unsaved work is kept beside `place`.
  void saveNowhere(const std::filesystem::path& place);
  /// Another program's version of the file was read: if it is the target, it may be overwritten.
  void acceptTarget(const std::filesystem::path& file);

  /// The file of the case holds the document's case, and its seeds if these are in that case.
  void holdCase(const Document& document);
  /// A file of seeds holds these.
  void holdSeeds(std::shared_ptr<const Seeds> seeds);

  /// The target, or an empty path: a dropped case, which has replaced the one of the target, is
  /// never written into it.
  [[nodiscard]] std::filesystem::path target(const Document& document) const;
  /// The file beside which unsaved work is kept.
  [[nodiscard]] std::filesystem::path place(const Document& document) const;
  [[nodiscard]] UnsavedParts unsaved(const Document& document) const;
  /// Writes the case, with all seeds, into the target, and changed seeds into their own file if they
  /// have one; returns the target and gives these files of `document` their new stamps. Other calls
  /// wait for its end. Throws Conflict if another program has changed the target, unless `force`;
  /// Error(Usage) if there is no case or no target.
  std::filesystem::path save(Document& document, bool force);

private:
  // Call these with the mutex held.
  [[nodiscard]] std::filesystem::path lockedTarget(const Document& document) const;
  /// Writes changed seeds into their file, if they have one.
  void saveSeeds(const Document& document);
  [[nodiscard]] std::filesystem::path checkedTarget(const Document& document, bool force) const;

  const std::filesystem::path m_unnamed;
  mutable std::mutex m_mutex;  ///< guards all that follow
  std::filesystem::path m_target;
  FileStamp m_stamp;               ///< stamp of the target
  std::filesystem::path m_keepAt;  ///< counts where there is no target
  std::shared_ptr<const formats::Case> m_case;
  std::shared_ptr<const Seeds> m_caseSeeds;  ///< in the file of the case
  std::shared_ptr<const Seeds> m_seeds;      ///< in a file of seeds
};

/// The numbers of the open files that another program has changed on disk, as of the last look. All calls are thread-safe.
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
