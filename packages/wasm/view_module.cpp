// SPDX-License-Identifier: Apache-2.0
// lumen-view.wasm: the requests of the viewer's page (viewer/README.md) in numbers and addresses, for a worker in the place of the
// server. The worker asks, calls lumen_view_work() while nobody asks, and hears events as they are sent.
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "viewer/routes/routes.h"

#define EXPORT(name) extern "C" __attribute__((export_name(name)))
#define IMPORT(name) extern "C" __attribute__((import_module("lumen"), import_name(name)))

IMPORT("event") void sendEvent(const char* name, const char* data);
IMPORT("is_job_stopped") int askJobStopped();
IMPORT("is_surface_stopped") int askSurfaceStopped();

namespace lumen::viewer {

namespace {

SessionOptions moduleOptions() {
  SessionOptions options;
  options.oneThread =
      OneThread{[] { return askJobStopped() != 0; }, [] { return askSurfaceStopped() != 0; }};
  return options;
}

/// The module's one session, its page, and the request on its way.
struct Worker {
  Session session{moduleOptions()};
  PageFiles page;
  Routes routes{session, page, std::uint64_t{4} << 30};
  PageRequest request;
  std::string body;
  PageAnswer answer;
  std::string_view piece;

  Worker() {
    session.events.forward(
        [](const Event& event) { sendEvent(event.name.c_str(), event.data.c_str()); });
  }
};

Worker& worker() {
  static Worker one;
  return one;
}

}  // namespace

EXPORT("malloc") void* moduleMalloc(std::size_t size) {
  return std::malloc(size);
}
EXPORT("free") void moduleFree(void* bytes) {
  std::free(bytes);
}

/// A file of the page, which a page as one file has in it; "" is the page itself.
EXPORT("lumen_view_add_file")
void addFile(const char* name, const char* bytes, std::size_t size) {
  worker().page[name] = {{}, {bytes, size}};
}

// A request: its begin, its query, its body, and the question, whose answer is the status.

EXPORT("lumen_view_begin") void beginRequest(int isPost, const char* name) {
  worker().request = {isPost != 0, name};
  worker().body.clear();
}
EXPORT("lumen_view_add_query") void addQuery(const char* name, const char* value) {
  worker().request.query.emplace(name, value);
}
/// The address to which the host copies the body; null if memory is out.
EXPORT("lumen_view_make_body") char* makeBody(std::size_t size) {
  try {
    worker().body.resize(size);
  } catch (const std::exception&) {
    return nullptr;
  }
  return worker().body.data();
}
EXPORT("lumen_view_ask") int ask() {
  Worker& one = worker();
  one.request.bodySize = one.body.size();
  one.request.readBody = [&one](std::uint64_t most) {
    if (one.body.size() > most) refuseSize(most);
    return std::exchange(one.body, {});
  };
  one.request.whileWanted = [](const std::function<void(Progress&)>& work) {
    Progress silent;
    work(silent);
  };
  one.answer = one.routes.answer(one.request);
  one.request = {};
  return one.answer.status;
}

EXPORT("lumen_view_file_name") const char* fileName() {
  return worker().answer.fileName.c_str();
}
EXPORT("lumen_view_size") std::size_t answerSize() {
  return worker().answer.size;
}
/// The length of the next piece from `offset` on, at lumen_view_piece().
EXPORT("lumen_view_read") std::size_t readPiece(std::size_t offset) {
  Worker& one = worker();
  one.piece = one.answer.piece(offset, one.answer.size - offset);
  return one.piece.size();
}
EXPORT("lumen_view_piece") const char* pieceData() {
  return worker().piece.data();
}
/// Gives the memory of the answer back.
EXPORT("lumen_view_end") void endAnswer() {
  worker().answer = {};
}

/// Runs a job that waits, or makes a surface that is wanted. 0: there is neither.
EXPORT("lumen_view_work") int work() {
  return worker().session.work() ? 1 : 0;
}

}  // namespace lumen::viewer
