// SPDX-License-Identifier: Apache-2.0
#include "converters/io/content/input_file.h"

#include <fstream>
#include <streambuf>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

/// Bytes that are not copied.
class MemoryBuffer : public std::streambuf {
public:
  explicit MemoryBuffer(std::string_view bytes) {
    char* begin = const_cast<char*>(bytes.data());  // the buffer is for reading alone
    setg(begin, begin, begin + bytes.size());
  }

private:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type size = egptr() - eback();
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::cur ? gptr() - eback()
                                                       : size;
    if (base + offset < 0 || base + offset > size) return {off_type(-1)};
    setg(eback(), eback() + base + offset, egptr());
    return {base + offset};
  }
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override {
    return seekoff(off_type(place), std::ios_base::beg, which);
  }
};

class MemoryStream : public std::istream {
public:
  explicit MemoryStream(std::string_view bytes) : std::istream(nullptr), m_buffer(bytes) {
    rdbuf(&m_buffer);
  }

private:
  MemoryBuffer m_buffer;
};

}  // namespace

std::uint64_t InputFile::size() const {
  if (m_bytes) return m_bytes->size();
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
  requireAtMost(most, m_bytes->size(), m_path, role);
  return std::string(*m_bytes);
}

}  // namespace lumen::convert
