// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/workspace.h"

#include <utility>

#include "converters/base/shown_text.h"
#include "formats/case/motion.h"
#include "viewer/session/document/arguments.h"

namespace lumen::viewer {

namespace {

std::vector<std::string> namesOf(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  return names;
}

Conflict hasChanged() {
  return Conflict("the document has changed meanwhile; look, and try again");
}

}  // namespace

Workspace::Workspace(SessionOptions settings)
    : options(std::move(settings)),
      surfaces([this] { announceState(); }),
      jobs(
          events, [this](std::string_view text) { return shownText(text); },
          [this] { announce(); }) {}

void Workspace::end() {
  events.close();
  jobs.cancelAll();
  jobs.wait();
  library.end();
  surfaces.end();
}

void Workspace::announce() {
  surfaces.allow(!jobs.running());
  surfaces.show(history.now().document.value);
  announceState();
}

void Workspace::sendMessage(const char* severity, const std::string& sentence) {
  events.send("message", {{"severity", severity}, {"text", sentence}});
}

void Workspace::warnOfDropped(const std::vector<std::string>& arrays) {
  for (const std::string& name : arrays)
    sendMessage("warning",
                name == formats::kMotionName
                    ? "the motion is dropped, because it has no poses for nodes that are new or "
                      "were moved"
                    : shownText("the node array " + name +
                                " is dropped, because it has no values for new nodes"));
}

std::string Workspace::shownText(std::string_view message) const {
  return dropped.withoutFolder(messageText(message));
}

Moment Workspace::momentFor(const Arguments& request) const {
  Moment now = history.now();
  const std::int64_t seen = request.whole("revision");
  if (seen < 0 || static_cast<std::uint64_t>(seen) != now.revision) throw hasChanged();
  return now;
}

void Workspace::requireNow(const Moment& from) const {
  if (history.now().revision != from.revision) throw hasChanged();
}

void Workspace::commit(const std::string& name, const Moment& from, Document document,
                       const std::function<void(const Document&)>& hold) {
  {
    const std::lock_guard swap(swapping);
    const Document now = document;
    if (!history.commit(name, from.revision, std::move(document))) throw hasChanged();
    if (hold) hold(now);
  }
  announce();
}

Json Workspace::startJob(const std::string& name, bool changes, JobRunner::Work work) {
  return {{"job", jobs.start(name, changes, std::move(work))}};
}

std::vector<std::string> Workspace::keepUnsaved() {
  const Document document = history.now().document;
  const UnsavedParts parts = saving.unsaved(document);
  return namesOf(unsavedWork.keep(saving.place(document), document, parts));
}

std::vector<std::string> Workspace::findUnsaved() {
  return namesOf(unsavedWork.find(saving.place(history.now().document)));
}

}  // namespace lumen::viewer
