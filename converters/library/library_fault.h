// SPDX-License-Identifier: Apache-2.0
// What can be wrong with a library: the table of spec/library.md, Faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lumen::convert {

/// Names and numbers are stable and never used again for another fault.
enum class FaultCode : std::uint16_t {
  LibraryFile = 701,
  LibraryIdTwice = 702,
  LibraryOrder = 703,
  LibraryLicence = 704,
  LibraryConsent = 705,
  RecordFile = 711,
  RecordDigest = 712,
  RecordCase = 713,
  FileMissing = 721,
  FileAltered = 722,
  FileUnlisted = 723,
  FilePath = 724,
  FileKind = 725,
  FileUnreadable = 726,
  CaseInvalid = 731,
  CaseFigures = 732,
  Privacy = 741,
  Bag = 751,
  Crate = 752,
  SignatureMissing = 761,
  SignatureKey = 762,
  SignatureBroken = 763,
  RevisionOlder = 764,
  RevisionOther = 765,
};

/// The stable name, such as FILE_ALTERED.
const char* faultName(FaultCode code);

/// It does not make a library faulty.
bool isWarning(FaultCode code);

struct LibraryFault {
  FaultCode code = FaultCode::LibraryFile;
  std::string caseId;  ///< nothing for what is no case's
  std::string path;    ///< relative to the library, as it is there: perhaps no UTF-8
  std::string found;   ///< without `expected`, a message that says all
  std::string expected;

  /// "FILE_ALTERED (722): found ..., expected ...", one printable line.
  [[nodiscard]] std::string text() const;
};

/// Faults in order: all are counted, and so many kept.
class FaultList {
public:
  explicit FaultList(std::size_t most) : m_most(most) {}

  void add(LibraryFault fault);
  /// `more` comes after what is here.
  void append(FaultList&& more);
  [[nodiscard]] const std::vector<LibraryFault>& kept() const { return m_kept; }
  [[nodiscard]] std::size_t most() const { return m_most; }
  [[nodiscard]] std::size_t errors() const { return m_errors; }
  [[nodiscard]] std::size_t warnings() const { return m_warnings; }
  [[nodiscard]] bool empty() const { return m_errors + m_warnings == 0; }

private:
  std::size_t m_most;
  std::size_t m_errors = 0, m_warnings = 0;
  std::vector<LibraryFault> m_kept;
};

}  // namespace lumen::convert
