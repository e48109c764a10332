// SPDX-License-Identifier: Apache-2.0
// A folder of cases, one of which is open at a time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

using engine::Json;

/// A case of a folder.
struct ListedCase {
  std::filesystem::path file;
  std::string name;  ///< for people
  /// Published cases only: the file beside which changes are kept until they are downloaded.
  std::filesystem::path keptAt;
};

/// The cases of a folder.
struct CaseList {
  std::string name;  ///< for people
  std::vector<ListedCase> cases;
  bool isPublished = false;  ///< it is a library of spec/library.md, whose cases never change
};

/// The cases that a library's library.json lists, in its order. In a folder without one: all cases
/// (.lumen, .lumen.json) directly in it or one level below, sorted by name, without hidden files
/// and unsaved work (NAME.unsaved.lumen). Throws Error(InvalidInput) for a library.json that breaks
/// its format.
CaseList casesIn(const std::filesystem::path& folder);

/// A list of cases, each of which is read in the background for its figures. All calls are
/// thread-safe.
class Library {
public:
  /// `more` is called, without any lock, when more figures are there.
  Library(CaseList list, std::function<void()> more);
  ~Library();
  /// Begins to read the cases.
  void start();
  /// Ends reading for good; `more` is not called any more.
  void end();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// {"name", "cases": [{"name", "branches", "length", "error"}]}; figures are null until the case
  /// has been read, and stay null for one that cannot be read, whose "error" is the reason.
  [[nodiscard]] Json json() const;
  [[nodiscard]] std::size_t size() const { return m_list.cases.size(); }
  [[nodiscard]] const ListedCase& at(std::size_t index) const { return m_list.cases[index]; }
  [[nodiscard]] bool isPublished() const { return m_list.isPublished; }
  /// The number of cases that have been read.
  [[nodiscard]] std::size_t readCount() const { return m_read; }

private:
  struct Figures {
    std::size_t branches = 0;
    double length = 0;  ///< mm
    std::string error;
  };
  void read();

  const CaseList m_list;
  const std::function<void()> m_more;
  mutable std::mutex m_mutex;  ///< guards the figures
  std::vector<std::optional<Figures>> m_figures;
  std::atomic<std::size_t> m_read{0};
  std::atomic<bool> m_ended{false};
  std::thread m_thread;
};

/// The library that the page chooses from, if there is one, and the open case of it. All calls are
/// thread-safe.
class OpenLibrary {
public:
  /// Once, before any other call.
  void open(CaseList list, std::function<void()> more);
  /// Ends reading for good.
  void end();

  /// Null if none is open.
  [[nodiscard]] const Library* library() const { return m_library.get(); }
  /// The list of cases as JSON.
  [[nodiscard]] Tagged pack() const;
  /// Counts up as cases are read; 0 without a library.
  [[nodiscard]] std::uint64_t revision() const;
  void setOpenCase(std::size_t index);
  [[nodiscard]] std::optional<std::size_t> openCase() const;

private:
  std::unique_ptr<Library> m_library;
  mutable std::mutex m_mutex;  ///< guards the next
  std::optional<std::size_t> m_openCase;
};

}  // namespace lumen::viewer
