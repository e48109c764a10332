// SPDX-License-Identifier: Apache-2.0
// The elements of an XML text, by expat.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <expat.h>

#include "converters/base/error.h"

namespace lumen {

/// A reader of elements. Expat is C, so nothing may throw through it: begin() and end() report a
/// fault by refuse(), after which they are not called any more.
class XmlEvents {
public:
  XmlEvents(const XmlEvents&) = delete;
  XmlEvents& operator=(const XmlEvents&) = delete;
  virtual ~XmlEvents() = default;

protected:
  /// `name`, the file's in messages, is not copied.
  XmlEvents(std::string_view text, const std::string& name) : m_text(text), m_name(name) {}

  /// Attributes are pairs of name and value, with a null pointer behind them.
  virtual void begin(std::string_view tag, const char** attributes) = 0;
  virtual void end(std::string_view tag) = 0;

  /// Calls begin() and end() for all elements. Throws the fault, naming the file and the line, and
  /// Error(InvalidInput) for a text that has a document type or is no XML; `advice` ends this
  /// message.
  void run(const std::string& advice = "") {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> owner(
        XML_ParserCreate(nullptr), XML_ParserFree);
    if (!owner) throw failed(m_name + ": no memory to parse XML");
    m_parser = owner.get();
    XML_SetUserData(m_parser, this);
    XML_SetElementHandler(
        m_parser,
        [](void* self, const XML_Char* tag, const XML_Char** attributes) {
          auto& events = *static_cast<XmlEvents*>(self);
          if (!events.m_isStopped) events.begin(tag, attributes);
        },
        [](void* self, const XML_Char* tag) {
          auto& events = *static_cast<XmlEvents*>(self);
          if (!events.m_isStopped) events.end(tag);
        });
    XML_SetStartDoctypeDeclHandler(
        m_parser, [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          static_cast<XmlEvents*>(self)->refuse("has a document type; expected none");
        });
    constexpr std::size_t kFed = std::size_t{16} << 20;  // bytes; expat counts them in an int
    for (std::string_view rest = m_text; !m_isStopped; rest.remove_prefix(kFed)) {
      const bool isLast = rest.size() <= kFed;
      const int size = static_cast<int>(std::min(kFed, rest.size()));
      if (XML_Parse(m_parser, rest.data(), size, isLast) != XML_STATUS_OK && !m_isStopped)
        refuse(std::string("is no XML (") + XML_ErrorString(XML_GetErrorCode(m_parser)) + ")" +
               advice);
      if (isLast) break;
    }
    if (m_fault) throw *m_fault;
  }

  void refuse(const std::string& what, ErrorKind kind = ErrorKind::InvalidInput) {
    if (!m_fault) m_fault = Error(kind, m_name + ": line " + std::to_string(line()) + ": " + what);
    stop();
  }
  /// Ends the reading after the current tag; the rest need not be XML.
  void stop() {
    m_isStopped = true;
    XML_StopParser(m_parser, XML_FALSE);
  }

  /// The value of an attribute; empty if it is absent.
  static std::string_view attribute(const char** attributes, std::string_view name) {
    for (; *attributes != nullptr; attributes += 2)
      if (name == attributes[0]) return attributes[1];
    return {};
  }
  /// The current tag: its line, its first byte, and the byte behind it.
  [[nodiscard]] std::size_t line() const { return XML_GetCurrentLineNumber(m_parser); }
  [[nodiscard]] std::size_t tagBegin() const {
    return static_cast<std::size_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(m_parser)));
  }
  [[nodiscard]] std::size_t tagEnd() const {
    return tagBegin() + static_cast<std::size_t>(XML_GetCurrentByteCount(m_parser));
  }

  std::string_view m_text;
  const std::string& m_name;

private:
  XML_Parser m_parser = nullptr;
  std::optional<Error> m_fault;
  bool m_isStopped = false;
};

}  // namespace lumen
