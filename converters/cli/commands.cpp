// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/commands.h"

#include "converters/base/options/option_name.h"
#ifdef LUMEN_WITH_VIEWER
#include "viewer/routes/html_page.h"
#include "viewer/server/command_view.h"
#endif

namespace lumen::cli {

engine::Engine allCommands() {
  engine::Engine commands = engine::makeEngine();
#ifdef LUMEN_WITH_VIEWER
  commands.add(viewer::makeViewCommand);
#endif
  commands.add(makeCompletionCommand);
  return commands;
}

void addViewerPage([[maybe_unused]] engine::RunSettings& settings) {
#ifdef LUMEN_WITH_VIEWER
  settings.viewerPage = viewer::pageOfCase;
#endif
}

const char* groupSummary(const std::string& word) {
#ifdef LUMEN_WITH_LIBRARY
  if (word == "library") return "Make, change, check, sign and publish libraries of cases";
#endif
  (void)word;
  return nullptr;
}

void CommonOptions::addRows(OptionTable& table) {
  table.add("threads", &threads, "N", "Threads to run on; 0: all cores").in(WholeRange{0, 1024});
  table.flag("quiet", quiet, "Print errors and the asked-for answer only");
  table.flag("verbose", verbose, "Also print details").without("quiet");
  table.flag("strict", strict, "Every warning is an error: exit with 3 and write nothing");
  table.flag(kOption.json.name, json, "Answer with one JSON object on standard output");
}

OptionRow configRow() {
  OptionRow row;
  row.name = "config";
  row.type = "FILE";
  row.help = "Options from a file of lines such as \"inlier-rate = 0.6\"; the command line wins";
  return row;
}

}  // namespace lumen::cli
