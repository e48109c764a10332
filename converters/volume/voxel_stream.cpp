// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/voxel_stream.h"

#include <array>
#include <utility>

#include <zlib.h>

#include "converters/common/error.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kInput = 1 << 18;
constexpr std::size_t kChunk = 4 << 20;  // between two looks at whether the user has cancelled

}  // namespace

struct VoxelStream::Inflater {
  z_stream zlib{};
  std::vector<unsigned char> input = std::vector<unsigned char>(kInput);
  bool atEnd = false;  ///< of the last member

  Inflater() {
    constexpr int kWindowAndAnyHeader = 15 + 32;
    if (inflateInit2(&zlib, kWindowAndAnyHeader) != Z_OK) throw failed("zlib does not start");
  }
  ~Inflater() { inflateEnd(&zlib); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

VoxelStream::VoxelStream(fs::path path, std::size_t offset, Packing packing,
                         const Progress& progress)
    : m_path(std::move(path)), m_file(m_path, std::ios::binary), m_progress(&progress) {
  if (!m_file.seekg(static_cast<std::streamoff>(offset)))
    throw invalidInput(m_path.string() + ": cannot be opened");
  if (packing == Packing::Deflate) m_inflater = std::make_unique<Inflater>();
}

VoxelStream::~VoxelStream() = default;
VoxelStream::VoxelStream(VoxelStream&&) noexcept = default;

std::size_t VoxelStream::read(std::span<std::byte> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    m_progress->check();
    const auto part = to.subspan(done, std::min(kChunk, to.size() - done));
    const std::size_t got = m_inflater ? inflateSome(part) : readPlain(part);
    done += got;
    m_given += got;
    if (got < part.size()) break;
  }
  return done;
}

std::size_t VoxelStream::skip(std::size_t count) {
  std::vector<std::byte> nowhere(std::min(count, kChunk));
  std::size_t done = 0;
  while (done < count) {
    const std::size_t part = std::min(nowhere.size(), count - done);
    const std::size_t got = read(std::span(nowhere).first(part));
    done += got;
    if (got < part) break;
  }
  return done;
}

std::size_t VoxelStream::readPlain(std::span<std::byte> to) {
  m_file.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
  return static_cast<std::size_t>(m_file.gcount());
}

/// Makes sure that there is input; false at the end of the file.
bool VoxelStream::fillInput() {
  z_stream& zlib = m_inflater->zlib;
  if (zlib.avail_in > 0) return true;
  auto& input = m_inflater->input;
  m_file.read(reinterpret_cast<char*>(input.data()), static_cast<std::streamsize>(input.size()));
  zlib.next_in = input.data();
  zlib.avail_in = static_cast<unsigned>(m_file.gcount());
  return zlib.avail_in > 0;
}

std::size_t VoxelStream::inflateSome(std::span<std::byte> to) {
  z_stream& zlib = m_inflater->zlib;
  zlib.next_out = reinterpret_cast<unsigned char*>(to.data());
  zlib.avail_out = static_cast<unsigned>(to.size());
  while (zlib.avail_out > 0 && !m_inflater->atEnd) {
    const bool hasInput = fillInput();
    const int state = hasInput ? inflate(&zlib, Z_NO_FLUSH) : Z_BUF_ERROR;
    if (state == Z_STREAM_END) {
      // another member may follow; anything else is padding, as gzip itself takes it
      constexpr unsigned char kGzipMagic = 0x1f;
      m_inflater->atEnd = !fillInput() || *zlib.next_in != kGzipMagic;
      if (!m_inflater->atEnd) inflateReset(&zlib);
    } else if (state != Z_OK) {
      const std::size_t given = m_given + to.size() - zlib.avail_out;
      throw invalidInput(m_path.string() + ": its compressed data is " +
                         (hasInput ? "damaged" : "truncated") + ": only " + std::to_string(given) +
                         " bytes come out of it; copy or compress the file again");
    }
  }
  return to.size() - zlib.avail_out;
}

bool isGzip(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 2> magic{};
  file.read(magic.data(), magic.size());
  return file && magic[0] == '\x1f' && magic[1] == '\x8b';
}

void refuseShort(const fs::path& path, std::size_t got, std::size_t needed) {
  throw invalidInput(path.string() + ": truncated: " + std::to_string(got) + " of " +
                     std::to_string(needed) + " bytes of voxels can be read");
}

}  // namespace lumen::convert
