// SPDX-License-Identifier: Apache-2.0
// The user's browser.
#pragma once

#include <string>

namespace lumen::viewer {

/// Opens an address in the default browser, which goes on by itself. False if there is none.
bool openBrowser(const std::string& address);

}  // namespace lumen::viewer
