// SPDX-License-Identifier: Apache-2.0
// Parts that `lumen library build` and `lumen library sample` share: options, the run, the table at
// its end.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "converters/engine/command.h"
#include "converters/library/rows/build.h"
#include "converters/library/rows/build_list.h"

namespace lumen::engine {

struct BuildArguments {
  int jobs = 1;
  std::string work;                   ///< empty: LIBRARY.build
  std::string profile;                ///< of lumen check; empty: cases are not checked
  std::vector<std::string> accepted;  ///< ids that need no further person
  bool keepGoing = false;             ///< rows with a fault do not stop the others
  convert::BuildPhase phase = convert::BuildPhase::All;
  bool isResumed = false;  ///< cases that the library has by their ids stay
};

void addBuildRows(OptionTable& table, BuildArguments& arguments);

/// "rows": numbers of lines, as linesIn() reads them.
OptionRow& addLinesRow(OptionTable& table, std::string& lines, const std::string& list);

/// "2,5,9" as numbers; none for another text.
std::set<std::size_t> linesIn(const std::string& text);

/// Throws Error(InvalidInput) as convert::readBuildList(), and for a file that cannot be read.
convert::BuildList loadBuildList(const std::string& file, const std::set<std::size_t>& lines = {});

convert::BuildOptions buildOptions(const std::string& library, const BuildArguments& arguments,
                                   const RunContext& context);

/// Makes the rows and answers with a table of the rows that failed and why. Throws
/// Error(InvalidInput) for rows that cannot succeed, as far as that is seen before any work, unless
/// the arguments keep it going: then these rows have failed. Returns the exit code: 0 if every row
/// is in the library, 3 if the inputs alone are to blame for those that are not, else 1.
Answer buildLibrary(convert::BuildList rows, const std::string& list, const std::string& library,
                    const BuildArguments& arguments, const RunContext& context);

}  // namespace lumen::engine
