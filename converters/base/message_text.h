// SPDX-License-Identifier: Apache-2.0
// The last step of a message before a person reads it.
#pragma once

#include <string>
#include <string_view>

namespace lumen {

/// `message` fit for a terminal: each of its lines is printable and has no addresses of objects,
/// which libraries put into theirs ("NrrdImageIO(0x55d0c0ffee00): ") and which differ from run to
/// run.
std::string messageText(std::string_view message);

}  // namespace lumen
