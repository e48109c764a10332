// SPDX-License-Identifier: Apache-2.0
// A case as a library takes it: with a surface, pictures, exports, and the record of all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/engine/command.h"
#include "converters/library/index/change.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"

namespace lumen::engine {

/// Parts of a case to be made for a library, besides the case itself.
struct CaseWishes {
  std::string id;                    ///< empty: of the case's digest
  bool replace = false;              ///< a case of this id may be there
  bool surface = true;               ///< surface.glb
  std::vector<std::string> views;    ///< picture-VIEW.png each; thumbnail.png with any
  bool areViewsAsked = false;        ///< the user names views, and gets all of them
  int turntable = 0;                 ///< pictures around the case
  std::vector<std::string> targets;  ///< targets of lumen export
  bool report = false;               ///< report.html
  bool viewer = false;               ///< view.html: the viewer with the case, as one file
  std::vector<std::string> files;    ///< extra files, below files/
  std::string recipe;                ///< digest of the inputs, for `lumen library build`
};

/// The words that views may have.
const std::vector<std::string>& pictureViews();

/// The title of a case whose statements have none.
std::string defaultTitle(const convert::CaseAbout& about, const std::string& id);

/// Warns of statements that look like a person's.
void warnOfPersonsIn(const convert::CaseAbout& about, Progress& progress);

/// Adds the page of `lumen report`, under the title of the record. The page sees the case under its
/// id, as the name of a file may identify a patient.
void addReportPage(const std::filesystem::path& caseFile, convert::IncomingCase& incoming,
                   const RunContext& context);

/// Makes everything in `wishes` beside `library`. Everything that can be refused is refused before
/// long work: Error(InvalidInput) for a case that cannot be read, for a missing statement
/// (convert::missingStatement()) and for wishes that a case without models cannot fulfil;
/// Error(Usage) for an id that is there already; Error(Unsupported) for a target. Warns of texts
/// that look like a person's, and as exports and surfaces do. `about` gets a title if it has none.
convert::IncomingCase prepareCase(const std::filesystem::path& caseFile, convert::CaseAbout about,
                                  const CaseWishes& wishes, const std::filesystem::path& library,
                                  const RunContext& context);

// The version of a case that a new one replaces: its parts stay without being named again.

/// The id that a case gets without another wish: case- and the first 12 digits of its digest.
/// Throws as readCase().
std::string idOfCase(const std::filesystem::path& caseFile);

/// The record of the version that is in the library; nothing if it has no case of this id. Throws
/// as convert::openRecord().
std::optional<convert::CaseRecord> replacedVersion(const std::filesystem::path& library,
                                                   const std::string& id);

/// Adds to `wishes` the parts of the version before: its exports, pages, pictures and files.
/// `keepsViews`, `keepsTurntable`: no other number of them is asked for.
void keepWishes(const convert::CaseRecord& before, const std::filesystem::path& library,
                bool keepsViews, bool keepsTurntable, CaseWishes& wishes);

}  // namespace lumen::engine
