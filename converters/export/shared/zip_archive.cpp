// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/zip_archive.h"

#include <zlib.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

constexpr std::uint32_t kUnix = 3U << 8U;  // attributes are those of Unix

void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::string packedForZip(const std::string& raw) {
  z_stream stream{};
  // raw deflate, as zip has it
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw failed("zlib could not begin to compress");
  std::string out(deflateBound(&stream, static_cast<uLong>(raw.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(raw.data()));
  stream.avail_in = static_cast<uInt>(raw.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw failed("zlib could not compress a file of a zip");
  return out;
}

}  // namespace

void ZipArchive::add(const std::string& name, const std::string& raw, bool isProgram) {
  if (raw.size() >= UINT32_MAX || m_bytes.size() >= UINT32_MAX / 2)
    throw unsupported("the files are too large for a zip without its 64-bit extension");
  const std::string packed = packedForZip(raw);
  const auto crc = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(raw.data()), static_cast<uInt>(raw.size())));
  const auto offset = static_cast<std::uint32_t>(m_bytes.size());
  std::string common;
  put(common, 20, 2);               // version needed: 2.0
  put(common, 0, 2);                // flags
  put(common, 8, 2);                // deflate
  put(common, 0, 2);                // time
  put(common, (1U << 5U) | 1U, 2);  // date: 1980-01-01
  put(common, crc, 4);
  put(common, static_cast<std::uint32_t>(packed.size()), 4);
  put(common, static_cast<std::uint32_t>(raw.size()), 4);
  put(common, static_cast<std::uint32_t>(name.size()), 2);
  put(common, 0, 2);  // no extra field
  put(m_bytes, 0x04034b50, 4);
  m_bytes += common + name + packed;
  put(m_directory, 0x02014b50, 4);
  put(m_directory, kUnix | 20, 2);  // version made by
  m_directory += common;
  put(m_directory, 0, 2);                                         // no comment
  put(m_directory, 0, 2);                                         // disk
  put(m_directory, 0, 2);                                         // internal attributes
  put(m_directory, (isProgram ? 0100755U : 0100644U) << 16U, 4);  // external attributes: mode
  put(m_directory, offset, 4);
  m_directory += name;
  ++m_count;
}

std::string ZipArchive::bytes() const {
  std::string end;
  put(end, 0x06054b50, 4);
  put(end, 0, 4);  // disks
  put(end, m_count, 2);
  put(end, m_count, 2);
  put(end, static_cast<std::uint32_t>(m_directory.size()), 4);
  put(end, static_cast<std::uint32_t>(m_bytes.size()), 4);
  put(end, 0, 2);  // no comment
  return m_bytes + m_directory + end;
}

}  // namespace lumen::convert
