// SPDX-License-Identifier: Apache-2.0
// Session: files, named and dropped.
#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/message_text.h"
#include "converters/engine/file_access.h"
#include "formats/container/printable.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;

/// `name` with harmless letters only, and its ending, which tells the format.
std::string harmless(const std::string& name) {
  std::string text;
  for (const char c : name.substr(name.size() - std::min(name.size(), kLongestName)))
    text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ? c : '_';
  if (text.empty() || text.front() == '.') text.insert(0, "file");
  return text;
}

}  // namespace

Session::Session(SessionOptions options)
    : m_options(std::move(options)),
      m_surfaces([this] { m_events.tell("state", state()); }),
      m_jobs(
          m_events, [this](std::string_view text) { return shownText(text); },
          [this] { changed(); }) {}

Session::~Session() {
  m_events.close();
  if (m_library) m_library->end();
  m_surfaces.end();  // its last words need what is destroyed before it
}

void Session::changed() {
  const auto running = m_jobs.running();
  m_surfaces.allow(!running);
  m_surfaces.show(m_history.now().document.value);
  m_events.tell("state", state());
}

std::string Session::shownText(std::string_view message) const {
  std::string text = messageText(message);
  if (!m_folder) return text;
  // dropped files lie in numbered folders of this one
  const std::string folder = formats::printable(m_folder->path().string()) + "/";
  for (std::size_t at = 0; (at = text.find(folder, at)) != text.npos;) {
    const std::size_t slash = text.find('/', at + folder.size());
    text.erase(at, (slash == text.npos ? at + folder.size() : slash + 1) - at);
  }
  return text;
}

void Session::open(const Opening& opening, Progress& progress) {
  const Moment before = m_history.now();
  int id = 0;
  {
    const std::lock_guard lock(m_mutex);
    id = ++m_lastFile;
  }
  Document document = withFile(before.document, opening, id, m_options.volume, progress);
  {
    const std::lock_guard lock(m_mutex);
    if (document.value != before.document.value) m_savedCase = document.value;
    if (document.seeds != before.document.seeds) m_savedSeeds = document.seeds;
  }
  if (opening.dropped) return commit("open " + opening.label, before, std::move(document));
  // what the user began with is nothing to undo
  m_history.begin(std::move(document));
  changed();
}

void Session::saveTo(const fs::path& file) {
  const std::lock_guard lock(m_mutex);
  m_saveTo = fs::absolute(file);
  m_saveStamp = stampOf(m_saveTo);
}

void Session::saveNowhere(const fs::path& place) {
  const std::lock_guard lock(m_mutex);
  m_saveTo.clear();
  m_saveStamp = {};
  m_keepAt = fs::absolute(place);
}

fs::path Session::placeFor(const std::string& name) {
  const std::lock_guard lock(m_mutex);
  if (!m_folder) {
    auto folder = formats::PendingFolder::beside(fs::temp_directory_path() / "lumen-view",
                                                 formats::PendingFolder::Existing::Replace);
    if (!folder) throw failed("no place for dropped files: " + folder.error().message);
    m_folder = std::make_unique<formats::PendingFolder>(std::move(*folder));
    fs::permissions(m_folder->path(), fs::perms::owner_all);
  }
  const fs::path own = m_folder->path() / std::to_string(++m_lastDropped);
  fs::create_directory(own);
  return own / harmless(name);
}

Json Session::openDropped(const fs::path& file, const std::string& label, bool asTruth) {
  requireIdle();
  return startJob("opening " + formats::printable(label), true,
                  [this, file, label, asTruth](Progress& progress) {
                    struct Remove {
                      const fs::path& folder;
                      ~Remove() {
                        std::error_code ignored;
                        fs::remove_all(folder, ignored);
                      }
                    };
                    const fs::path folder = file.parent_path();
                    const Remove remove{folder};
                    open({file, label, true, asTruth}, progress);
                    return formats::printable(label) + " is open";
                  });
}

void Session::lookAtFiles() {
  const Moment now = m_history.now();
  std::set<int> changed;
  for (const OpenFile& file : now.document.files)
    if (!file.path.empty() && stampOf(file.path) != file.stamp) changed.insert(file.id);
  {
    const std::lock_guard lock(m_mutex);
    if (changed == m_changedFiles) return;
    m_changedFiles = std::move(changed);
  }
  m_events.tell("state", state());
}

}  // namespace lumen::viewer
