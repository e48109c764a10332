// SPDX-License-Identifier: Apache-2.0
// The list of `lumen library build`: a row for each case (docs/library.md).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace lumen::convert {

/// A case to be made.
struct BuildRow {
  std::size_t line = 0;              ///< the file's line where the row begins; the first is 1
  std::filesystem::path input;       ///< volume, mesh, centerline or case; or a folder of DICOM
  std::filesystem::path seeds;       ///< may be empty
  std::string id;                    ///< may be empty: made from the input's digest
  std::vector<std::string> targets;  ///< targets of lumen export
  std::map<std::string, std::string> options;  ///< options of lumen convert: "--crop" and its value
  std::string about;  ///< the user's statements: JSON, as `lumen library add --about` reads it
};

/// A row that cannot be made, and why: a fault that is seen before any work.
struct RowFault {
  std::size_t line = 0;
  std::string id;   ///< may be empty
  std::string why;  ///< one sentence, without the place
};

struct BuildList {
  std::vector<BuildRow> rows;
  std::vector<RowFault> faults;  ///< such rows are not among `rows`
};

/// Rows of comma-separated values (RFC 4180) in UTF-8, below a row of names: input (or volume),
/// seeds, id, targets, codes (both with semicolons between), title, description, anatomy,
/// laterality, modality, synthetic, licence, attribution, doi, origin, consent, deidentification,
/// and any "--NAME" of lumen convert. Files are relative to `file`'s folder; rows without a text
/// are passed over. Faults of a row are a missing input or file, an id that is none or that a row
/// before has, a cell too many, a statement that is none. Throws Error(InvalidInput) for a list
/// without rows, and for a name that no column has. `lines`: where it is not empty, only the rows that
/// begin on these lines are read; a line on which none begins is a fault.
BuildList readBuildList(const std::string& text, const std::filesystem::path& file,
                        const std::set<std::size_t>& lines = {});

/// Throws Error(InvalidInput) that names the list and all faults, if there are any.
void requireNoFaults(std::vector<RowFault> faults, const std::filesystem::path& file);

}  // namespace lumen::convert
