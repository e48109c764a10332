// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_elements.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWindow = 1 << 14;
constexpr std::size_t kMaxDepth = 16;  // maximum nesting of sequences; images have up to six
constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr DicomTag kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd;

/// Sequences that are parsed although an implicit syntax does not mark them as sequences:
/// functional groups of frames, and their content.
constexpr std::array kSequences = {
    // frames: their place, measures and values, content, type, echo, diffusion, heartbeat
    0x52009229U, 0x52009230U, 0x00209113U, 0x00209116U, 0x00289110U, 0x00289145U, 0x00209111U,
    0x00189329U, 0x00189226U, 0x00189504U, 0x00189114U, 0x00189117U, 0x00189118U,
    // segments, their codes, and surfaces
    0x00620002U, 0x00620003U, 0x0062000aU, 0x0062000fU, 0x00082218U, 0x00660002U, 0x0066002bU,
    0x00660011U, 0x00660013U, 0x00660026U, 0x00660027U, 0x00660034U,
    // structures and their contours
    0x30060010U, 0x30060012U, 0x30060014U, 0x30060020U, 0x30060039U, 0x30060040U, 0x30060080U,
    0x30060086U};

[[noreturn]] void refuse(std::uint64_t at, const std::string& what) {
  throw invalidInput("damaged at byte " + std::to_string(at) + ": " + what);
}

/// Value representations whose length is four bytes after two that are reserved.
bool hasLongLength(const std::array<char, 2>& vr) {
  constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";
  return kLong.find(std::string(vr.data(), 2) + ' ') != std::string_view::npos;
}

class Walker {
public:
  Walker(DicomBytes& bytes, DicomSyntax syntax, const DicomVisitor& visit)
      : m_bytes(bytes), m_syntax(syntax), m_visit(visit) {}

  /// Elements from `at` to `end`, or to the end of an item if that is unknown (`open`), or to the
  /// first of another group than `onlyGroup`. Returns the offset after them.
  std::uint64_t walk(std::uint64_t at, std::uint64_t end, bool open, int onlyGroup = -1) {
    while (at < end) {
      if (m_hasPixels && m_place.path.empty() && isPadding(at)) return end;
      if (onlyGroup >= 0 && end - at >= 2 && number<std::uint16_t>(at) != onlyGroup) return at;
      const Head head = readHead(at, end);
      if (open && head.tag == kItemEnd) {
        if (head.length != 0) refuse(at, "the end of an item has a length");
        return head.value;
      }
      at = walkElement(head, end);
    }
    if (open) refuse(at, "an item has no end");
    return at;
  }

private:
  struct Head {
    DicomTag tag = 0;
    std::array<char, 2> vr{'?', '?'};
    std::uint32_t length = 0;
    std::uint64_t at = 0, value = 0;
  };

  template <class T>
  T number(std::uint64_t at) {
    std::array<std::byte, sizeof(T)> raw{};
    m_bytes.read(at, raw);
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const std::size_t byte = m_syntax.bigEndian ? i : sizeof(T) - 1 - i;
      value = static_cast<T>(static_cast<std::uint64_t>(value) << 8U |
                             std::to_integer<std::uint64_t>(raw[byte]));
    }
    return value;
  }

  void require(std::uint64_t at, std::uint64_t count, std::uint64_t end, const char* what) {
    if (end - at >= count) return;
    const std::string text = std::string(what) + " has " + std::to_string(count) +
                             " bytes, of which " + std::to_string(end - at) + " are ";
    if (end == m_bytes.size()) throw invalidInput("truncated: " + text + "there");
    refuse(at, text + "in the sequence around it");
  }

  Head readHead(std::uint64_t at, std::uint64_t end) {
    require(at, 8, end, "a data element's head");
    Head head{.at = at, .value = at + 8};
    head.tag =
        static_cast<DicomTag>(number<std::uint16_t>(at)) << 16U | number<std::uint16_t>(at + 2);
    if (!m_syntax.explicitVr || head.tag >> 16U == 0xfffe) {
      head.length = number<std::uint32_t>(at + 4);
      return head;
    }
    m_bytes.read(at + 4, std::as_writable_bytes(std::span(head.vr)));
    if (!isRepresentation(head.vr))
      refuse(at, tagText(head.tag) + " has no value representation that DICOM knows");
    if (!hasLongLength(head.vr)) {
      head.length = number<std::uint16_t>(at + 6);
      return head;
    }
    require(at, 12, end, "a data element's head");
    head.length = number<std::uint32_t>(at + 8);
    head.value = at + 12;
    return head;
  }

  /// True if only zeros follow up to the end of the file, which some writers leave after the
  /// pixels.
  bool isPadding(std::uint64_t at) {
    std::vector<std::byte> rest(std::min<std::uint64_t>(kWindow, m_bytes.size() - at));
    for (; at < m_bytes.size(); at += rest.size()) {
      rest.resize(std::min<std::uint64_t>(rest.size(), m_bytes.size() - at));
      m_bytes.read(at, rest);
      if (std::any_of(rest.begin(), rest.end(), [](std::byte b) { return b != std::byte{0}; }))
        return false;
    }
    return true;
  }

  std::uint64_t walkElement(const Head& head, std::uint64_t end) {
    if (head.tag >> 16U == 0xfffe) refuse(head.at, tagText(head.tag) + " outside of a sequence");
    m_hasPixels = m_hasPixels || (head.tag == kPixelData && m_place.path.empty());
    DicomElement element;
    element.tag = head.tag;
    element.vr = head.vr;
    element.value = {head.value, head.length};
    if (head.tag == kPixelData && head.length == kUndefined) {
      element.encapsulated = true;
      element.value.length = 0;
      const std::uint64_t next = walkFragments(head.value, end, element);
      m_visit(element, m_place);
      return next;
    }
    if (head.length != kUndefined) require(head.value, head.length, end, "a value");
    if (isSequence(head)) return walkSequence(head, end);
    if (head.length == kUndefined) refuse(head.at, tagText(head.tag) + " has no length");
    m_visit(element, m_place);
    return head.value + head.length;
  }

  bool isSequence(const Head& head) const {
    if (head.vr == std::array{'S', 'Q'}) return true;
    const bool unknown = !m_syntax.explicitVr || head.vr == std::array{'U', 'N'};
    if (unknown && head.length == kUndefined) return true;
    return !m_syntax.explicitVr &&
           std::find(kSequences.begin(), kSequences.end(), head.tag) != kSequences.end();
  }

  std::uint64_t walkSequence(const Head& head, std::uint64_t end) {
    if (m_place.path.size() == kMaxDepth)
      refuse(head.at, "more than " + std::to_string(kMaxDepth) + " sequences within one another");
    const DicomSyntax outer = m_syntax;
    // a sequence of unknown representation is written implicitly (PS3.5, 6.2.2)
    if (head.vr == std::array{'U', 'N'}) m_syntax = {.explicitVr = false, .bigEndian = false};
    const bool open = head.length == kUndefined;
    const std::uint64_t stop = open ? end : head.value + head.length;
    m_place.path.push_back(head.tag);
    m_place.items.push_back(0);
    const std::uint64_t next = walkItems(head.value, stop, open);
    m_place.path.pop_back();
    m_place.items.pop_back();
    m_syntax = outer;
    return next;
  }

  std::uint64_t walkItems(std::uint64_t at, std::uint64_t end, bool open) {
    for (std::size_t count = 0; at < end; ++count) {
      const Head item = readHead(at, end);
      if (open && item.tag == kSequenceEnd) {
        if (item.length != 0) refuse(at, "the end of a sequence has a length");
        return item.value;
      }
      if (item.tag != kItem) refuse(at, tagText(item.tag) + " where an item of a sequence begins");
      m_place.items.back() = count;
      const bool openItem = item.length == kUndefined;
      if (!openItem) require(item.value, item.length, end, "an item");
      at = walk(item.value, openItem ? end : item.value + item.length, openItem);
    }
    if (open) refuse(at, "a sequence has no end");
    return at;
  }

  std::uint64_t walkFragments(std::uint64_t at, std::uint64_t end, DicomElement& element) {
    for (bool first = true; at < end; first = false) {
      const Head head = readHead(at, end);
      if (head.tag == kSequenceEnd && head.length == 0 && !first) return head.value;
      if (head.tag != kItem || head.length == kUndefined)
        refuse(at, tagText(head.tag) + " where a fragment of compressed pixels begins");
      require(head.value, head.length, end, "a fragment of compressed pixels");
      if (first)
        element.offsets = {head.value, head.length};
      else
        element.fragments.push_back({head.value, head.length});
      at = head.value + head.length;
    }
    refuse(at, "compressed pixels have no end");
  }

  DicomBytes& m_bytes;
  DicomSyntax m_syntax;
  const DicomVisitor& m_visit;
  DicomPlace m_place;
  bool m_hasPixels = false;
};

}  // namespace

DicomBytes::DicomBytes(const InputFile& file) {
  try {
    m_file = file.open();
    m_size = file.size();
  } catch (const Error&) {
    throw invalidInput("cannot be opened");
  }
}

void DicomBytes::read(std::uint64_t at, std::span<std::byte> to) {
  if (at > m_size || m_size - at < to.size()) refuse(at, "the file ends");
  if (m_file && to.size() > kWindow) return readAt(at, to);
  const bool inside = at >= m_windowAt && at - m_windowAt <= m_window.size() &&
                      m_window.size() - (at - m_windowAt) >= to.size();
  if (!inside) {
    m_windowAt = at;
    m_window.resize(std::min<std::uint64_t>(kWindow, m_size - at));
    readAt(at, m_window);
  }
  std::copy_n(m_window.begin() + static_cast<std::ptrdiff_t>(at - m_windowAt), to.size(),
              to.begin());
}

void DicomBytes::inflateFrom(std::uint64_t at) {
  constexpr std::size_t kStep = std::size_t{1} << 20;
  constexpr std::uint64_t kMost = std::uint64_t{4} << 30;
  std::vector<std::byte> packed(m_size - at), out(at);
  if (at > 0) readAt(0, out);
  if (!packed.empty()) readAt(at, packed);
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw invalidInput("cannot be unpacked");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  int state = Z_OK;
  for (std::size_t read = 0; state == Z_OK && out.size() < kMost;) {
    if (stream.avail_in == 0) {
      stream.avail_in = static_cast<uInt>(std::min(kStep, packed.size() - read));
      stream.next_in = reinterpret_cast<Bytef*>(packed.data() + read);
      read += stream.avail_in;
    }
    const std::size_t before = out.size();
    out.resize(before + kStep);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = static_cast<uInt>(kStep);
    state = inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
  }
  if (state != Z_STREAM_END)
    refuse(at, "its deflated data set (1.2.840.10008.1.2.1.99) cannot be unpacked");
  m_file.reset();
  m_size = out.size();
  m_windowAt = 0;
  m_window = std::move(out);
}

void DicomBytes::readAt(std::uint64_t at, std::span<std::byte> to) {
  m_file->clear();
  m_file->seekg(static_cast<std::streamoff>(at));
  m_file->read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
  if (static_cast<std::size_t>(m_file->gcount()) == to.size()) return;
  m_window.clear();
  refuse(at, "it cannot be read");
}

std::uint64_t walkDicomMeta(DicomBytes& bytes, std::uint64_t at, const DicomVisitor& visit) {
  constexpr int kMetaGroup = 2;
  return Walker(bytes, {}, visit).walk(at, bytes.size(), false, kMetaGroup);
}

void walkDicom(DicomBytes& bytes, std::uint64_t at, DicomSyntax syntax, const DicomVisitor& visit) {
  Walker(bytes, syntax, visit).walk(at, bytes.size(), false);
}

bool isRepresentation(const std::array<char, 2>& vr) {
  constexpr std::string_view kAll =
      "AE AS AT CS DA DS DT FD FL IS LO LT OB OD OF OL OV OW PN SH SL SQ SS ST SV TM UC UI UL UN "
      "UR US UT UV ";
  return kAll.find(std::string(vr.data(), 2) + ' ') != std::string_view::npos;
}

std::string tagText(DicomTag tag) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "(%04x,%04x)", tag >> 16U, tag & 0xffffU);
  return text.data();
}

std::string trimmedText(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first);
}

std::vector<double> parseNumbers(const std::string& text) {
  std::vector<double> values;
  std::size_t begin = 0;
  for (bool more = true; more;) {
    const std::size_t end = text.find('\\', begin);
    more = end != std::string::npos;
    const auto value = parsedNumber(trimmedText(text.substr(begin, more ? end - begin : end)));
    begin = end + 1;
    if (!value || !std::isfinite(*value)) return {};
    values.push_back(*value);
  }
  return values;
}

}  // namespace lumen::convert
