// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/server.h"

#include <chrono>
#include <thread>
#include <utility>

#include <httplib.h>
#include <sys/socket.h>

#include "converters/base/error.h"
#include "viewer/routes/routes.h"
#include "viewer/server/answers.h"
#include "viewer/server/http_server.h"

namespace lumen::viewer {

namespace {

using httplib::Request;
using httplib::Response;

constexpr const char* kHost = "127.0.0.1";

// A request holds a connection and a thread while it lasts. Each listening page holds one; the
// others are free for requests, also while slow senders hold theirs until HttpServer closes them.
constexpr std::size_t kThreads = EventHub::kMostListeners + 112;

// Between two writes to a page that listens: a write to a page that is gone fails.
constexpr std::chrono::seconds kSign{2};

/// The tag in a header that quotes it.
std::string unquoted(const std::string& text) {
  const bool isQuoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return isQuoted ? text.substr(1, text.size() - 2) : std::string();
}

}  // namespace

class Server::Requests {
public:
  Requests(Session& session, PageFiles page, const ServerOptions& options)
      : m_session(session),
        m_page(std::move(page)),
        m_token(randomToken()),
        m_routes(session, m_page, options.mostFile) {
    m_http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    m_http.set_payload_max_length(options.mostFile);
    m_http.set_default_headers(safeHeaders());
    m_http.set_tcp_nodelay(true);
    // with SO_REUSEPORT, the default, another program could listen on the same port
    m_http.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    m_http.set_pre_routing_handler([this](const Request& request, Response& response) {
      if (isAllowed(request)) return httplib::Server::HandlerResponse::Unhandled;
      response.status = 404;
      return httplib::Server::HandlerResponse::Handled;
    });
    m_http.Get("/.*", [this](const Request& request, Response& response) {
      answerGet(request, response);
    });
    m_http.Post("/.*", [this](const Request& request, Response& response,
                              const httplib::ContentReader& reader) {
      answerPost(request, response, reader);
    });
    bind(options.port);
    m_thread = std::thread([this] { m_http.listen_after_bind(); });
    // stop() does nothing before that
    while (!m_http.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  ~Requests() {
    stop();
    m_thread.join();
  }

  void stop() {
    m_session.events.close();
    m_http.stop();
  }

  [[nodiscard]] std::string address() const { return origin() + "/" + m_token + "/"; }

private:
  [[nodiscard]] std::string origin() const { return "http://" + m_authority; }

  void bind(int port) {
    const bool bound =
        port == 0 ? (port = m_http.bind_to_any_port(kHost)) > 0 : m_http.bind_to_port(kHost, port);
    if (!bound)
      throw failed(port > 0 ? "port " + std::to_string(port) +
                                  " cannot be listened on; another program may have it"
                            : std::string("no port of 127.0.0.1 can be listened on"));
    m_authority = std::string(kHost) + ":" + std::to_string(port);
  }

  [[nodiscard]] bool isAllowed(const Request& request) const {
    if (request.get_header_value_count("Host") != 1 ||
        request.get_header_value("Host") != m_authority)
      return false;
    for (std::size_t i = 0; i < request.get_header_value_count("Origin"); ++i)
      if (request.get_header_value("Origin", i) != origin()) return false;
    const std::string& path = request.path;
    return path.size() > m_token.size() + 1 && path[0] == '/' && path[m_token.size() + 1] == '/' &&
           sameSecret(std::string_view(path).substr(1, m_token.size()), m_token);
  }

  /// The part of the path behind the token, which has been looked at.
  [[nodiscard]] std::string nameOf(const Request& request) const {
    return request.path.substr(m_token.size() + 2);
  }

  [[nodiscard]] PageRequest pageRequest(const Request& request, bool isPost) const {
    PageRequest made;
    made.isPost = isPost;
    made.name = nameOf(request);
    made.query = {request.params.begin(), request.params.end()};
    made.knownTag = unquoted(request.get_header_value("If-None-Match"));
    made.bodySize = request.get_header_value<std::uint64_t>("Content-Length");
    made.whileWanted = [port = request.remote_port](const auto& work) {
      whileConnected(port, work);
    };
    return made;
  }

  void answerGet(const Request& request, Response& response) {
    const std::string name = nameOf(request);
    if (name == "events") return answerEvents(response);
    if (const auto file = m_page.find(name); file != m_page.end())
      return answerText(file->second.bytes, file->second.type.c_str(), response);
    if (name.empty()) return answerText(kNoPage, "text/html; charset=utf-8", response);
    handOver(m_routes.answer(pageRequest(request, false)), response);
  }

  void answerPost(const Request& request, Response& response,
                  const httplib::ContentReader& reader) {
    PageRequest made = pageRequest(request, true);
    made.readBody = [&](std::uint64_t most) { return bodyOf(request, reader, most); };
    handOver(m_routes.answer(made), response);
  }

  static void answerText(std::string text, const char* type, Response& response) {
    handOver(answerOf(std::make_shared<const std::string>(std::move(text)), type), response);
  }

  void answerEvents(Response& response) {
    const auto listener = m_session.events.listen();
    if (!listener)
      return handOver(refusalOf(503, "at most " + std::to_string(EventHub::kMostListeners) +
                                         " pages may be open"),
                      response);
    std::string first = "event: state\ndata: " + jsonText(m_session.state()) + "\n\n";
    response.set_chunked_content_provider(
        "text/event-stream",
        [listener, first = std::move(first)](std::size_t, httplib::DataSink& sink) mutable {
          std::string text = std::exchange(first, {});
          if (text.empty()) {
            if (const auto event = listener->wait(kSign))
              text = "event: " + event->name + "\ndata: " + event->data + "\n\n";
            else if (listener->closed())
              return sink.done(), true;
            else
              text = ": still here\n\n";
          }
          return sink.write(text.data(), text.size());
        });
  }

  Session& m_session;
  const PageFiles m_page;
  const std::string m_token;
  const Routes m_routes;
  std::string m_authority;  ///< "127.0.0.1:40123"
  HttpServer m_http;
  std::thread m_thread;
};

Server::Server(Session& session, PageFiles page, const ServerOptions& options)
    : m_requests(std::make_unique<Requests>(session, std::move(page), options)) {}

Server::~Server() = default;

std::string Server::address() const {
  return m_requests->address();
}

void Server::stop() {
  m_requests->stop();
}

}  // namespace lumen::viewer
