// SPDX-License-Identifier: Apache-2.0
// Session: a library's cases, one after the other, and files that are read again.
#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/engine/file_format.h"
#include "formats/container/printable.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

void Session::openLibrary(CaseList list) {
  m_library =
      std::make_unique<Library>(std::move(list), [this] { m_events.tell("state", state()); });
  m_library->start();
}

Tagged Session::library() const {
  if (!m_library) return {};
  const std::size_t read = m_library->readCount();  // before the figures: never newer than they are
  return {std::to_string(read), std::make_shared<const std::string>(jsonText(m_library->json()))};
}

Json Session::openCase(const Arguments& request) {
  if (!m_library) throw Error(ErrorKind::Usage, "no library is open");
  const std::size_t index = request.index("index", m_library->size());
  if (unsaved() && !request.flag("force"))
    throw Conflict("the open case has changes that are not saved");
  const auto& [file, name, keptAt] = m_library->at(index);
  return startJob(
      "opening " + name, true,
      [this, file = file, name = name, keptAt = keptAt, index](Progress& progress) {
        int id = 0;
        {
          const std::lock_guard lock(m_mutex);
          id = ++m_lastFile;
        }
        // of another vessel tree nothing that was open says anything
        Document document = withFile({}, {file, name}, id, m_options.volume, progress);
        progress.check();
        const auto kept = keepUnsaved();  // its name is said, as nothing is there to undo any more
        {
          const std::lock_guard lock(m_mutex);
          m_savedCase = document.value;
          m_savedSeeds = nullptr;
          m_check = nullptr;
          m_openCase = index;
        }
        m_history.begin(std::move(document));
        if (m_library->isPublished())
          saveNowhere(keptAt);
        else
          saveTo(file);
        findUnsaved();
        return name + " is open" +
               (kept.empty() ? ""
                             : "; what was not saved before is in " +
                                   formats::printable(
                                       std::filesystem::path(kept.front()).filename().string()));
      });
}

Json Session::reload(const Arguments& request, const Moment& from) {
  const auto id = static_cast<int>(request.index("id", 1U << 30));
  const auto& files = from.document.files;
  const auto file =
      std::find_if(files.begin(), files.end(), [id](const OpenFile& f) { return f.id == id; });
  if (file == files.end() || file->path.empty())
    throw Error(ErrorKind::Usage, "no file of number " + std::to_string(id) + " was named");
  const Opening opening{file->path, file->label, false, file->role == FileRole::Truth};
  return startJob("reading " + file->label + " again", true,
                  [this, from, opening, id, role = file->role](Progress& progress) {
                    if (roleOf(opening) != role)
                      throw invalidInput(opening.label + ": it was " + roleName(role) +
                                         ", and is " + roleName(roleOf(opening)) +
                                         " now; open it by itself");
                    // meshes are added, all else is replaced
                    const Document before =
                        role == FileRole::Mesh ? withoutFile(from.document, id) : from.document;
                    Document document = withFile(before, opening, id, m_options.volume, progress);
                    {
                      const std::lock_guard lock(m_mutex);
                      if (role == FileRole::Case) m_savedCase = document.value;
                      if (role == FileRole::Seeds) m_savedSeeds = document.seeds;
                      if (std::filesystem::absolute(opening.path) == m_saveTo)
                        m_saveStamp = stampOf(m_saveTo);
                    }
                    commit("read " + opening.label + " again", from, std::move(document));
                    lookAtFiles();
                    return opening.label + " was read again";
                  });
}

}  // namespace lumen::viewer
