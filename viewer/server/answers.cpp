// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/answers.h"

#include <algorithm>

#include "converters/base/shown_text.h"

namespace lumen::viewer {

namespace {

// A click and its options are a few hundred bytes, a list of all labels of a large tree some 100
// kB.
constexpr std::size_t kMostRequest = 1 << 20;

}  // namespace

httplib::Headers safeHeaders() {
  return {{"Content-Security-Policy",
           "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
           "connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; "
           "frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"X-Frame-Options", "DENY"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cross-Origin-Opener-Policy", "same-origin"},
          {"Cache-Control", "no-store"}};
}

void answerBytes(httplib::Response& response, std::shared_ptr<const std::string> bytes,
                 const char* type) {
  const std::size_t size = bytes->size();
  response.set_content_provider(
      size, type,
      [bytes = std::move(bytes)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(bytes->data() + offset, length);
      });
}

void answerText(httplib::Response& response, std::string text, const char* type) {
  answerBytes(response, std::make_shared<const std::string>(std::move(text)), type);
}

void answerError(httplib::Response& response, int status, const std::string& sentence) {
  response.status = status;
  answerText(response, jsonText({{"error", messageText(sentence)}}));
}

void answerPart(const httplib::Request& request, httplib::Response& response, const Tagged& part) {
  if (!part.bytes) {
    response.status = 404;
    return;
  }
  const std::string tag = '"' + part.tag + '"';
  response.set_header("ETag", tag);
  if (request.get_header_value("If-None-Match") == tag) {
    response.status = 304;
    return;
  }
  answerBytes(response, part.bytes, kBytes);
}

int statusOf(ErrorKind kind) {
  return kind == ErrorKind::Failed ? 500 : 400;
}

void refuseSize(std::uint64_t most) {
  throw Error(ErrorKind::Usage, "at most " + std::to_string(most) + " bytes are taken here");
}

std::string bodyOf(const httplib::Request& request, const httplib::ContentReader& reader,
                   std::uint64_t most) {
  if (request.is_multipart_form_data())
    throw Error(ErrorKind::Usage, "the body must be plain, not a form in several parts");
  std::string body;
  const auto announced = request.get_header_value<std::uint64_t>("Content-Length");
  body.reserve(std::min(announced, most));
  bool tooMuch = false;
  const bool whole = reader([&](const char* data, std::size_t length) {
    tooMuch = body.size() + length > most;
    if (!tooMuch) body.append(data, length);
    return !tooMuch;
  });
  if (tooMuch) refuseSize(most);
  if (!whole) throw Error(ErrorKind::Usage, "the request broke off");
  return body;
}

formats::JsonDocument readJson(const httplib::Request& request,
                               const httplib::ContentReader& reader) {
  return parseRequest(bodyOf(request, reader, kMostRequest), kMostRequest);
}

}  // namespace lumen::viewer
