// SPDX-License-Identifier: Apache-2.0
// Vessels that were found in the volume and wait for a person to accept or reject them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// The name of the node array by which a proposal hangs on the open case: for each node 1 and the
/// position, mm, LPS, of the case's node that it is joined to, or four zeros. For the first node of
/// a tree this is its parent, for all others the other end of a link.
constexpr const char* kJoinedArray = "LUMEN_proposal.joined";

/// The vessels behind the first `known` branches of `found`, without models, as proposals for a
/// case of those first ones. Null if there are none.
std::shared_ptr<const formats::Case> proposalsBehind(formats::Case found, std::uint32_t known);

/// Proposals for a document: without those of which more than half of the nodes lie in vessels of
/// its case, and with names that neither a vessel nor a seed has. A proposal that hung on one that is
/// left out hangs on the case's vessel there. Null if none is left, or for null.
std::shared_ptr<const formats::Case> proposalsFor(const Document& document,
                                                  std::shared_ptr<const formats::Case> proposals);

/// Marks of the proposals that a request names in "labels"; of all without it. Throws Error(Usage)
/// if there are no proposals, and for a label that none has.
std::vector<bool> chosenProposals(const Document& document, const Arguments& request);

/// A document with accepted proposals, whose models are not fitted yet.
struct Acceptance {
  Document document;
  std::shared_ptr<formats::Case> value;    ///< the document's case
  std::uint32_t firstNewNode = 0;          ///< nodes before it are those of the case before
  std::size_t count = 0;                   ///< accepted vessels
  std::string title;                       ///< for undo, such as "accept A.1.3"
  std::vector<std::string> droppedArrays;  ///< node arrays without values for new nodes
};

/// Accepts the marked proposals, with the proposals that lie between them and their roots, into the
/// case of the document, or into a new one. Throws Error(InvalidInput) if the case would break a
/// rule of the format.
Acceptance accepted(const Document& document, std::vector<bool> chosen);

/// The document without the marked proposals. Proposals that hung on them wait as trees
/// of their own.
Document rejected(const Document& document, const std::vector<bool>& chosen);

/// "accept A.1.3" or "accept 12 vessels" of the marked proposals; `verb` begins the title.
std::string makeTitle(const char* verb, const formats::Case& proposals,
                      const std::vector<bool>& chosen);

/// The list of proposals as the state has it (viewer/README.md).
Json proposalsJson(const Document& document);

}  // namespace lumen::viewer
