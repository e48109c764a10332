// SPDX-License-Identifier: Apache-2.0
// Many runs of lumen in one process, for tests in other languages (batch.py). Each line of standard
// input is a run, {"arguments": [...], "folder": "...", "merged": false}; its answer is the line
// {"code": 0, "out": "...", "err": "..."} of standard output. With arguments it is lumen itself, as
// which commands start it that work in processes of their own.
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/cli/command_line.h"
#include "tests/cli/run_here.h"

int main(int argc, char** argv) {
  if (argc > 1) return lumen::cli::runCommandLine(argc, argv);
  using Json = nlohmann::json;
  for (std::string line; std::getline(std::cin, line);) {
    const Json asked = Json::parse(line);
    const lumen::test::Outcome done =
        lumen::test::runHere(asked.at("arguments").get<std::vector<std::string>>(),
                             asked.at("folder").get<std::string>(), asked.at("merged").get<bool>());
    const Json answer = {{"code", done.code}, {"out", done.out}, {"err", done.err}};
    std::cout << answer.dump(-1, ' ', true, Json::error_handler_t::replace) << std::endl;
  }
}
