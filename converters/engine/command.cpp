// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/command.h"

#include "converters/base/error.h"

namespace lumen::engine {

namespace {

BoundCommand bound(std::unique_ptr<Command> command) {
  BoundCommand made{std::move(command), std::make_unique<OptionTable>()};
  made.command->addRows(*made.table);
  return made;
}

/// The first argument row that still takes a text.
OptionRow* nextArgument(OptionTable& table) {
  for (OptionRow& row : table.rows())
    if (row.isArgument && !row.isGiven) return &row;
  return nullptr;
}

void setArguments(OptionTable& table, const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size();) {
    OptionRow* const row = nextArgument(table);
    if (row == nullptr) throw Error(ErrorKind::Usage, arguments[i] + ": one argument too many");
    const auto first = arguments.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = row->repeats ? arguments.end() : first + 1;
    row->set({first, last});
    i = static_cast<std::size_t>(last - arguments.begin());
  }
}

void requireGiven(const OptionTable& table) {
  for (const OptionRow& row : table.rows())
    if (row.isRequired && !row.isGiven)
      throw Error(ErrorKind::Usage, row.shownName() + " is missing");
}

}  // namespace

void setRows(OptionTable& table, const Operation& operation, MemoryFiles* memory) {
  for (OptionRow& row : table.rows()) row.memory = memory;
  setArguments(table, operation.arguments);
  for (const auto& [name, values] : operation.options) table.set(name, values);
  requireGiven(table);
  requireCompatible(table);
}

void requireCompatible(const OptionTable& table) {
  for (const OptionRow& row : table.rows())
    for (const std::string& other : row.excludes)
      if (const OptionRow* found = table.find(other); row.isGiven && found && found->isGiven)
        throw Error(ErrorKind::Usage,
                    row.shownName() + " and " + found->shownName() + " exclude one another");
}

std::vector<BoundCommand> Engine::commands() const {
  std::vector<BoundCommand> all;
  for (const Maker& make : m_makers) all.push_back(bound(make()));
  return all;
}

BoundCommand Engine::find(const std::string& name) const {
  for (const Maker& make : m_makers)
    if (std::unique_ptr<Command> command = make(); command->name() == name)
      return bound(std::move(command));
  return {};
}

Answer Engine::run(const BoundCommand& bound, const RunContext& context) const {
  RunContext own = context;
  own.table = bound.table.get();
  return bound.command->run(own);
}

Answer Engine::run(const Operation& operation, const RunContext& context) const {
  const BoundCommand found = find(operation.name);
  if (!found.command) throw Error(ErrorKind::Usage, operation.name + ": there is no such command");
  setRows(*found.table, operation, context.memory);
  return run(found, context);
}

}  // namespace lumen::engine
