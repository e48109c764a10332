// SPDX-License-Identifier: Apache-2.0
// All that is wrong with a record by itself, beside its line of library.json, and beside its case.
#pragma once

#include <optional>
#include <string>

#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"
#include "converters/library/publish/library_fault.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The record in `text`, without the files whose paths none may have; nothing if it breaks its
/// format otherwise. `path` is the record's, for the faults.
std::optional<CaseRecord> readRecordFaults(const std::string& text, const std::string& caseId,
                                           const std::string& path, FaultList& faults);

/// Adds faults for values that differ from the line of library.json, for a missing licence, consent
/// or de-identification, and for texts that look like a person's.
void checkRecord(const CaseRecord& record, const LibraryEntry& entry, const std::string& path,
                 FaultList& faults);

/// Adds faults for bounds, figures, insertions and ends that are not those of the case, to a
/// thousandth of a millimetre, which is finer than anything in a volume and coarser than rounding.
/// `path` is the record's.
void checkFigures(const formats::Case& value, const CaseRecord& record, const std::string& path,
                  FaultList& faults);

/// A licence that is missing or none.
void checkLicence(const std::string& licence, const std::string& caseId, const std::string& path,
                  FaultList& faults);

/// Adds a fault for a text that looks like a person's; `pointer` is its place in the file.
void checkPrivacy(const std::string& text, const std::string& pointer, const std::string& caseId,
                  const std::string& path, FaultList& faults);

}  // namespace lumen::convert
