// SPDX-License-Identifier: Apache-2.0
// Entities of RO-Crate 1.2 (https://w3id.org/ro/crate/1.2).
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::convert {

using CrateEntity = nlohmann::ordered_json;

/// The document up to its first entity: one entity on each line.
std::string crateHead();
/// The next entity.
std::string crateLine(const CrateEntity& entity);
std::string crateEnd();

/// {"@id": id}
CrateEntity reference(std::string_view id);

/// The entity of the metadata file itself, which every such file begins with; with crateHead(), the
/// only entity without a comma before it.
CrateEntity descriptor();

/// Identifier that refers to a licence expression: its page at SPDX, or a name within the document.
std::string licenceId(const std::string& expression);
CrateEntity licenceEntity(const std::string& expression);

/// The library's own entity, "./", but for its parts.
CrateEntity libraryEntity(const LibraryFile& library);
/// A case in the crate of its library: a folder with a crate of its own.
CrateEntity caseEntity(const CaseRecord& record);

}  // namespace lumen::convert
