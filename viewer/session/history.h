// SPDX-License-Identifier: Apache-2.0
// The document and what it was before: every change can be undone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "viewer/session/document.h"

namespace lumen::viewer {

/// Counts the changes of each part; the page fetches a part again when its number is another.
struct PartRevisions {
  std::uint64_t value = 1, volume = 1, seeds = 1, truth = 1, meshes = 1;
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
  /// What may be undone is forgotten, the oldest first, when all of it takes more than `mostBytes`
  /// beside the document itself.
  explicit History(std::size_t mostBytes = std::size_t{1} << 30) : m_mostBytes(mostBytes) {}

  [[nodiscard]] Moment now() const;
  /// The document is now this one. `name`, such as "rename ica", says what undo would take back.
  /// Gives the revision; nothing, and nothing has changed, if the document is not at revision
  /// `from` any more.
  std::optional<std::uint64_t> commit(const std::string& name, std::uint64_t from,
                                      Document document);
  /// The files of these numbers were written, and are as they are now on disk.
  void restamp(const std::vector<OpenFile>& files);
  /// The document is now this one, and nothing of what was before can be had again.
  void begin(Document document);
  /// Gives the name of what was undone or done again; nothing if there is nothing.
  std::optional<std::string> undo();
  std::optional<std::string> redo();
  [[nodiscard]] std::optional<std::string> undoName() const;
  [[nodiscard]] std::optional<std::string> redoName() const;

private:
  struct Entry {
    std::string name;  ///< of the change
    Document other;    ///< what was there before it, or, undone, after it
  };
  void replace(Document document);
  void forget();
  std::optional<std::string> step(std::deque<Entry>& from, std::deque<Entry>& to);

  const std::size_t m_mostBytes;
  mutable std::mutex m_mutex;
  Moment m_now;
  std::deque<Entry> m_undo, m_redo;  ///< the newest last
};

}  // namespace lumen::viewer
