// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/spdx.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

TEST(Spdx, ExpressionsAreAccepted) {
  for (const char* text :
       {"MIT", "CC-BY-4.0", "GPL-2.0-only", "GPL-2.0+", "Apache-2.0+", "MIT OR Apache-2.0", "(MIT)",
        "((MIT AND BSD-2-Clause) OR ISC)", "GPL-2.0-only WITH Classpath-exception-2.0",
        "MIT AND (LGPL-2.1-or-later OR BSD-3-Clause)", "LicenseRef-hospital.1",
        "DocumentRef-a:LicenseRef-b"})
    EXPECT_EQ(licenceFault(text), "") << text;
}

TEST(Spdx, WhatIsNoExpressionIsRefusedWithAReason) {
  const struct {
    const char* text;
    const char* reason;
  } faults[] = {{"", "expected a licence"},
                {"cc-by-4.0", "did you mean CC-BY-4.0?"},
                {"CC-BY", "did you mean CC-BY-4.0?"},
                {"apache", "did you mean Apache-2.0?"},
                {"CC BY 4.0", "is no identifier"},
                {"free to use", "LicenseRef-"},
                {"MIT Apache-2.0", "expected AND or OR before \"Apache-2.0\""},
                {"MIT OR", "expected a licence"},
                {"MIT or ISC", "expected AND or OR"},
                {"(MIT", "not closed"},
                {"MIT)", "expected AND or OR before \")\""},
                {"()", "is no identifier"},
                {"MIT WITH", "exception"},
                {"MIT WITH ISC", "exception"},
                {"LicenseRef-", "is no identifier"},
                {"LicenseRef-a_b", "is no identifier"},
                {"MIT++", "is no identifier"},
                {"<b>", "is no identifier"}};
  for (const auto& fault : faults)
    EXPECT_NE(licenceFault(fault.text).find(fault.reason), std::string::npos)
        << fault.text << ": " << licenceFault(fault.text);
  EXPECT_NE(licenceFault(std::string(256, '(')), "");
}

TEST(Spdx, ListsAreSorted) {
  EXPECT_TRUE(std::is_sorted(spdxLicences().begin(), spdxLicences().end()));
  EXPECT_TRUE(std::is_sorted(spdxExceptions().begin(), spdxExceptions().end()));
}

}  // namespace
}  // namespace lumen::convert
