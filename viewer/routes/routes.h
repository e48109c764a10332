// SPDX-License-Identifier: Apache-2.0
// The requests of pages (viewer/README.md, "Requests") and their answers, without a transport: a server over HTTP and a worker
// of the page hand them over.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "viewer/routes/html_page.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

constexpr const char* kBytesType = "application/octet-stream";
constexpr const char* kJsonType = "application/json";

struct PageRequest {
  bool isPost = false;
  std::string name;  ///< "surface"
  std::multimap<std::string, std::string> query{};
  std::string knownTag{};      ///< of the part that the page has; empty: it has none
  std::uint64_t bodySize = 0;  ///< as the page announces it, bytes
  /// The body, of at most as many bytes. Throws Error(Usage) for a longer one.
  std::function<std::string(std::uint64_t most)> readBody{};
  /// Does work that ends early when the page does not wait for the answer any more.
  std::function<void(const std::function<void(Progress&)>& work)> whileWanted{};

  /// The first value of that name; empty without one.
  [[nodiscard]] std::string value(const std::string& word) const;
};

struct PageAnswer {
  int status = 200;  ///< of HTTP
  std::string type = kJsonType;
  std::string tag{};       ///< of a part of the document; empty for other answers
  std::string fileName{};  ///< of a download; empty for other answers
  std::uint64_t size = 0;  ///< bytes
  /// At most that many bytes of the answer from that offset on, and at least one. Null without bytes.
  std::function<std::string_view(std::uint64_t offset, std::uint64_t length)> piece{};
};

/// An answer whose whole text is at hand.
PageAnswer answerOf(std::shared_ptr<const std::string> bytes, const char* type = kJsonType);
/// A sentence as {"error"}.
PageAnswer refusalOf(int status, const std::string& sentence);
/// Throws Error(Usage): the body has more bytes.
[[noreturn]] void refuseSize(std::uint64_t most);

/// All calls are thread-safe.
class Routes {
public:
  /// `mostFile`: most bytes of a dropped file. The session must outlive the routes.
  Routes(Session& session, const PageFiles& page, std::uint64_t mostFile);

  /// The answer, an error of any kind included; status 404 without bytes for a name that is none. The stream of events is the
  /// transport's (EventHub).
  [[nodiscard]] PageAnswer answer(const PageRequest& request) const;

private:
  using Handler = std::function<PageAnswer(const PageRequest&)>;

  void addParts();
  void addWork();
  void addPart(const std::string& name, std::function<Tagged(const PageRequest&)> part);
  /// A part that takes long to make.
  void addSlowPart(const std::string& name,
                   std::function<Tagged(const PageRequest&, Progress&)> part);
  /// A request with a body in JSON and an answer in JSON.
  void addPost(const std::string& name, std::function<Json(formats::JsonValue)> answer);
  [[nodiscard]] PageAnswer volume(const PageRequest& request, FileRole role) const;
  [[nodiscard]] PageAnswer save(const PageRequest& request) const;
  [[nodiscard]] PageAnswer takeSeriesFile(const PageRequest& request) const;
  [[nodiscard]] PageAnswer takeFile(const PageRequest& request) const;

  Session& m_session;
  const PageFiles& m_page;
  const std::uint64_t m_mostFile;
  std::map<std::string, Handler> m_gets, m_posts;
};

}  // namespace lumen::viewer
