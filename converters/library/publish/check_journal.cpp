// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/check_journal.h"

#include <cerrno>
#include <span>
#include <string_view>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/option_name.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

namespace {

constexpr std::string_view kJournalFormat = "lumen library check, ";
constexpr std::size_t kDigestDigits = 64;  // digits of a digest
constexpr std::size_t kMostJournalBytes = std::size_t{1}
                                          << 28;  // more than all cases that a library may have

void writeText(int descriptor, std::string_view text, const std::filesystem::path& file) {
  if (!formats::writeAll(std::as_bytes(std::span(text)), descriptor))
    throw failed(file.string() + ": cannot be written: " + formats::systemErrorText(errno));
}

}  // namespace

CheckJournal::CheckJournal(const std::filesystem::path& file, const std::string& libraryId)
    : m_file(file) {
  constexpr int kFlags = O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK;
  m_descriptor = formats::FileDescriptor(::open(file.c_str(), kFlags, 0666));
  if (!m_descriptor.isOpen())
    throw failed(file.string() + ": cannot be opened: " + formats::systemErrorText(errno));
  if (flock(m_descriptor.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw failed(file.string() +
                 ": another check is using this file; wait for it, or name another");
  read(readWholeFile(file, "file of cases that are whole", kMostJournalBytes),
       std::string(kJournalFormat) + "lumen " LUMEN_VERSION ", of " + libraryId + "\n");
}

/// A line for each case: the mark, a space, the id. The rest of a line that a killed check left is
/// cut off.
void CheckJournal::read(const std::string& text, const std::string& head) {
  if (!text.empty() && !text.starts_with(kJournalFormat))
    throw invalidInput(m_file.string() + ": found something else, expected a file that " +
                       kOption.resume.shown() + " made; it is left as it is");
  if (!text.starts_with(head)) {
    if (ftruncate(m_descriptor.get(), 0) != 0)
      throw failed(m_file.string() + ": cannot be written: " + formats::systemErrorText(errno));
    writeText(m_descriptor.get(), head, m_file);
    return;
  }
  std::size_t begin = head.size();
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (end - begin < kDigestDigits + 2 || text[begin + kDigestDigits] != ' ') continue;
    m_marks[text.substr(begin + kDigestDigits + 1, end - begin - kDigestDigits - 1)] =
        text.substr(begin, kDigestDigits);
  }
  if (begin < text.size() && ftruncate(m_descriptor.get(), static_cast<off_t>(begin)) != 0)
    throw failed(m_file.string() + ": cannot be written: " + formats::systemErrorText(errno));
}

bool CheckJournal::knows(const std::string& caseId, const std::string& mark) const {
  const auto found = m_marks.find(caseId);
  return found != m_marks.end() && found->second == mark;
}

void CheckJournal::add(const std::string& caseId, const std::string& mark) {
  writeText(m_descriptor.get(), mark + " " + caseId + "\n", m_file);
}

}  // namespace lumen::convert
