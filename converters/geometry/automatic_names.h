// SPDX-License-Identifier: Apache-2.0
// The names of vessels that nobody has named.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// The name of a vessel while its tree is being made, such as vessel-12: numbers from 1 on.
std::string provisionalName(std::size_t number);

/// An automatic name: of a tree, such as A.1.2 or A.1.2-3, or of a vessel whose tree is not known, such
/// as vessel-4 or vessel-4-2. No person names vessels so: A1 and M2 are segments of cerebral arteries,
/// which have no point.
bool isAutomaticName(const std::string& label);

/// One of the pieces of a vessel that is cut, numbered along the flow: A.1, A.1-2, A.1-3.
struct PieceName {
  std::string vessel;
  std::size_t piece = 1;
  /// At most as long as a name may be.
  [[nodiscard]] std::string text() const;
};

/// The piece that an automatic name states: A.1.2 and 3 of A.1.2-3. Any other name is that of a vessel.
PieceName pieceNameOf(const std::string& label);

/// The name, or where it is taken that of the first further piece which is not.
std::string freeName(const std::string& name, const std::set<std::string>& taken);

/// Gives the vessels from branch `first` on that have a provisional name, but for the names in `kept`,
/// one by their place in the tree; all others keep theirs. A.0 begins the tree A, A.1 leaves it, and
/// A.1.2 hangs on A.1 or on what hangs on that. Letters A to Z, AA and so on go to the trees, numbers
/// to the vessels, by the lumen of all that hangs on them, largest first, so that a small vessel more or
/// less renames none that is larger. A vessel that has a name holds its place.
void nameAutomatically(formats::CenterlineTree& tree, std::size_t first = 0,
                       const std::set<std::string>& kept = {});

}  // namespace lumen::convert
