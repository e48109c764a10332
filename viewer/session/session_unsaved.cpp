// SPDX-License-Identifier: Apache-2.0
// Session: work that is not saved, which survives.
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "formats/container/printable.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

std::string nameOf(const fs::path& file) {
  return formats::printable(file.filename().string());
}

}  // namespace

fs::path Session::savingPlace(const Document& document) const {
  {
    const std::lock_guard lock(m_mutex);
    if (!m_saveTo.empty()) return m_saveTo;
    if (!m_keepAt.empty()) return m_keepAt;
  }
  const OpenFile* volume = document.fileOf(FileRole::Volume);
  return volume != nullptr && !volume->path.empty() ? volume->path : fs::path("lumen");
}

std::vector<std::string> Session::keepUnsaved() {
  const std::lock_guard one(m_unsavedMutex);
  const Document document = m_history.now().document;
  const auto [hasCase, hasSeeds] = unsavedParts();
  m_unsaved.beside(savingPlace(document));
  m_unsaved.write(hasCase ? document.value : nullptr, hasSeeds ? document.seeds : nullptr);
  std::vector<std::string> names;
  for (const fs::path& file : m_unsaved.files()) names.push_back(file.string());
  return names;
}

std::vector<std::string> Session::findUnsaved() {
  std::vector<fs::path> found = unsavedOf(savingPlace(m_history.now().document));
  std::vector<std::string> names;
  for (const fs::path& file : found) names.push_back(file.string());
  const std::lock_guard lock(m_mutex);
  m_leftBehind = std::move(found);
  return names;
}

fs::path Session::leftBehind(const Arguments& request) const {
  const std::lock_guard lock(m_mutex);
  return m_leftBehind[request.index("index", m_leftBehind.size())];
}

Json Session::recover(const Arguments& request, const Moment& from) {
  const fs::path file = leftBehind(request);
  return startJob("reading " + nameOf(file), true, [this, file, from](Progress& progress) {
    const Document read =
        withFile(from.document, {file, nameOf(file)}, 0, m_options.volume, progress);
    Document document = from.document;
    document.value = read.value;
    document.seeds = read.seeds;
    commit("take " + nameOf(file), from, std::move(document));
    return "this is " + nameOf(file) + ", which was not saved";
  });
}

Json Session::forget(const Arguments& request) {
  const fs::path file = leftBehind(request);
  std::error_code error;
  fs::remove(file, error);
  if (error) throw failed(nameOf(file) + " cannot be removed: " + error.message());
  {
    const std::lock_guard lock(m_mutex);
    std::erase(m_leftBehind, file);
  }
  changed();
  return {{"revision", m_history.now().revision}};
}

}  // namespace lumen::viewer
