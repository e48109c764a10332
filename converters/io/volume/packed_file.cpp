// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/packed_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/io/volume/text_header.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kUnpackedBlock = 1 << 18;

std::string shown(const fs::path& path) {
  return formats::printable(path.string());
}

/// Bytes of a file up to a limit, in blocks.
class Blocks {
public:
  Blocks(const InputFile& file, std::uint64_t start, std::optional<std::uint64_t> limit)
      : m_path(file.path()), m_stream(file.open()) {
    if (!m_stream->seekg(static_cast<std::streamoff>(start)))
      throw invalidInput(shown(m_path) + ": cannot be opened");
    if (limit) m_left = *limit;
  }

  /// The buffered bytes, at least one unless the file has ended.
  std::string_view peek() {
    if (m_at == m_held) {
      m_at = 0;
      m_held = fill(m_block.data(), std::min<std::uint64_t>(kUnpackedBlock, m_left));
      m_left -= m_held;
    }
    return {m_block.data() + m_at, m_held - m_at};
  }
  void drop(std::size_t count) { m_at += count; }

  /// Reads past the buffer, for unpacked data.
  std::size_t read(std::byte* to, std::size_t size) {
    std::size_t got = std::min(size, m_held - m_at);
    if (got > 0) std::memcpy(to, m_block.data() + m_at, got);
    m_at += got;
    if (got < size) {
      const auto rest =
          fill(reinterpret_cast<char*>(to) + got, std::min<std::uint64_t>(size - got, m_left));
      m_left -= rest;
      got += rest;
    }
    return got;
  }

  /// Skips a line; false if the file ends first.
  bool skipLine() {
    for (std::string_view text = peek(); !text.empty(); text = peek()) {
      const auto end = text.find('\n');
      drop(end == std::string_view::npos ? text.size() : end + 1);
      if (end != std::string_view::npos) return true;
    }
    return false;
  }

  [[nodiscard]] const fs::path& path() const { return m_path; }

private:
  std::size_t fill(char* to, std::uint64_t size) {
    m_stream->read(to, static_cast<std::streamsize>(size));
    if (m_stream->bad()) throw invalidInput(m_path.string() + ": cannot be read to its end");
    return static_cast<std::size_t>(m_stream->gcount());
  }
  fs::path m_path;
  std::unique_ptr<std::istream> m_stream;
  std::array<char, kUnpackedBlock> m_block{};
  std::size_t m_at = 0, m_held = 0;
  std::uint64_t m_left = std::numeric_limits<std::uint64_t>::max();
};

class RawFile : public PackedFile {
public:
  explicit RawFile(std::unique_ptr<Blocks> blocks) : m_blocks(std::move(blocks)) {}
  std::size_t read(std::byte* to, std::size_t size) override { return m_blocks->read(to, size); }
  bool hasMore() override { return false; }  // checkStored() has checked the size

private:
  std::unique_ptr<Blocks> m_blocks;
};

class DeflatedFile : public PackedFile {
public:
  explicit DeflatedFile(std::unique_ptr<Blocks> blocks) : m_blocks(std::move(blocks)) {
    constexpr int kWindowAndAnyHeader = 15 + 32;
    if (inflateInit2(&m_stream, kWindowAndAnyHeader) != Z_OK) throw failed("zlib does not start");
  }
  ~DeflatedFile() override { inflateEnd(&m_stream); }
  DeflatedFile(const DeflatedFile&) = delete;
  DeflatedFile& operator=(const DeflatedFile&) = delete;

  std::size_t read(std::byte* to, std::size_t size) override {
    std::size_t got = 0;
    while (got < size && !m_ended) {
      const std::string_view in = m_blocks->peek();
      if (in.empty()) break;
      const std::size_t room = std::min<std::size_t>(size - got, 1U << 30);
      m_stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
      m_stream.avail_in = static_cast<uInt>(in.size());
      m_stream.next_out = reinterpret_cast<Bytef*>(to + got);
      m_stream.avail_out = static_cast<uInt>(room);
      const int state = inflate(&m_stream, Z_NO_FLUSH);
      m_blocks->drop(in.size() - m_stream.avail_in);
      got += room - m_stream.avail_out;
      if (state == Z_STREAM_END)
        m_ended = !nextMember();
      else if (state != Z_OK && state != Z_BUF_ERROR)
        throw damaged(m_stream.msg != nullptr ? m_stream.msg : "no such stream");
    }
    return got;
  }

  bool hasMore() override {
    std::byte next{};
    if (read(&next, 1) == 1) return true;
    if (!m_ended) throw damaged("it ends before its checksum");
    return false;
  }

private:
  /// True if another stream of gzip follows, as in files that several writers made.
  bool nextMember() {
    const std::string_view in = m_blocks->peek();
    if (in.size() < 2 || in[0] != '\x1f' || in[1] != '\x8b') return false;
    return inflateReset(&m_stream) == Z_OK;
  }
  [[nodiscard]] Error damaged(const std::string& how) const {
    return invalidInput(shown(m_blocks->path()) + ": its compressed voxels are damaged (" + how +
                        ")");
  }

  std::unique_ptr<Blocks> m_blocks;
  z_stream m_stream{};
  bool m_ended = false;
};

class HexFile : public PackedFile {
public:
  explicit HexFile(std::unique_ptr<Blocks> blocks) : m_blocks(std::move(blocks)) {}

  std::size_t read(std::byte* to, std::size_t size) override {
    std::size_t got = 0;
    for (; got < size; ++got) {
      const int high = digit(), low = high < 0 ? -1 : digit();
      if (low < 0) break;
      to[got] = static_cast<std::byte>(16 * high + low);
    }
    return got;
  }
  bool hasMore() override { return digit() >= 0; }

private:
  /// The next hexadecimal digit; -1 at the end.
  int digit() {
    for (std::string_view in = m_blocks->peek(); !in.empty(); in = m_blocks->peek()) {
      const char c = in[0];
      m_blocks->drop(1);
      if (c >= '0' && c <= '9') return c - '0';
      if (c >= 'a' && c <= 'f') return c - 'a' + 10;
      if (c >= 'A' && c <= 'F') return c - 'A' + 10;
      if (c != ' ' && c != '\n' && c != '\r' && c != '\t')
        throw invalidInput(shown(m_blocks->path()) + ": holds " + quotedText({&c, 1}) +
                           " among its voxels; expected hexadecimal digits");
    }
    return -1;
  }

  std::unique_ptr<Blocks> m_blocks;
};

/// Numbers as text into voxels of type T.
template <class T>
class TextFile : public PackedFile {
public:
  explicit TextFile(std::unique_ptr<Blocks> blocks) : m_blocks(std::move(blocks)) {}

  std::size_t read(std::byte* to, std::size_t size) override {
    std::size_t got = 0;
    for (; got + sizeof(T) <= size; got += sizeof(T)) {
      if (!nextWord()) break;
      const T value = parsed();
      std::memcpy(to + got, &value, sizeof(T));
    }
    return got;
  }
  bool hasMore() override { return nextWord(); }

private:
  static bool separates(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ',' || c == '\v' || c == '\f';
  }
  bool nextWord() {
    constexpr std::size_t kLongest = 400;  // digits of a number; a longer text is not a number
    m_word.clear();
    for (std::string_view in = m_blocks->peek(); !in.empty(); in = m_blocks->peek()) {
      const char c = in[0];
      if (separates(c) && !m_word.empty()) return true;
      m_blocks->drop(1);
      if (!separates(c)) m_word += c;
      if (m_word.size() > kLongest) throw refused();
    }
    return !m_word.empty();
  }
  T parsed() const {
    if constexpr (std::is_floating_point_v<T>) {
      T value = 0;
      const char* begin = m_word.data() + (m_word[0] == '+' ? 1 : 0);
      const char* end = m_word.data() + m_word.size();
      const auto [stop, error] = std::from_chars(begin, end, value);
      if (error != std::errc() || stop != end) throw refused();
      return value;
    } else {
      // writers print whole numbers as 1e+06 too
      const auto value = parsedNumber(m_word);
      const double low = static_cast<double>(std::numeric_limits<T>::min());
      const double high = std::ldexp(1.0, std::numeric_limits<T>::digits);
      if (!value || !(*value >= low && *value < high) || *value != std::floor(*value))
        throw refused();
      return static_cast<T>(*value);
    }
  }
  [[nodiscard]] Error refused() const {
    return invalidInput(shown(m_blocks->path()) + ": holds " + quotedText(m_word) +
                        " among its voxels; expected numbers that its pixel type holds");
  }

  std::unique_ptr<Blocks> m_blocks;
  std::string m_word;
};

/// Reads data that is not deflated.
std::unique_ptr<PackedFile> unpacked(const StoredVoxels& stored, std::unique_ptr<Blocks> blocks) {
  if (stored.packing == Packing::Text)
    return withPixelType(stored.type, [&](auto zero) -> std::unique_ptr<PackedFile> {
      return std::make_unique<TextFile<decltype(zero)>>(std::move(blocks));
    });
  if (stored.packing == Packing::Hex) return std::make_unique<HexFile>(std::move(blocks));
  return std::make_unique<RawFile>(std::move(blocks));
}

constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

/// Drops up to `count` bytes from `read`; returns their number.
template <class Read>
std::uint64_t dropBytes(std::uint64_t count, const Progress& progress, Read read) {
  std::vector<std::byte> dropped(kUnpackedBlock);
  std::uint64_t done = 0;
  while (done < count) {
    progress.check();
    const std::size_t got =
        read(dropped.data(),
             static_cast<std::size_t>(std::min<std::uint64_t>(count - done, kUnpackedBlock)));
    if (got == 0) break;
    done += got;
  }
  return done;
}

}  // namespace

std::unique_ptr<PackedFile> openPacked(const StoredVoxels& stored, const InputFile& file,
                                       std::uint64_t size, const Progress& progress) {
  const auto truncated = [&](const std::string& what) {
    return invalidInput(shown(file.path()) + ": truncated: it ends within the " + what +
                        " to be skipped before its voxels");
  };
  const auto behindLines = [&] {
    auto blocks = std::make_unique<Blocks>(file, stored.offset, stored.packedSize);
    for (std::uint64_t line = 0; line < stored.lineSkip; ++line) {
      if (line % 4096 == 0) progress.check();
      if (!blocks->skipLine()) throw truncated("lines");
    }
    return blocks;
  };
  // the bytes to be skipped are those of a compressed stream's contents
  if (stored.packing == Packing::Deflate) {
    const auto read = [](PackedFile& from) {
      return [&from](std::byte* to, std::size_t n) { return from.read(to, n); };
    };
    auto skip = static_cast<std::uint64_t>(std::max<std::int64_t>(stored.byteSkip, 0));
    if (stored.byteSkip < 0) {
      DeflatedFile whole(behindLines());
      const std::uint64_t all = dropBytes(kAll, progress, read(whole));
      const std::uint64_t behind = size + static_cast<std::uint64_t>(-1 - stored.byteSkip);
      if (all < behind) throw truncated("bytes");
      skip = all - behind;
    }
    auto voxels = std::make_unique<DeflatedFile>(behindLines());
    if (dropBytes(skip, progress, read(*voxels)) < skip) throw truncated("bytes");
    return voxels;
  }
  if (stored.byteSkip < 0) {
    const auto behind = size + static_cast<std::uint64_t>(-1 - stored.byteSkip);
    return unpacked(stored,
                    std::make_unique<Blocks>(file, file.size() - behind, stored.packedSize));
  }
  auto blocks = behindLines();
  const auto skip = static_cast<std::uint64_t>(stored.byteSkip);
  const auto read = [&](std::byte* to, std::size_t n) { return blocks->read(to, n); };
  if (dropBytes(skip, progress, read) < skip) throw truncated("bytes");
  return unpacked(stored, std::move(blocks));
}

}  // namespace lumen::convert
