// SPDX-License-Identifier: Apache-2.0
// Licences by SPDX expressions (annex D of SPDX 2.3).
#pragma once

#include <string>
#include <string_view>

namespace lumen::convert {

/// Why `expression` is not an SPDX licence expression, in one sentence; empty if it is one. Identifiers must be on
/// SPDX's list, in its spelling, or begin with LicenseRef-.
std::string licenceFault(const std::string& expression);

/// Whether it is one identifier on SPDX's list, which has a page of its own below https://spdx.org/licenses/.
bool isListedLicence(std::string_view identifier);

}  // namespace lumen::convert
