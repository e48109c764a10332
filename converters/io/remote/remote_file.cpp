// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/remote_file.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/sha256.h"
#include "converters/io/remote/http_request.h"
#include "converters/io/remote/object_store.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

constexpr int kMostTries = 1000;
constexpr unsigned kLongestPauseMs = 30000;

/// Waits before another try, longer each time, and stops at Ctrl-C.
void pauseBefore(int further, const RemoteOptions& options, const Progress& progress) {
  constexpr std::chrono::milliseconds kTick{50};
  const auto wait = std::chrono::milliseconds(
      std::min(kLongestPauseMs, options.pauseMs << std::min(further - 1, 6)));
  for (auto left = wait; left.count() > 0; left -= kTick) {
    progress.check();
    std::this_thread::sleep_for(std::min(left, kTick));
  }
}

/// Appends a file to another one.
void append(const fs::path& from, const fs::path& to) {
  std::ifstream in(from, std::ios::binary);
  std::ofstream out(to, std::ios::binary | std::ios::app);
  out << in.rdbuf();
  out.flush();
  if (!in || !out) throw failed(to.string() + ": cannot be written");
}

/// A file that comes in one piece, or in several.
class HttpTransfer {
public:
  HttpTransfer(const RemoteAddress& address, fs::path target, const RemoteOptions& options,
               Progress& progress)
      : m_address(address),
        m_target(std::move(target)),
        m_piece(m_target.string() + ".piece"),
        m_options(options),
        m_progress(progress) {}

  void run() {
    int fruitless = 0;
    for (int tries = 0; tries < kMostTries && fruitless < m_options.fruitlessTries; ++tries) {
      if (fruitless > 0) pauseBefore(fruitless, m_options, m_progress);
      const std::uint64_t before = m_bytes;
      if (takePiece()) return;
      fruitless = m_bytes > before ? 0 : fruitless + 1;
    }
    throw remoteError(
        ErrorKind::Failed, m_address,
        "the transfer breaks off after " + std::to_string(m_bytes) + " bytes: " + m_why);
  }

private:
  /// Asks for what is missing; true if the file is whole then.
  bool takePiece() {
    HttpRequest request{m_piece, {}, m_version, m_options.mostBytes - m_bytes};
    const bool goesOn = m_bytes > 0;
    if (goesOn) request.range = std::to_string(m_bytes) + "-";
    const HttpResult result = requestByCurl(m_address, request, m_options, m_progress);
    m_why = result.why;
    if (result.end == HttpEnd::TooLarge)
      throw remoteError(ErrorKind::InvalidInput, m_address,
                        "the file has more than " + std::to_string(m_options.mostBytes) +
                            " bytes, the most that lumen fetches");
    if (result.bytes == 0 && result.end == HttpEnd::Whole && !goesOn) writeNewFile("", m_piece);
    std::error_code ignored;
    const bool isPiece = result.bytes > 0 || !goesOn;
    const bool isKept =
        isPiece && fs::exists(m_piece, ignored) && (goesOn ? addPiece(result) : beginWith(result));
    fs::remove(m_piece, ignored);
    // an answer that is whole may be a shorter range than the one that was asked for
    return isKept && result.end == HttpEnd::Whole && (!m_whole || m_bytes == *m_whole);
  }

  /// The first piece, or that of a server that sends only whole files.
  bool beginWith(const HttpResult& result) {
    if (result.answer.status != 200) {
      m_why = "the server answers a part where the whole was asked for";
      return false;
    }
    fs::rename(m_piece, m_target);
    m_whole = result.answer.length;
    m_version = result.answer.version;
    m_bytes = result.bytes;
    return true;
  }

  /// A piece that continues the file; another one makes it begin anew.
  bool addPiece(const HttpResult& result) {
    if (result.answer.status == 200) return restartWith(result);
    const auto& range = result.answer.range;
    if (!range || range->first != m_bytes || result.bytes > range->last - range->first + 1 ||
        (m_whole && range->whole && range->whole != m_whole)) {
      m_why = "the server answers another range than the one that was asked for";
      return forget();
    }
    append(m_piece, m_target);
    m_bytes += result.bytes;
    if (!m_whole) m_whole = range->whole;
    return true;
  }

  bool restartWith(const HttpResult& result) {
    m_why = "the server sends no ranges, and breaks off again and again";
    countRestart();
    return beginWith(result);
  }

  bool forget() {
    countRestart();
    m_bytes = 0;
    m_version.clear();
    m_whole.reset();
    return false;
  }

  void countRestart() {
    if (++m_restarts < m_options.fruitlessTries) return;
    throw remoteError(ErrorKind::Failed, m_address, m_why);
  }

  const RemoteAddress& m_address;
  fs::path m_target, m_piece;
  const RemoteOptions& m_options;
  Progress& m_progress;
  std::uint64_t m_bytes = 0;             ///< of the file that are here
  std::optional<std::uint64_t> m_whole;  ///< as the server states it
  std::string m_version, m_why;
  int m_restarts = 0;
};

/// The head of a file of the web; see fetchHead().
std::optional<RemoteHead> httpHead(const RemoteAddress& address, std::uint64_t count,
                                   const fs::path& output, const RemoteOptions& options,
                                   Progress& progress) {
  std::string why;
  for (int tries = 0; tries < options.fruitlessTries; ++tries) {
    if (tries > 0) pauseBefore(tries, options, progress);
    const HttpRequest request{output, "0-" + std::to_string(count - 1), {}, count};
    const HttpResult result = requestByCurl(address, request, options, progress);
    why = result.why;
    if (result.end == HttpEnd::TooLarge) return {};
    if (result.end == HttpEnd::Cut) continue;
    RemoteHead head{readWholeFile(output, "part of a file", count), 0};
    const auto& range = result.answer.range;
    const bool isPart = result.answer.status == 206;
    if (isPart && (!range || !range->whole)) return {};
    head.whole = isPart ? *range->whole : head.bytes.size();
    if (!isPart || (range->first == 0 && head.bytes.size() == std::min(count, head.whole)))
      return head;
    why = "the server answers another range than the one that was asked for";
  }
  throw remoteError(ErrorKind::Failed, address, why);
}

}  // namespace

RemoteFile fetchFile(const RemoteAddress& address, const fs::path& folder,
                     const RemoteOptions& options, Progress& progress) {
  RemoteFile file{folder / address.fileName(), 0, {}};
  progress.begin("downloading", 0);
  if (address.scheme == RemoteScheme::S3)
    fetchObject(address, file.path, options, progress);
  else
    HttpTransfer(address, file.path, options, progress).run();
  const FileDigest digest = digestOfFile(file.path);
  file.bytes = digest.bytes;
  file.sha256 = digest.sha256;
  progress.end();
  return file;
}

std::optional<RemoteHead> fetchHead(const RemoteAddress& address, std::uint64_t count,
                                    const fs::path& scratch, const RemoteOptions& options,
                                    Progress& progress) {
  const fs::path output = scratch / "head";
  progress.begin("asking", 0);
  std::optional<RemoteHead> head;
  if (address.scheme == RemoteScheme::S3)
    head = fetchObjectHead(address, count, output, options, progress);
  else
    head = httpHead(address, count, output, options, progress);
  std::error_code ignored;
  fs::remove(output, ignored);
  progress.end();
  return head;
}

}  // namespace lumen::convert
