// SPDX-License-Identifier: Apache-2.0
// The list of `lumen library build`: a row for each case (docs/library.md).
#pragma once

#include <filesystem>
#include <map>
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

/// Rows of comma-separated values (RFC 4180) in UTF-8, below a row of names: input (or volume),
/// seeds, id, targets, codes (both with semicolons between), title, description, anatomy,
/// laterality, modality, synthetic, licence, attribution, doi, origin, consent, deidentification,
/// and any "--NAME" of lumen convert. Files are relative to `file`'s folder; rows without a text
/// are passed over. Throws Error(InvalidInput) that names all rows with a fault that can be seen
/// before any work: a name that no column has, a missing input or file, an id that is none or that
/// two rows have, a column too many.
std::vector<BuildRow> readBuildList(const std::string& text, const std::filesystem::path& file);

}  // namespace lumen::convert
