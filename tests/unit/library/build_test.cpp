// SPDX-License-Identifier: Apache-2.0
// Making the rows of a list by several threads.
#include "converters/library/rows/build.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "converters/base/error.h"
#include "converters/library/index/change.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {
namespace {

/// Builds by eight threads, of which the system grants two: those of another user do not count.
[[noreturn]] void buildWithTooFewThreads(const TemporaryFolder& files) {
  constexpr uid_t kNobodyElse = 54321;
  constexpr rlimit kThree{3, 3};
  (void)!::setuid(kNobodyElse);  // refused without privileges: then this user has processes enough
  ::setrlimit(RLIMIT_NPROC, &kThree);
  BuildRow row;
  row.line = 2;
  row.input = files.path("a.nrrd");
  BuildOptions options;
  options.run = [](const auto&...) { return OperationEnd(); };
  options.work = files.path("work");
  options.jobs = 8;
  Progress progress;
  try {
    buildLibrary({row}, files.path("lib"), options, progress);
  } catch (const Error& error) {
    std::fputs(error.what(), stderr);
    ::_exit(static_cast<int>(error.kind()));
  }
  ::_exit(0);
}

TEST(Build, AThreadThatCannotBeStartedIsAnErrorWithAMessage) {
  const TemporaryFolder files;
  std::filesystem::permissions(files.path(), std::filesystem::perms::all);
  files.write("a.nrrd", "voxels");
  makeLibrary(files.path("lib"), madeLibrary());
  EXPECT_EXIT(buildWithTooFewThreads(files),
              testing::ExitedWithCode(static_cast<int>(ErrorKind::Failed)),
              "a thread for a row cannot be started");
}

}  // namespace
}  // namespace lumen::convert
