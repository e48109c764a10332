// SPDX-License-Identifier: Apache-2.0
// Comments are no part of a case, so they are looked for in the text itself.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/issue_text.h"
#include "formats/case/privacy.h"

namespace lumen::formats {
namespace {

using nlohmann::json;

// Receives the parse events of a text that is known to be legal, and scans what is inside of keys
// that start with "x-".
class CommentScanner {
public:
  CommentScanner(std::string root, IssueList& issues) : m_root(std::move(root)), m_issues(issues) {}

  bool null() { return next(); }
  bool boolean(bool) { return next(); }
  bool number_integer(std::int64_t) { return next(); }
  bool number_unsigned(std::uint64_t) { return next(); }
  bool number_float(double, const std::string&) { return next(); }
  bool binary(json::binary_t&) { return next(); }
  bool string(std::string& value) {
    if (inComment()) scanText(value, pointer(), m_issues);
    return next();
  }
  bool start_object(std::size_t) { return open(false); }
  bool start_array(std::size_t) { return open(true); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    Level& level = m_levels.back();
    level.token = jsonPointerToken(name);
    level.isComment = level.insideComment || name.starts_with("x-");
    if (level.isComment) scanText(name, pointer(), m_issues);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const json::exception&) { return false; }

private:
  struct Level {
    bool isArray, insideComment, isComment;
    std::size_t index = 0;
    std::string token{};
  };

  [[nodiscard]] bool inComment() const { return !m_levels.empty() && m_levels.back().isComment; }
  [[nodiscard]] std::string pointer() const {
    std::string text = m_root;
    for (const Level& level : m_levels)
      text += "/" + (level.isArray ? std::to_string(level.index) : level.token);
    return text;
  }
  bool open(bool isArray) {
    const bool comment = inComment();
    m_levels.push_back({isArray, comment, comment});
    return true;
  }
  bool close() {
    m_levels.pop_back();
    return next();
  }
  bool next() {
    if (!m_levels.empty()) ++m_levels.back().index;
    return true;
  }

  std::string m_root;
  IssueList& m_issues;
  std::vector<Level> m_levels;
};

}  // namespace

void scanComments(std::string_view text, const std::string& root, IssueList& issues) {
  CommentScanner scanner(root, issues);
  json::sax_parse(text.begin(), text.end(), &scanner);
}

}  // namespace lumen::formats
