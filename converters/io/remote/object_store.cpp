// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/object_store.h"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/run_program.h"
#include "converters/base/text.h"
#include "converters/io/remote/http_answer.h"
#include "converters/io/remote/http_request.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

constexpr unsigned kLongestCopy = 7 * 24 * 3600;  // s
constexpr const char* kEnv = "/usr/bin/env";      // runs rclone without a variable

/// BUCKET and KEY.
std::pair<std::string, std::string> partsOf(const RemoteAddress& address) {
  const std::string rest = address.text.substr(std::string("s3://").size());
  const std::size_t slash = rest.find('/');
  return {rest.substr(0, slash), rest.substr(slash + 1)};
}

/// The object for rclone, by the credentials that aws takes, too.
std::string pathForRclone(const RemoteAddress& address) {
  const auto [bucket, key] = partsOf(address);
  return ":s3,env_auth=true:" + bucket + "/" + key;
}

ProgramCall callOf(const fs::path& program, std::vector<std::string> arguments,
                   const fs::path& output, std::uint64_t mostBytes) {
  ProgramCall call;
  call.program = program;
  call.arguments = std::move(arguments);
  call.folder = output.parent_path();
  call.seconds = kLongestCopy;
  call.mostFileBytes = mostBytes;
  return call;
}

/// A call of rclone, whose client of S3 refuses certificates that AWS_CA_BUNDLE states: it gets them
/// as an option.
ProgramCall callOfRclone(const fs::path& rclone, const std::vector<std::string>& words,
                         const fs::path& output, std::uint64_t mostBytes) {
  constexpr const char* kBundle = "AWS_CA_BUNDLE";
  std::vector<std::string> arguments = {"-u", kBundle, rclone.string()};
  if (const char* file = std::getenv(kBundle); file != nullptr && *file != '\0')
    arguments.insert(arguments.end(), {"--ca-cert", file});
  arguments.insert(arguments.end(), words.begin(), words.end());
  return callOf(kEnv, std::move(arguments), output, mostBytes);
}

std::string lastLine(const std::string& text) {
  const std::string all = trimmed(text);
  return formats::printable(all.substr(all.rfind('\n') + 1));
}

void runStore(const ProgramCall& call, const RemoteAddress& address, const Progress& progress) {
  const ProgramResult result = runProgram(call, progress);
  if (result.end == ProgramEnd::Done) return;
  const std::string name = call.program == kEnv ? "rclone" : call.program.filename().string();
  const std::string why =
      result.end == ProgramEnd::Refused ? lastLine(result.errors) : "it crashed";
  throw remoteError(ErrorKind::Failed, address, name + " cannot fetch it: " + why);
}

Error noProgram(const RemoteAddress& address) {
  return remoteError(ErrorKind::Unsupported, address,
                     "lumen fetches from object stores by rclone or aws, neither of which is "
                     "installed");
}

RemoteHead headByRclone(const fs::path& rclone, const RemoteAddress& address, std::uint64_t count,
                        const fs::path& output, const RemoteOptions& options,
                        const Progress& progress) {
  const fs::path facts = output.string() + ".facts";
  ProgramCall call =
      callOfRclone(rclone, {"lsjson", "--stat", pathForRclone(address)}, output, options.mostBytes);
  call.output = facts;
  runStore(call, address, progress);
  JsonFile json(readWholeFile(facts, "answer of rclone", kMostText), facts);
  RemoteHead head;
  head.whole = static_cast<std::uint64_t>(JsonPlace(json).at("Size").number());
  call = callOfRclone(rclone, {"cat", "--count", std::to_string(count), pathForRclone(address)},
                      output, options.mostBytes);
  call.output = output;
  runStore(call, address, progress);
  head.bytes = readWholeFile(output, "part of an object", count);
  return head;
}

RemoteHead headByAws(const fs::path& aws, const RemoteAddress& address, std::uint64_t count,
                     const fs::path& output, const RemoteOptions& options,
                     const Progress& progress) {
  const auto [bucket, key] = partsOf(address);
  const fs::path facts = output.string() + ".facts";
  ProgramCall call =
      callOf(aws,
             {"s3api", "get-object", "--output", "json", "--bucket", bucket, "--key", key,
              "--range", "bytes=0-" + std::to_string(count - 1), output.string()},
             output, options.mostBytes);
  call.output = facts;
  runStore(call, address, progress);
  JsonFile json(readWholeFile(facts, "answer of aws", kMostText), facts);
  const std::string range =
      "HTTP/ 206\ncontent-range: " + JsonPlace(json).at("ContentRange").text() + "\n";
  RemoteHead head;
  head.bytes = readWholeFile(output, "part of an object", count);
  const auto stated = parseHttpAnswer(range).range;
  if (!stated || !stated->whole || stated->first != 0 || stated->last + 1 != head.bytes.size())
    throw remoteError(
        ErrorKind::Failed, address,
        "the store sends another range than the first " + std::to_string(count) + " bytes");
  head.whole = *stated->whole;
  return head;
}

}  // namespace

void fetchObject(const RemoteAddress& address, const fs::path& output, const RemoteOptions& options,
                 const Progress& progress) {
  if (const auto rclone = installedProgram("rclone")) {
    runStore(callOfRclone(*rclone, {"copyto", pathForRclone(address), output.string()}, output,
                          options.mostBytes),
             address, progress);
    // rclone copies what is not there as a folder without files
    if (!fs::exists(output))
      throw remoteError(ErrorKind::Failed, address, "there is no such object");
    return;
  }
  if (const auto aws = installedProgram("aws"))
    return runStore(callOf(*aws, {"s3", "cp", "--only-show-errors", address.text, output.string()},
                           output, options.mostBytes),
                    address, progress);
  throw noProgram(address);
}

RemoteHead fetchObjectHead(const RemoteAddress& address, std::uint64_t count,
                           const fs::path& output, const RemoteOptions& options,
                           const Progress& progress) {
  if (const auto rclone = installedProgram("rclone"))
    return headByRclone(*rclone, address, count, output, options, progress);
  if (const auto aws = installedProgram("aws"))
    return headByAws(*aws, address, count, output, options, progress);
  throw noProgram(address);
}

}  // namespace lumen::convert
