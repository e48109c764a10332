// SPDX-License-Identifier: Apache-2.0
// Licences by SPDX expressions (annex D of SPDX 2.3).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

/// The identifiers of SPDX's list of licences (https://spdx.org/licenses, CC0-1.0) that data and
/// common software have, deprecated ones included; sorted by bytes.
const std::vector<std::string_view>& spdxLicences();

/// Reason why `expression` is not an SPDX licence expression, in one sentence; empty if it is one.
/// Licences must be among spdxLicences(), in this spelling, or begin with LicenseRef-. An exception
/// may have any name but that of a licence.
std::string licenceFault(const std::string& expression);

/// Whether it is one of spdxLicences(), which have pages of their own below
/// https://spdx.org/licenses/.
bool isListedLicence(std::string_view identifier);

}  // namespace lumen::convert
