// SPDX-License-Identifier: Apache-2.0
#include "viewer/routes/routes.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"

namespace lumen::viewer {

namespace {

// A click and its options are a few hundred bytes, a list of all labels of a large tree some 100
// kB.
constexpr std::size_t kMostRequest = 1 << 20;
// A volume goes out in parts of this size, bytes, so that no copy of it is in memory.
constexpr std::uint64_t kPiece = std::uint64_t{2} << 20;

int levelOf(const PageRequest& request) {
  const std::string text = request.value("level");
  if (text.empty()) return 0;
  if (text.size() > 1 || text[0] < '0' || text[0] > '9')
    throw Error(ErrorKind::Usage, "\"level\" must be a digit");
  return text[0] - '0';
}

int numberOf(const PageRequest& request, const char* name) {
  const std::string text = request.value(name);
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != text.npos)
    throw Error(ErrorKind::Usage, std::string("\"") + name + "\" must be a number");
  return std::stoi(text);
}

OpenAs openingAs(const std::string& word) {
  if (word.empty() || word == "auto") return OpenAs::Auto;
  if (word == "truth") return OpenAs::Truth;
  if (word == "second") return OpenAs::Second;
  if (word == "labels") return OpenAs::Labels;
  throw Error(ErrorKind::Usage, "\"as\" must be auto, truth, second or labels");
}

std::string fileNameOf(const PageRequest& request) {
  std::string name = request.value("name");
  if (name.empty() || name.size() > 255) throw Error(ErrorKind::Usage, "a file needs a name");
  return name;
}

/// A name for a download that every system takes.
std::string downloadName(const std::string& title, const std::string& ending) {
  std::string name;
  for (const char c : title.substr(0, title.find('.')))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return (name.empty() ? "lumen" : name.substr(0, 80)) + ending;
}

PageAnswer jsonAnswer(const Json& value) {
  return answerOf(std::make_shared<const std::string>(jsonText(value)));
}

/// A part of the document; 304 if the page has it, 404 without bytes if there is none.
PageAnswer partAnswer(const PageRequest& request, const Tagged& part) {
  PageAnswer answer;
  answer.status = 404;
  if (!part.bytes) return answer;
  answer.status = 304;
  if (request.knownTag != part.tag) answer = answerOf(part.bytes, kBytesType);
  answer.tag = part.tag;
  return answer;
}

bool isQuick(const PageRequest& request) {
  return request.query.contains("quick");
}

/// The status of a request that ended in an error of that kind.
int statusOf(ErrorKind kind) {
  return kind == ErrorKind::Failed ? 500 : 400;
}

}  // namespace

std::string PageRequest::value(const std::string& word) const {
  const auto found = query.find(word);
  return found == query.end() ? std::string() : found->second;
}

PageAnswer answerOf(std::shared_ptr<const std::string> bytes, const char* type) {
  PageAnswer answer;
  answer.type = type;
  answer.size = bytes->size();
  answer.piece = [bytes = std::move(bytes)](std::uint64_t offset, std::uint64_t length) {
    return std::string_view(*bytes).substr(offset, length);
  };
  return answer;
}

PageAnswer refusalOf(int status, const std::string& sentence) {
  PageAnswer answer = jsonAnswer({{"error", messageText(sentence)}});
  answer.status = status;
  return answer;
}

void refuseSize(std::uint64_t most) {
  throw Error(ErrorKind::Usage, "at most " + std::to_string(most) + " bytes are taken here");
}

Routes::Routes(Session& session, const PageFiles& page, std::uint64_t mostFile)
    : m_session(session), m_page(page), m_mostFile(mostFile) {
  addParts();
  addWork();
}

PageAnswer Routes::answer(const PageRequest& request) const {
  const auto& handlers = request.isPost ? m_posts : m_gets;
  const auto handler = handlers.find(request.name);
  PageAnswer none;
  none.status = 404;
  if (handler == handlers.end()) return none;
  try {
    return handler->second(request);
  } catch (const Conflict& conflict) {
    return refusalOf(409, conflict.what());
  } catch (const Error& error) {
    return refusalOf(statusOf(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return refusalOf(500, "there is not enough memory");
  } catch (const std::exception& error) {
    return refusalOf(500, std::string("unexpected: ") + error.what());
  }
}

void Routes::addPart(const std::string& name, std::function<Tagged(const PageRequest&)> part) {
  m_gets[name] = [part = std::move(part)](const PageRequest& request) {
    return partAnswer(request, part(request));
  };
}

void Routes::addSlowPart(const std::string& name,
                         std::function<Tagged(const PageRequest&, Progress&)> part) {
  m_gets[name] = [part = std::move(part)](const PageRequest& request) {
    PageAnswer answer;
    request.whileWanted(
        [&](Progress& progress) { answer = partAnswer(request, part(request, progress)); });
    return answer;
  };
}

void Routes::addPost(const std::string& name, std::function<Json(formats::JsonValue)> answer) {
  m_posts[name] = [answer = std::move(answer)](const PageRequest& request) {
    const formats::JsonDocument document =
        parseRequest(request.readBody(kMostRequest), kMostRequest);
    return jsonAnswer(answer(document.root()));
  };
}

void Routes::addParts() {
  m_gets["state"] = [this](const PageRequest&) { return jsonAnswer(m_session.state()); };
  addSlowPart("case", [this](const PageRequest&, Progress& progress) {
    return m_session.packs.casePack(m_session.now(), progress);
  });
  addSlowPart("proposals", [this](const PageRequest&, Progress& progress) {
    return proposalsPack(m_session.now(), progress);
  });
  addPart("library", [this](const PageRequest&) { return m_session.library.pack(); });
  addPart("measures", [this](const PageRequest& request) {
    return request.query.contains("kind") ? m_session.findings.measures(request.value("kind"))
                                          : m_session.findings.measures();
  });
  addPart("case.lumen", [this](const PageRequest&) { return caseFile(m_session.now()); });
  addPart("surface", [this](const PageRequest& request) {
    return m_session.surfacePack(levelOf(request), isQuick(request));
  });
  addSlowPart("distance", [this](const PageRequest& request, Progress& progress) {
    return m_session.distancePack(levelOf(request), isQuick(request), progress);
  });
  addSlowPart("deviation", [this](const PageRequest& request, Progress& progress) {
    return deviationPack(m_session.now(), numberOf(request, "id"), progress);
  });
  addPart("mesh", [this](const PageRequest& request) {
    return meshPack(m_session.now(), numberOf(request, "id"));
  });
  addPart("series_picture", [this](const PageRequest& request) {
    return m_session.series.picture(static_cast<std::size_t>(numberOf(request, "series")));
  });
  for (const auto& [name, role] :
       {std::pair{"volume", FileRole::Volume}, std::pair{"second", FileRole::Second},
        std::pair{"labels", FileRole::Labels}})
    m_gets[name] = [this, role = role](const PageRequest& request) {
      return volume(request, role);
    };
  m_gets["save"] = [this](const PageRequest& request) { return save(request); };
}

void Routes::addWork() {
  addPost("do", [this](formats::JsonValue request) { return m_session.run(request); });
  addPost("vessel_at_click",
          [this](formats::JsonValue request) { return m_session.vesselAtClick(request); });
  addPost("cancel", [this](formats::JsonValue request) -> Json {
    const Arguments arguments(request);
    return {
        {"cancelled", m_session.jobs.cancel(static_cast<int>(arguments.index("job", 1U << 30)))}};
  });
  m_posts["file"] = [this](const PageRequest& request) { return takeFile(request); };
  m_posts["series_file"] = [this](const PageRequest& request) { return takeSeriesFile(request); };
}

PageAnswer Routes::volume(const PageRequest& request, FileRole role) const {
  Tagged known;
  const auto pack = m_session.packs.volumePack(m_session.now(), role, known.tag);
  if (pack) known.bytes = std::make_shared<const std::string>();
  PageAnswer answer = partAnswer(request, known);
  if (!pack || answer.status == 304) return answer;
  answer.size = pack->size();
  answer.piece = [pack, piece = std::string()](std::uint64_t offset, std::uint64_t length) mutable {
    piece = pack->bytes(offset, std::min(length, kPiece));
    return std::string_view(piece);
  };
  return answer;
}

PageAnswer Routes::save(const PageRequest& request) const {
  const std::string format = request.value("format");
  SavingOptions options;
  for (const auto& [name, value] : request.query)
    if (name != "format") options.emplace_back(name, value);
  std::string bytes;
  request.whileWanted([&](Progress& progress) {
    bytes = format == "html"
                ? htmlPage(m_session, m_page, htmlOptions(options), progress)
                : encoded(m_session.now().document, format, options, m_session.options, progress);
  });
  PageAnswer answer = answerOf(std::make_shared<const std::string>(std::move(bytes)), kBytesType);
  const Json title = m_session.state()["title"];
  answer.fileName =
      downloadName(title.get<std::string>(), format == "seeds" ? ".seeds.json" : "." + format);
  return answer;
}

PageAnswer Routes::takeSeriesFile(const PageRequest& request) const {
  m_session.series.take(numberOf(request, "batch"), fileNameOf(request), request.bodySize,
                        m_mostFile, [&] { return request.readBody(request.bodySize); });
  return jsonAnswer(Json::object());
}

PageAnswer Routes::takeFile(const PageRequest& request) const {
  const std::string name = fileNameOf(request), as = request.value("as");
  if (request.bodySize > m_mostFile) refuseSize(m_mostFile);
  const OpenAs role = openingAs(as);
  std::string bytes = request.readBody(m_mostFile);
  return jsonAnswer(
      m_session.openDropped(name, std::move(bytes), role, request.query.contains("first")));
}

}  // namespace lumen::viewer
