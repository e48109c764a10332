// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/answers.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "converters/base/error.h"

namespace lumen::viewer {

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

void handOver(PageAnswer answer, httplib::Response& response) {
  response.status = answer.status;
  if (!answer.tag.empty()) response.set_header("ETag", '"' + answer.tag + '"');
  if (!answer.fileName.empty())
    response.set_header("Content-Disposition", "attachment; filename=\"" + answer.fileName + "\"");
  if (!answer.piece) return;
  response.set_content_provider(
      answer.size, answer.type,
      [piece = std::move(answer.piece)](std::size_t offset, std::size_t length,
                                        httplib::DataSink& sink) {
        const std::string_view bytes = piece(offset, length);
        return sink.write(bytes.data(), bytes.size());
      });
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

}  // namespace lumen::viewer
