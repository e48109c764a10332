// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/http_request.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/run_program.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

constexpr unsigned kLongestTransfer = 7 * 24 * 3600;  // s
constexpr std::uint64_t kMostHeadBytes = 1 << 20;     // of all answers on the way
constexpr const char* kMostRedirections = "5";
constexpr const char* kConnectSeconds = "20";

// Exit codes of curl.
constexpr int kNoHost = 6, kHttpError = 22, kNotWritten = 23, kRedirectedTooOften = 47,
              kTooLarge = 63, kBadProtocol = 1;
/// No connection, a cut one, an end of time, an empty answer, errors of sending and of receiving, a
/// broken stream of HTTP/2: another try may help.
constexpr std::array kTransient = {7, 16, 18, 28, 52, 55, 56, 92, 95};
/// Answers of servers that have no time.
constexpr std::array kBusy = {408, 429, 500, 502, 503, 504};

template <class List>
bool holds(const List& list, int code) {
  return std::find(list.begin(), list.end(), code) != list.end();
}

std::vector<std::string> argumentsFor(const RemoteAddress& address, const HttpRequest& request,
                                      const fs::path& head, const RemoteOptions& options) {
  // a page that was asked for safely stays safe
  const bool isSafe = address.scheme == RemoteScheme::Https;
  std::vector<std::string> words = {"-q",  // no configuration file
                                    "--silent",
                                    "--show-error",
                                    "--fail",
                                    "--globoff",
                                    "--proto",
                                    "=http,https",
                                    "--proto-redir",
                                    isSafe ? "=https" : "=http,https",
                                    "--location",
                                    "--max-redirs",
                                    kMostRedirections,
                                    "--connect-timeout",
                                    kConnectSeconds,
                                    "--speed-limit",
                                    "1",
                                    "--speed-time",
                                    std::to_string(options.stallSeconds),
                                    "--max-filesize",
                                    std::to_string(request.mostBytes),
                                    "--user-agent",
                                    "lumen/" LUMEN_VERSION,
                                    "--dump-header",
                                    head.string(),
                                    "--output",
                                    request.output.string()};
  if (request.range) words.insert(words.end(), {"--range", *request.range});
  if (request.range && !request.version.empty())
    words.insert(words.end(), {"--header", "If-Range: " + request.version});
  words.insert(words.end(), {"--url", address.text});
  return words;
}

/// curl's sentence without its name and number.
std::string sentenceOf(const ProgramResult& result) {
  std::string text = trimmed(result.errors);
  text = text.substr(0, text.find('\n'));
  if (const std::size_t at = text.find(") "); text.starts_with("curl: (") && at != text.npos)
    text.erase(0, at + 2);
  return text.empty() ? "curl ended with code " + std::to_string(result.code)
                      : formats::printable(text);
}

[[noreturn]] void refuseStatus(const RemoteAddress& address, int status) {
  const std::string number = " (HTTP status " + std::to_string(status) + ")";
  if (status == 404 || status == 410)
    throw remoteError(ErrorKind::InvalidInput, address, "the server has no such file" + number);
  if (status == 401 || status == 403)
    throw remoteError(ErrorKind::InvalidInput, address,
                      "the server does not give this file to everybody" + number);
  throw remoteError(ErrorKind::InvalidInput, address, "the server refuses the request" + number);
}

/// Refuses what no other try mends.
void refuseFinal(const RemoteAddress& address, const ProgramResult& result, int status) {
  if (result.code == kHttpError && !holds(kBusy, status)) refuseStatus(address, status);
  if (result.code == kHttpError || holds(kTransient, result.code)) return;
  if (result.code == kBadProtocol)
    throw remoteError(
        ErrorKind::Failed, address,
        "the server redirects to an address that lumen does not follow: " + sentenceOf(result));
  if (result.code == kRedirectedTooOften)
    throw remoteError(ErrorKind::Failed, address, "the server redirects again and again");
  if (result.code == kNoHost)
    throw remoteError(ErrorKind::Failed, address, "the host is not found");
  throw remoteError(ErrorKind::Failed, address, sentenceOf(result));
}

std::uint64_t sizeOf(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

/// Sets the end of a request, and refuses what no other try mends.
void judge(const ProgramResult& result, const RemoteAddress& address, const HttpRequest& request,
           HttpResult& done) {
  const bool isFull = done.bytes >= std::max(request.mostBytes, kMostHeadBytes);
  const bool isDone = result.end == ProgramEnd::Done, isRefused = result.end == ProgramEnd::Refused;
  if (isDone ? done.bytes > request.mostBytes : result.code == kTooLarge || isFull) {
    done.end = HttpEnd::TooLarge;
    return;
  }
  done.end = isDone ? HttpEnd::Whole : HttpEnd::Cut;
  if (isDone) return;
  if (isRefused && result.code == kNotWritten)
    throw remoteError(ErrorKind::Failed, address,
                      "cannot be written below " + request.output.parent_path().string() +
                          ", where TMPDIR may name a larger disk");
  if (isRefused) refuseFinal(address, result, done.answer.status);
  done.why = isRefused ? sentenceOf(result) : "curl crashed";
}

}  // namespace

Error remoteError(ErrorKind kind, const RemoteAddress& address, const std::string& what) {
  return {kind, formats::printable(address.shown()) + ": " + what};
}

HttpResult requestByCurl(const RemoteAddress& address, const HttpRequest& request,
                         const RemoteOptions& options, const Progress& progress) {
  const auto curl = installedProgram("curl");
  if (!curl)
    throw remoteError(ErrorKind::Unsupported, address,
                      "lumen makes such requests by curl, which is not installed");
  const fs::path head = request.output.string() + ".head";
  ProgramCall call;
  call.program = *curl;
  call.arguments = argumentsFor(address, request, head, options);
  call.folder = request.output.parent_path();
  call.seconds = kLongestTransfer;
  // a server that announces no length is stopped, too
  call.mostFileBytes = std::max(request.mostBytes, kMostHeadBytes);
  const ProgramResult result = runProgram(call, progress);
  HttpResult done;
  std::error_code ignored;
  if (fs::exists(head, ignored))
    done.answer = parseHttpAnswer(readWholeFile(head, "head of an answer", kMostHeadBytes));
  fs::remove(head, ignored);
  done.bytes = sizeOf(request.output);
  judge(result, address, request, done);
  return done;
}

}  // namespace lumen::convert
