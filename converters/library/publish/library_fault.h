// SPDX-License-Identifier: Apache-2.0
// Faults of a library: the table of spec/library.md, Faults.
#pragma once

#include <cstdint>
#include <string>

#include "formats/container/fault_list.h"

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

/// A warning does not make a library faulty.
formats::Severity severityOf(FaultCode code);

struct LibraryFault {
  FaultCode code = FaultCode::LibraryFile;
  std::string caseId;  ///< empty for a fault of the library itself
  std::string path;    ///< relative to the library, in the bytes of the file system
  std::string found;   ///< the whole message where `expected` is empty
  std::string expected;

  /// "FILE_ALTERED (722): found ..., expected ...", one printable line.
  [[nodiscard]] std::string text() const;
};

using FaultList = formats::FaultList<LibraryFault>;

}  // namespace lumen::convert
