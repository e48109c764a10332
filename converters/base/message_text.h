// SPDX-License-Identifier: Apache-2.0
// Final clean-up of a message for a person.
#pragma once

#include <string>
#include <string_view>

namespace lumen {

/// `message` for a terminal: each of its lines is printable and has no object addresses, which
/// libraries put into their messages ("NrrdImageIO(0x55d0c0ffee00): ") and which differ from run to
/// run.
std::string messageText(std::string_view message);

}  // namespace lumen
