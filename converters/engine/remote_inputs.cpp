// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/remote_inputs.h"

#include <algorithm>
#include <chrono>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/sha256.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

/// Every text of a JSON value as `shown` gives it.
template <class Shown>
void replaceTexts(Json& json, const Shown& shown) {
  if (json.is_string()) json = shown(json.get<std::string>());
  if (json.is_structured())
    for (Json& below : json) replaceTexts(below, shown);
}

}  // namespace

/// Names addresses in messages. A thread of its own passes a cancellation on, which has no call of
/// its own.
class RemoteInputs::AddressProgress : public Progress {
public:
  AddressProgress(Progress& around, const RemoteInputs& inputs)
      : m_around(around), m_inputs(inputs), m_watch([this](const std::stop_token& stop) {
          constexpr std::chrono::milliseconds kTick{50};
          for (; !stop.stop_requested() && !cancelled(); std::this_thread::sleep_for(kTick))
            if (m_around.cancelled()) cancel();
        }) {}
  void begin(std::string_view stage, std::size_t total) override { m_around.begin(stage, total); }
  void advance(std::size_t units) override { m_around.advance(units); }
  void end() override { m_around.end(); }
  void detail(std::string_view message) override { m_around.detail(shown(message)); }
  void warn(std::string_view message) override { m_around.warn(shown(message)); }

private:
  [[nodiscard]] std::string shown(std::string_view message) const {
    return m_inputs.shown(std::string(message));
  }
  Progress& m_around;
  const RemoteInputs& m_inputs;
  std::jthread m_watch;
};

RemoteInputs::RemoteInputs(const BoundCommand& bound, const Surroundings& around)
    : m_bound(bound), m_around(around) {}

RemoteInputs::~RemoteInputs() = default;

Surroundings RemoteInputs::surroundings() {
  const auto& rows = m_bound.table->rows();
  const bool isAsked = std::any_of(rows.begin(), rows.end(), [](const OptionRow& row) {
    return std::any_of(row.givenValues.begin(), row.givenValues.end(), convert::isRemote);
  });
  if (isAsked || !m_files.empty())
    m_progress = std::make_unique<AddressProgress>(m_around.progress, *this);
  Surroundings own{m_around.engine, m_progress ? *m_progress : m_around.progress};
  own.table = m_bound.table.get();
  own.remote = this;
  own.mayFetch = m_around.mayFetch;
  own.threads = m_around.threads;
  own.strict = m_around.strict;
  own.answerEarly = m_around.answerEarly;
  return own;
}

convert::RemoteAddress RemoteInputs::addressIn(const OptionRow& row,
                                               const std::string& text) const {
  convert::RemoteAddress address = convert::parseRemote(text);
  if (!m_around.mayFetch || row.isPreference)
    throw Error(ErrorKind::Usage,
                row.shownName() + " " + formats::printable(address.shown()) +
                    ": lumen asks only for addresses of its own command line, and this one is in a "
                    "file");
  return address;
}

void RemoteInputs::fetchAll() {
  const std::vector<std::string> names = m_bound.command->addressRows();
  for (OptionRow& row : m_bound.table->rows()) {
    if (!row.isGiven || std::find(names.begin(), names.end(), row.name) == names.end()) continue;
    std::vector<std::string> texts = row.givenValues;
    if (std::none_of(texts.begin(), texts.end(), convert::isRemote)) continue;
    for (std::string& text : texts)
      if (convert::isRemote(text)) text = fetch(addressIn(row, text)).path.string();
    row.set(texts);
  }
}

fs::path RemoteInputs::newFolder() {
  if (!m_folder) m_folder.emplace();
  // files of equal names come from several places
  const fs::path folder = m_folder->path() / std::to_string(m_files.size() + 1);
  fs::create_directory(folder);
  return folder;
}

const FetchedFile& RemoteInputs::fetch(const convert::RemoteAddress& address) {
  const convert::RemoteFile file = convert::fetchFile(address, newFolder(), {}, m_around.progress);
  m_files.push_back({file.path, address.shown(), file.bytes, file.bytes, file.sha256});
  m_around.progress.detail(address.shown() + ": " + std::to_string(file.bytes) +
                           " bytes, SHA-256 " + file.sha256);
  return m_files.back();
}

const FetchedFile& RemoteInputs::fetchHead(const convert::RemoteAddress& address,
                                           std::uint64_t count) {
  const fs::path folder = newFolder();
  const auto head = convert::fetchHead(address, count, folder, {}, m_around.progress);
  if (!head) {
    m_around.progress.warn(address.shown() +
                           ": its server does not send parts of files, so all of it is fetched");
    fs::remove(folder);
    return fetch(address);
  }
  const fs::path file = folder / address.fileName();
  writeNewFile(head->bytes, file);
  std::error_code error;
  fs::resize_file(file, head->whole, error);
  if (error)
    throw failed(address.shown() + ": states " + std::to_string(head->whole) +
                 " bytes, for which there is no room: " + error.message());
  m_files.push_back({file, address.shown(), head->whole, head->bytes.size(), {}});
  if (head->bytes.size() == head->whole) m_files.back().sha256 = digestOfFile(file).sha256;
  return m_files.back();
}

bool RemoteInputs::holds(const fs::path& file) const {
  return std::any_of(m_files.begin(), m_files.end(),
                     [&](const FetchedFile& one) { return one.path == file; });
}

std::string RemoteInputs::shown(std::string text) const {
  for (const FetchedFile& file : m_files)
    text = replaced(std::move(text), file.path.string(), file.address);
  return text;
}

void RemoteInputs::record(formats::Metadata& metadata) const {
  if (m_files.empty()) return;
  formats::Step step{"fetch", "lumen " LUMEN_VERSION, {}};
  for (std::size_t i = 0; i < m_files.size(); ++i) {
    const std::string name = "file-" + std::to_string(i + 1);
    step.parameters[name + "-bytes"] = static_cast<std::int64_t>(m_files[i].bytes);
    if (!m_files[i].sha256.empty()) step.parameters[name + "-sha256"] = m_files[i].sha256;
  }
  metadata.steps.insert(metadata.steps.begin(), std::move(step));
}

void RemoteInputs::complete(Answer& answer) const {
  if (!m_bound.command->fetches()) return;
  if (!m_files.empty()) {
    answer.text = shown(std::move(answer.text));
    replaceTexts(answer.json, [this](const std::string& text) { return shown(text); });
  }
  Json list = Json::array();
  for (const FetchedFile& file : m_files) {
    const bool isWhole = !file.sha256.empty();
    list.push_back({{"address", file.address},
                    {"bytes", file.bytes},
                    {"read", file.read},
                    {"sha256", isWhole ? Json(file.sha256) : Json(nullptr)}});
    answer.text += formats::printable(file.address) + ": " + std::to_string(file.read) +
                   (isWhole ? " bytes, SHA-256 " + file.sha256
                            : " of " + std::to_string(file.bytes) + " bytes read") +
                   "\n";
  }
  if (answer.json.is_object()) answer.json["fetched"] = std::move(list);
}

}  // namespace lumen::engine
