// SPDX-License-Identifier: Apache-2.0
#include "converters/base/input_file.h"

#include <fstream>
#include <streambuf>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

using Parts = std::array<std::string_view, 2>;

/// Bytes that are not copied. The area of the buffer is that of one part at a time.
class MemoryBuffer : public std::streambuf {
public:
  explicit MemoryBuffer(const Parts& parts) : m_parts(parts) { enter(0, 0); }

private:
  /// Part `part` is the one that is read, from its byte `at` on.
  void enter(std::size_t part, std::size_t at) {
    m_part = part;
    char* begin = const_cast<char*>(m_parts[part].data());  // the buffer is for reading alone
    setg(begin, begin + at, begin + m_parts[part].size());
  }
  [[nodiscard]] off_type sizeOf(std::size_t part) const {
    return static_cast<off_type>(m_parts[part].size());
  }
  int_type underflow() override {
    if (gptr() == egptr() && m_part == 0) enter(1, 0);
    return gptr() == egptr() ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type here = (m_part == 0 ? 0 : sizeOf(0)) + (gptr() - eback());
    const off_type size = sizeOf(0) + sizeOf(1);
    const off_type place = offset + (from == std::ios_base::beg   ? 0
                                     : from == std::ios_base::cur ? here
                                                                  : size);
    if (place < 0 || place > size) return {off_type(-1)};
    const std::size_t part = place < sizeOf(0) ? 0 : 1;
    enter(part, static_cast<std::size_t>(place - (part == 0 ? 0 : sizeOf(0))));
    return {place};
  }
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override {
    return seekoff(off_type(place), std::ios_base::beg, which);
  }

  Parts m_parts;
  std::size_t m_part = 0;
};

class MemoryStream : public std::istream {
public:
  explicit MemoryStream(const Parts& parts) : std::istream(nullptr), m_buffer(parts) {
    rdbuf(&m_buffer);
  }

private:
  MemoryBuffer m_buffer;
};

}  // namespace

bool InputFile::isFolder() const {
  std::error_code ignored;
  return m_files != nullptr || (!m_bytes && std::filesystem::is_directory(m_path, ignored));
}

std::uint64_t InputFile::size() const {
  if (m_bytes) return (*m_bytes)[0].size() + (*m_bytes)[1].size();
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(m_path, error);
  if (error) throw invalidInput(formats::printable(m_path.string()) + ": " + error.message());
  return size;
}

std::unique_ptr<std::istream> InputFile::open() const {
  if (m_bytes) return std::make_unique<MemoryStream>(*m_bytes);
  auto stream = std::make_unique<std::ifstream>(m_path, std::ios::binary);
  if (!*stream) throw invalidInput(formats::printable(m_path.string()) + ": cannot be opened");
  return stream;
}

std::string InputFile::read(std::string_view role, std::uint64_t most) const {
  if (!m_bytes) return readWholeFile(m_path, role, most);
  requireAtMost(most, size(), m_path, role);
  return std::string((*m_bytes)[0]).append((*m_bytes)[1]);
}

}  // namespace lumen
