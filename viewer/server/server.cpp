// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/server.h"

#include <chrono>
#include <thread>
#include <utility>

#include <httplib.h>
#include <sys/socket.h>

#include "converters/base/error.h"
#include "viewer/server/answers.h"
#include "viewer/server/html_page.h"
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

int levelOf(const Request& request) {
  const std::string text = request.get_param_value("level");
  if (text.empty()) return 0;
  if (text.size() > 1 || text[0] < '0' || text[0] > '9')
    throw Error(ErrorKind::Usage, "\"level\" must be a digit");
  return text[0] - '0';
}

int numberOf(const Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != text.npos)
    throw Error(ErrorKind::Usage, std::string("\"") + name + "\" must be a number");
  return std::stoi(text);
}

OpenAs openAs(const std::string& word) {
  if (word.empty() || word == "auto") return OpenAs::Auto;
  if (word == "truth") return OpenAs::Truth;
  if (word == "second") return OpenAs::Second;
  if (word == "labels") return OpenAs::Labels;
  throw Error(ErrorKind::Usage, "\"as\" must be auto, truth, second or labels");
}

/// A name for a download that every system takes.
std::string downloadName(const std::string& title, const std::string& ending) {
  std::string name;
  for (const char c : title.substr(0, title.find('.')))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return (name.empty() ? "lumen" : name.substr(0, 80)) + ending;
}

}  // namespace

class Server::Requests {
public:
  Requests(Session& session, PageFiles page, const ServerOptions& options)
      : m_session(session),
        m_page(std::move(page)),
        m_token(randomToken()),
        m_mostFile(options.mostFile) {
    m_http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    m_http.set_payload_max_length(m_mostFile);
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
    addPage();
    addParts();
    addWork();
    addFiles();
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
  using Handler = httplib::Server::Handler;

  [[nodiscard]] std::string origin() const { return "http://" + m_authority; }
  [[nodiscard]] std::string at(const std::string& name) const { return "/" + m_token + "/" + name; }

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

  void get(const std::string& name, const Handler& handler) {
    m_http.Get(at(name), [handler](const Request& request, Response& response) {
      guarded(response, [&] { handler(request, response); });
    });
  }

  /// A part that takes long to make, and ends when the page does not wait any more.
  void getSlowly(const std::string& name,
                 const std::function<Tagged(const Request&, Progress&)>& part) {
    get(name, [part](const Request& request, Response& response) {
      whileConnected(request.remote_port, [&](Progress& progress) {
        answerPart(request, response, part(request, progress));
      });
    });
  }

  /// A request with a body in JSON and an answer in JSON.
  void post(const std::string& name, const std::function<Json(formats::JsonValue)>& answer) {
    m_http.Post(at(name), [answer](const Request& request, Response& response,
                                   const httplib::ContentReader& reader) {
      guarded(response, [&] {
        const formats::JsonDocument document = readJson(request, reader);
        answerText(response, jsonText(answer(document.root())));
      });
    });
  }

  void addPage() {
    if (m_page.empty())
      get("", [](const Request&, Response& response) {
        answerText(response, kNoPage, "text/html; charset=utf-8");
      });
    for (const auto& [name, file] : m_page)
      get(name, [&file = file](const Request&, Response& response) {
        answerText(response, file.bytes, file.type.c_str());
      });
  }

  void addParts() {
    get("state", [this](const Request&, Response& response) {
      answerText(response, jsonText(m_session.state()));
    });
    getSlowly("case", [this](const Request&, Progress& progress) {
      return m_session.packs.casePack(m_session.now(), progress);
    });
    getSlowly("proposals", [this](const Request&, Progress& progress) {
      return proposalsPack(m_session.now(), progress);
    });
    get("library", [this](const Request& request, Response& response) {
      answerPart(request, response, m_session.library.pack());
    });
    get("measures", [this](const Request& request, Response& response) {
      answerPart(request, response,
                 request.has_param("kind")
                     ? m_session.findings.measures(request.get_param_value("kind"))
                     : m_session.findings.measures());
    });
    get("case.lumen", [this](const Request& request, Response& response) {
      answerPart(request, response, caseFile(m_session.now()));
    });
    get("surface", [this](const Request& request, Response& response) {
      answerPart(request, response,
                 m_session.surfacePack(levelOf(request), request.has_param("quick")));
    });
    getSlowly("distance", [this](const Request& request, Progress& progress) {
      return m_session.distancePack(levelOf(request), request.has_param("quick"), progress);
    });
    getSlowly("deviation", [this](const Request& request, Progress& progress) {
      return deviationPack(m_session.now(), numberOf(request, "id"), progress);
    });
    get("mesh", [this](const Request& request, Response& response) {
      answerPart(request, response, meshPack(m_session.now(), numberOf(request, "id")));
    });
    get("series_picture", [this](const Request& request, Response& response) {
      answerPart(request, response,
                 m_session.series.picture(static_cast<std::size_t>(numberOf(request, "series"))));
    });
    for (const auto& [name, role] :
         {std::pair{"volume", FileRole::Volume}, std::pair{"second", FileRole::Second},
          std::pair{"labels", FileRole::Labels}})
      get(name, [this, role = role](const Request& request, Response& response) {
        answerVolume(request, response, role);
      });
    get("events", [this](const Request&, Response& response) { answerEvents(response); });
    get("save",
        [this](const Request& request, Response& response) { answerSave(request, response); });
  }

  void addWork() {
    post("do", [this](formats::JsonValue request) { return m_session.run(request); });
    post("vessel_at_click",
         [this](formats::JsonValue request) { return m_session.vesselAtClick(request); });
    post("cancel", [this](formats::JsonValue request) -> Json {
      const Arguments arguments(request);
      return {
          {"cancelled", m_session.jobs.cancel(static_cast<int>(arguments.index("job", 1U << 30)))}};
    });
  }

  void addFiles() {
    m_http.Post(at("file"), [this](const Request& request, Response& response,
                                   const httplib::ContentReader& reader) {
      guarded(response, [&] { takeFile(request, response, reader); });
    });
    m_http.Post(at("series_file"), [this](const Request& request, Response& response,
                                          const httplib::ContentReader& reader) {
      guarded(response, [&] { takeSeriesFile(request, response, reader); });
    });
  }

  void answerVolume(const Request& request, Response& response, FileRole role) {
    Tagged none;
    const auto pack = m_session.packs.volumePack(m_session.now(), role, none.tag);
    if (!pack || request.get_header_value("If-None-Match") == '"' + none.tag + '"') {
      if (pack) none.bytes = std::make_shared<const std::string>();
      return answerPart(request, response, none);
    }
    response.set_header("ETag", '"' + none.tag + '"');
    // two megabytes at a time, so that no copy of the volume is in memory
    response.set_content_provider(
        pack->size(), kBytes,
        [pack](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          const std::string bytes =
              pack->bytes(offset, std::min<std::size_t>(length, std::size_t{2} << 20));
          return sink.write(bytes.data(), bytes.size());
        });
  }

  void answerEvents(Response& response) {
    const auto listener = m_session.events.listen();
    if (!listener)
      return answerError(
          response, 503,
          "at most " + std::to_string(EventHub::kMostListeners) + " pages may be open");
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

  void answerSave(const Request& request, Response& response) {
    const std::string format = request.get_param_value("format");
    SavingOptions options;
    for (const auto& [name, value] : request.params)
      if (name != "format") options.emplace_back(name, value);
    const bool isPage = format == "html";
    std::string bytes;
    whileConnected(request.remote_port, [&](Progress& progress) {
      bytes = isPage
                  ? htmlPage(m_session, m_page, htmlOptions(options), progress)
                  : encoded(m_session.now().document, format, options, m_session.options, progress);
    });
    const std::string ending = format == "seeds" ? ".seeds.json" : "." + format;
    const Json title = m_session.state()["title"];
    response.set_header(
        "Content-Disposition",
        "attachment; filename=\"" + downloadName(title.get<std::string>(), ending) + "\"");
    answerText(response, std::move(bytes), kBytes);
  }

  [[nodiscard]] static std::string nameOf(const Request& request) {
    std::string name = request.get_param_value("name");
    if (name.empty() || name.size() > 255) throw Error(ErrorKind::Usage, "a file needs a name");
    return name;
  }

  void takeSeriesFile(const Request& request, Response& response,
                      const httplib::ContentReader& reader) {
    const std::uint64_t announced = request.get_header_value<std::uint64_t>("Content-Length");
    m_session.series.take(numberOf(request, "batch"), nameOf(request), announced, m_mostFile,
                          [&] { return bodyOf(request, reader, announced); });
    answerText(response, "{}");
  }

  void takeFile(const Request& request, Response& response, const httplib::ContentReader& reader) {
    const std::string name = nameOf(request), as = request.get_param_value("as");
    if (request.get_header_value<std::uint64_t>("Content-Length") > m_mostFile)
      refuseSize(m_mostFile);
    const OpenAs role = openAs(as);
    std::string bytes = bodyOf(request, reader, m_mostFile);
    answerText(response, jsonText(m_session.openDropped(name, std::move(bytes), role)));
  }

  Session& m_session;
  const PageFiles m_page;
  const std::string m_token;
  const std::uint64_t m_mostFile;
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
