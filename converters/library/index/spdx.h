// SPDX-License-Identifier: Apache-2.0
// Licences by SPDX expressions (annex D of SPDX 2.3).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

/// The identifiers of SPDX's list of licences and of exceptions (https://spdx.org/licenses,
/// CC0-1.0), deprecated ones included, as the npm packages spdx-license-ids and spdx-exceptions
/// have them; sorted by bytes.
const std::vector<std::string_view>& spdxLicences();
const std::vector<std::string_view>& spdxExceptions();

/// Reason why `expression` is not an SPDX licence expression, in one sentence; empty if it is one.
/// Identifiers must be on SPDX's list, in its spelling, or begin with LicenseRef-.
std::string licenceFault(const std::string& expression);

/// Whether it is one identifier on SPDX's list, which has a page of its own below
/// https://spdx.org/licenses/.
bool isListedLicence(std::string_view identifier);

}  // namespace lumen::convert
