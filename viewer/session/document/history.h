// SPDX-License-Identifier: Apache-2.0
// The document and its earlier versions: every change can be undone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// Counts the changes of each part; the page fetches a part again when its number is another.
struct PartRevisions {
  std::uint64_t value = 1, volume = 1, second = 1, labels = 1, seeds = 1, proposals = 1, truth = 1,
                meshes = 1;
};

/// A document and how often it has changed.
struct Moment {
  Document document;
  std::uint64_t revision = 1;
  PartRevisions parts;
};

/// All calls are thread-safe.
class History {
public:
  /// Earlier versions are dropped, the oldest first, when they take more than `mostBytes` beside
  /// the document itself.
  explicit History(std::size_t mostBytes = std::size_t{1} << 30) : m_mostBytes(mostBytes) {}

  [[nodiscard]] Moment now() const;
  /// Replaces the document. `name`, such as "rename ica", is the change that undo would take back.
  /// Returns the new revision, or nothing, without a change, if the document is not at revision
  /// `from` any more.
  std::optional<std::uint64_t> commit(const std::string& name, std::uint64_t from,
                                      Document document);
  /// Gives the files of these numbers their stamps, in all versions: they were written.
  void restamp(const std::vector<OpenFile>& files);
  /// Replaces the document and drops all earlier versions.
  void begin(Document document);
  /// Returns the name of the change that was undone or done again, or nothing if there is none.
  std::optional<std::string> undo();
  std::optional<std::string> redo();
  [[nodiscard]] std::optional<std::string> undoName() const;
  [[nodiscard]] std::optional<std::string> redoName() const;

private:
  struct Entry {
    std::string name;  ///< name of the change
    Document other;    ///< the document before the change, or after it if it is undone
  };
  void replace(Document document);
  void forget();
  std::optional<std::string> step(std::deque<Entry>& from, std::deque<Entry>& to);

  const std::size_t m_mostBytes;
  mutable std::mutex m_mutex;  ///< guards all that follow
  Moment m_now;
  std::deque<Entry> m_undo, m_redo;  ///< the newest last
};

}  // namespace lumen::viewer
