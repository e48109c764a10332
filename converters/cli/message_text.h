// SPDX-License-Identifier: Apache-2.0
// The last thing that happens to a message before it is shown.
#pragma once

#include <string>
#include <string_view>

namespace lumen {

/// `message` as a terminal may have it: each of its lines printable, and without the addresses of
/// objects that libraries put into theirs ("NrrdImageIO(0x55d0c0ffee00): "), which tell nobody
/// anything and differ from run to run.
std::string messageText(std::string_view message);

}  // namespace lumen
