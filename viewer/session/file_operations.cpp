// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/file_operations.h"

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/volume/dicom/dicom_series.h"
#include "formats/container/printable.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document_seeds.h"
#include "viewer/session/proposals.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = std::size_t{1} << 30;

std::string nameOf(const fs::path& file) {
  return formats::printable(file.filename().string());
}

/// The last part of a path that may end in a slash.
std::string folderName(const fs::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

/// How a file of that role was opened.
OpenAs openAs(FileRole role) {
  if (role == FileRole::Truth) return OpenAs::Truth;
  return role == FileRole::Second ? OpenAs::Second : OpenAs::Auto;
}

/// The part that a page wants a series of DICOM to be.
OpenAs seriesAs(const Arguments& request) {
  return request.flag("second") ? OpenAs::Second : OpenAs::Auto;
}

/// Files of a folder of DICOM that belong to no series; empty if there are none.
std::string leftOut(const convert::DicomListing& listing) {
  std::string text;
  if (!listing.faults.empty())
    text = counted(listing.faults.size(), "file cannot be read", "files cannot be read");
  if (listing.others > 0)
    text += (text.empty() ? "" : ", ") +
            counted(listing.others, "file is no image", "files are no images");
  return text;
}

}  // namespace

void FileOperations::open(const Opening& opening, Progress& progress) {
  const Moment before = m_workspace.history.now();
  Document document = withFile(before.document, opening, m_workspace.nextFile(),
                               m_workspace.options.volume, progress);
  const auto hold = [this, &before](const Document& opened) {
    if (opened.value != before.document.value)
      m_workspace.saving.holdCase(opened);
    else if (opened.seeds != before.document.seeds)
      m_workspace.saving.holdSeeds(opened.seeds);
  };
  if (opening.dropped)
    return m_workspace.commit("open " + opening.label, before, std::move(document), hold);
  {
    const std::lock_guard swap(m_workspace.swapping);
    hold(document);
    // the files that the user began with cannot be undone
    m_workspace.history.begin(std::move(document));
  }
  m_workspace.announce();
}

Json FileOperations::openDropped(std::shared_ptr<const DroppedFile> file, const std::string& label,
                                 OpenAs as) {
  return m_workspace.startJob(
      "opening " + formats::printable(label), true,
      [this, file = std::move(file), label, as](Progress& progress) mutable {
        const auto read = std::exchange(file, nullptr);  // removed before the job reports its end
        open({read->path(), label, true, as}, progress);
        return formats::printable(label) + " is open";
      });
}

bool FileOperations::offerSeries(const fs::path& folder, Progress& progress) {
  convert::DicomListing listing =
      convert::listDicomSeries(folder, m_workspace.options.volume.options(), progress);
  if (listing.series.size() < 2) return false;
  m_workspace.series.offer({folder, folderName(folder), nullptr}, std::move(listing));
  return true;
}

Json FileOperations::listSeries(const Arguments& request) {
  auto folder = std::make_shared<SeriesFolder>(m_workspace.series.take(request.whole("batch")));
  return m_workspace.startJob(
      "looking through files of DICOM", true,
      [this, folder = std::move(folder), as = seriesAs(request)](Progress& progress) mutable {
        const auto from = std::exchange(folder, nullptr);
        return openOnlySeries(std::move(*from), as, progress);
      });
}

std::string FileOperations::openOnlySeries(SeriesFolder folder, OpenAs as, Progress& progress) {
  convert::DicomListing listing =
      convert::listDicomSeries(folder.path, m_workspace.options.volume.options(), progress);
  const std::size_t count = listing.series.size();
  const std::string left = leftOut(listing);
  if (count == 0)
    throw invalidInput("these files hold no DICOM images" + (left.empty() ? "" : "; " + left));
  const bool isOnly = count == 1 && listing.series[0].fault.empty();
  Opening opening{folder.path, seriesLabel(listing.series[0], 0), true, as};
  opening.kept = folder.kept;
  m_workspace.series.offer(std::move(folder), std::move(listing));
  if (isOnly) open(opening, progress);
  return (isOnly ? opening.label + " is open"
                 : "choose one of " + std::to_string(count) + " series") +
         (left.empty() ? "" : "; " + left);
}

Json FileOperations::openSeries(const Arguments& request) {
  Opening opening = m_workspace.series.opening(request, "series");
  opening.as = seriesAs(request);
  return m_workspace.startJob(
      "opening " + opening.label, true, [this, opening](Progress& progress) {
        const Moment before = m_workspace.history.now();
        m_workspace.commit("open " + opening.label, before,
                           withFile(before.document, opening, m_workspace.nextFile(),
                                    m_workspace.options.volume, progress));
        return opening.label + " is open";
      });
}

Json FileOperations::closeSeries() {
  m_workspace.series.clear();
  m_workspace.announceState();
  return m_workspace.revision();
}

Json FileOperations::openCase(const Arguments& request) {
  const Library* library = m_workspace.library.library();
  if (library == nullptr) throw Error(ErrorKind::Usage, "no library is open");
  const std::size_t index = request.index("index", library->size());
  if (m_workspace.hasUnsaved() && !request.flag("force"))
    throw Conflict("the open case has changes that are not saved");
  return m_workspace.startJob(
      "opening " + library->at(index).name, true,
      [this, index](Progress& progress) { return openListed(index, progress); });
}

std::string FileOperations::openListed(std::size_t index, Progress& progress) {
  const Library& library = *m_workspace.library.library();
  const auto& [file, name, keptAt] = library.at(index);
  // truth, seeds and meshes belong to the vessel tree that was open
  Document document =
      withFile({}, {file, name}, m_workspace.nextFile(), m_workspace.options.volume, progress);
  progress.check();
  const auto kept = m_workspace.keepUnsaved();  // nothing can be undone afterwards
  const std::lock_guard swap(m_workspace.swapping);
  m_workspace.saving.holdCase(document);
  m_workspace.saving.holdSeeds(nullptr);
  m_workspace.findings.clear();
  m_workspace.library.setOpenCase(index);
  m_workspace.history.begin(std::move(document));
  if (library.isPublished())
    m_workspace.saving.saveNowhere(keptAt);
  else
    m_workspace.saving.saveTo(file);
  m_workspace.findUnsaved();
  return name + " is open" +
         (kept.empty() ? "" : "; unsaved work on the case before is in " + nameOf(kept.front()));
}

Json FileOperations::reload(const Arguments& request, const Moment& from) {
  const auto id = static_cast<int>(request.index("id", kMostFiles));
  const auto& files = from.document.files;
  const auto file =
      std::find_if(files.begin(), files.end(), [id](const OpenFile& f) { return f.id == id; });
  if (file == files.end() || file->path.empty())
    throw Error(ErrorKind::Usage, "no file of number " + std::to_string(id) + " was named");
  return m_workspace.startJob("reading " + file->label + " again", true,
                              [this, from, file = *file](Progress& progress) {
                                reloadFile(file, from, progress);
                                return file.label + " was read again";
                              });
}

void FileOperations::reloadFile(const OpenFile& file, const Moment& from, Progress& progress) {
  Opening opening{file.path, file.label, false, openAs(file.role)};
  opening.series = file.series;
  if (const FileRole role = openingRole(opening); role != file.role)
    throw invalidInput(file.label + ": it was " + roleName(file.role) + ", and is " +
                       roleName(role) + " now; open it by itself");
  // a mesh is added to the others, and pages know it by its number; other parts replace the one
  // before
  const int id = file.role == FileRole::Mesh ? m_workspace.nextFile() : file.id;
  const Document before =
      file.role == FileRole::Mesh ? withoutFile(from.document, file.id) : from.document;
  Document document = withFile(before, opening, id, m_workspace.options.volume, progress);
  m_workspace.commit("read " + file.label + " again", from, std::move(document),
                     [this, &file](const Document& read) {
                       if (file.role == FileRole::Case) m_workspace.saving.holdCase(read);
                       if (file.role == FileRole::Seeds) m_workspace.saving.holdSeeds(read.seeds);
                       m_workspace.saving.acceptTarget(file.path);
                     });
  if (m_workspace.changedFiles.look(m_workspace.history.now().document))
    m_workspace.announceState();
}

Json FileOperations::close(const Arguments& request, const Moment& from) {
  const auto id = static_cast<int>(request.index("id", kMostFiles));
  m_workspace.commit("close a file", from, withoutFile(from.document, id));
  return m_workspace.revision();
}

Json FileOperations::save(const Arguments& request, const Moment& from) {
  Document document = from.document;
  fs::path file;
  {
    // a job may have put another document with another file in its place meanwhile
    const std::lock_guard swap(m_workspace.swapping);
    m_workspace.requireNow(from);
    file = m_workspace.saving.save(document, request.flag("force"));
    m_workspace.history.restamp(document.files);
  }
  m_workspace.keepUnsaved();
  const std::size_t waiting = waitingSeeds(document).size();
  m_workspace.sendMessage(
      "note",
      file.filename().string() + " is saved" +
          (waiting == 0 ? "" : ", with " + counted(waiting, "seed that waits", "seeds that wait")));
  m_workspace.announce();
  return m_workspace.revision();
}

fs::path FileOperations::foundCopy(const Arguments& request) const {
  const std::string name = request.text("name");
  for (const fs::path& file : m_workspace.unsavedWork.found())
    if (nameOf(file) == name) return file;
  throw Conflict(formats::printable(name) + " is not among the unsaved work any more");
}

Json FileOperations::recover(const Arguments& request, const Moment& from) {
  const fs::path file = foundCopy(request);
  const std::string name = nameOf(file);
  return m_workspace.startJob(
      "reading " + name, true, [this, file, name, from](Progress& progress) {
        Document before = from.document;
        // a copy has all that waited
        before.seeds = std::make_shared<const Seeds>(trackedSeeds(from.document));
        const Document read =
            withFile(before, {file, name}, 0, m_workspace.options.volume, progress);
        Document document = from.document;
        if (holdsProposals(file)) {
          document.proposals = proposalsFor(from.document, read.value);
        } else {
          document.value = read.value;
          document.seeds = read.seeds;
        }
        m_workspace.commit("take " + name, from, std::move(document));
        return "this is " + name + ", which was not saved";
      });
}

Json FileOperations::forget(const Arguments& request) {
  m_workspace.unsavedWork.remove(foundCopy(request));
  m_workspace.announce();
  return m_workspace.revision();
}

}  // namespace lumen::viewer
