// SPDX-License-Identifier: Apache-2.0
// A folder of cases, one of which is open at a time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// The list of cases that the page chooses from, if there is one, and the open case of it. Each is
/// read in the background for its figures. All calls are thread-safe.
class Library {
public:
  Library() = default;
  ~Library() { end(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// Begins to read the cases; `more` is called, without any lock, when more figures are there. Once,
  /// before any other call.
  void open(CaseList list, std::function<void()> more);
  /// Ends reading for good; `more` is not called any more.
  void end();

  [[nodiscard]] bool isOpen() const { return m_isOpen; }
  /// {"name", "cases": [{"name", "branches", "length_mm", "error"}]}; figures are null until the case
  /// has been read, and stay null for one that cannot be read, whose "error" is the reason. Empty if
  /// no list is open.
  [[nodiscard]] Tagged pack() const;
  /// Counts up as cases are read; 0 without a list.
  [[nodiscard]] std::uint64_t revision() const { return isOpen() ? m_read + 1 : 0; }
  [[nodiscard]] std::size_t size() const { return m_list.cases.size(); }
  [[nodiscard]] const ListedCase& at(std::size_t index) const { return m_list.cases[index]; }
  [[nodiscard]] bool isPublished() const { return m_list.isPublished; }
  void setOpenCase(std::size_t index);
  [[nodiscard]] std::optional<std::size_t> openCase() const;

private:
  struct Figures {
    std::size_t branches = 0;
    double length = 0;  ///< mm
    std::string error;
  };
  void read();

  CaseList m_list;
  std::function<void()> m_more;
  std::atomic<std::size_t> m_read{0};  ///< number of cases that have been read
  std::atomic<bool> m_isOpen{false}, m_ended{false};
  mutable std::mutex m_mutex;  ///< guards the next two
  std::vector<std::optional<Figures>> m_figures;
  std::optional<std::size_t> m_openCase;
  std::thread m_thread;
};

}  // namespace lumen::viewer
