// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session.h"

#include <utility>

#include "converters/base/shown_text.h"
#include "formats/case/motion.h"
#include "viewer/session/operations.h"

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

Session::Session(SessionOptions settings)
    : options(std::move(settings)),
      surfaces([this] { announceState(); }, options.oneThread),
      jobs(
          events, [this] { announce(); }, options.oneThread) {}

Session::~Session() {
  events.close();
  jobs.cancelAll();
  jobs.wait();
  library.end();
  surfaces.end();
}

void Session::openLibrary(CaseList list) {
  library.open(std::move(list), [this] { announceState(); });
}

Json Session::run(formats::JsonValue request) {
  const Arguments arguments(request);
  const std::string op = arguments.text("op");
  const std::lock_guard gate(m_gate);
  const std::int64_t seen = arguments.whole("revision");
  const Moment from = now();
  if (seen < 0 || static_cast<std::uint64_t>(seen) != from.revision) throw hasChanged();
  return runOperation(*this, op, arguments, from);
}

Json Session::vesselAtClick(formats::JsonValue request) {
  const Arguments arguments(request);
  return vesselNear(arguments.position("position"), now().document, tracking,
                    options.track.options);
}

void Session::cancelAll() {
  jobs.cancelAll();
  surfaces.allow(false);
}

Tagged Session::surfacePack(int level, bool quick) {
  const auto surface = quick ? surfaces.quick() : surfaces.get(level);
  if (!surface) return {};
  return {surface->tag, {surface, &surface->pack}};
}

Tagged Session::finishedSurface(int level, Progress& progress) {
  surfaces.waitFor(level, progress);
  return surfacePack(level, false);
}

Tagged Session::distancePack(int level, bool quick, Progress& progress) {
  const Moment moment = now();
  if (!moment.document.truth) return {};
  return viewer::distancePack(moment, quick ? surfaces.quick() : surfaces.get(level),
                              findings.figures(moment.document), progress);
}

void Session::lookAtFiles() {
  if (changedFiles.look(now().document)) announceState();
}

std::vector<std::string> Session::keepUnsaved() {
  const Document document = now().document;
  return namesOf(unsavedWork.keep(saving.place(document), document, saving.unsaved(document)));
}

std::vector<std::string> Session::findUnsaved() {
  return namesOf(unsavedWork.find(saving.place(now().document)));
}

void Session::announce() {
  surfaces.allow(!jobs.running());
  surfaces.show(now().document.value);
  announceState();
}

void Session::sendMessage(const char* severity, const std::string& sentence) {
  events.send("message", {{"severity", severity}, {"text", sentence}});
}

void Session::warnOfDropped(const std::vector<std::string>& arrays) {
  for (const std::string& name : arrays)
    sendMessage("warning",
                name == formats::kMotionName
                    ? "the motion is dropped, because it has no poses for nodes that are new or "
                      "were moved"
                    : messageText("the node array " + name +
                                  " is dropped, because it has no values for new nodes"));
}

void Session::requireNow(const Moment& from) const {
  if (now().revision != from.revision) throw hasChanged();
}

Json Session::commit(const std::string& name, const Moment& from, Document document,
                     const std::function<void(const Document&)>& hold) {
  {
    const std::lock_guard swap(swapping);
    const Document now = document;
    if (!history.commit(name, from.revision, std::move(document))) throw hasChanged();
    if (hold) hold(now);
  }
  announce();
  return revision();
}

}  // namespace lumen::viewer
