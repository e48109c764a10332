// SPDX-License-Identifier: Apache-2.0
// Files elsewhere that one command reads. They lie in a private folder, which goes with this
// object; all that the command states about them names their addresses, without queries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/run_program.h"
#include "converters/engine/command.h"
#include "converters/io/remote/remote_file.h"

namespace lumen::engine {

/// A file elsewhere, or the part of it that was read.
struct FetchedFile {
  std::filesystem::path path;  ///< here
  std::string address;         ///< without its query
  std::uint64_t bytes = 0;     ///< of the whole file
  std::uint64_t read = 0;      ///< of those that came
  std::string sha256;          ///< empty unless all of it came
};

class RemoteInputs {
public:
  /// Both must outlive this object.
  RemoteInputs(const BoundCommand& bound, const Surroundings& around);
  ~RemoteInputs();
  RemoteInputs(const RemoteInputs&) = delete;
  RemoteInputs& operator=(const RemoteInputs&) = delete;

  /// The surroundings of the command: where it fetches files, their messages name addresses.
  [[nodiscard]] Surroundings surroundings();

  /// Fetches the addresses in the command's addressRows(), and sets the rows to the files' names.
  /// Throws Error(Usage) for an address that is none, or that no command line states, and as
  /// convert::fetchFile().
  void fetchAll();

  /// The address that the row's value `text` is. Throws Error(Usage) as fetchAll().
  [[nodiscard]] convert::RemoteAddress addressIn(const OptionRow& row,
                                                 const std::string& text) const;
  /// Fetches a file whole; `path` is its place here. Throws as convert::fetchFile().
  const FetchedFile& fetch(const convert::RemoteAddress& address);
  /// A file here of the name and size of the one elsewhere, of which the first `count` bytes are
  /// there; behind them it has zeros, which take no room. If the server sends only whole files, it
  /// is fetched whole, with a warning. Throws as convert::fetchFile().
  const FetchedFile& fetchHead(const convert::RemoteAddress& address, std::uint64_t count);

  [[nodiscard]] const std::vector<FetchedFile>& files() const { return m_files; }
  /// Whether the file of that name lies elsewhere.
  [[nodiscard]] bool holds(const std::filesystem::path& file) const;
  /// `text` with addresses in place of names of files that were fetched.
  [[nodiscard]] std::string shown(std::string text) const;
  /// Adds a first step to the case: digests and sizes of the files that were fetched, if there are
  /// any. It holds no address, as one may identify a patient.
  void record(formats::Metadata& metadata) const;
  /// Names addresses in the answer, and adds `fetched` for commands that take addresses.
  void complete(Answer& answer) const;

private:
  class AddressProgress;
  std::filesystem::path newFolder();

  const BoundCommand& m_bound;
  const Surroundings& m_around;
  std::unique_ptr<AddressProgress> m_progress;
  std::optional<convert::PrivateFolder> m_folder;
  std::vector<FetchedFile> m_files;
};

}  // namespace lumen::engine
