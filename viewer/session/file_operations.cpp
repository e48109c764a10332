// SPDX-License-Identifier: Apache-2.0
// operations.h and session.h: files are opened, read again, closed, saved, recovered.

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/volume/dicom/dicom_series.h"
#include "formats/container/printable.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document_seeds.h"
#include "viewer/session/operations.h"
#include "viewer/session/proposals.h"
#include "viewer/session/session.h"

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
  if (role == FileRole::Labels) return OpenAs::Labels;
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

std::string openOnlySeries(Session& session, std::shared_ptr<const DroppedFiles> files, OpenAs as,
                           Progress& progress) {
  Opening folder{files->folder(), "dropped files", as, {}, files};
  convert::DicomListing listing =
      convert::listDicomSeries(folder.file, session.options.volume.options(), progress);
  const std::size_t count = listing.series.size();
  const std::string left = leftOut(listing);
  if (count == 0)
    throw invalidInput("these files hold no DICOM images" + (left.empty() ? "" : "; " + left));
  const bool isOnly = count == 1 && listing.series[0].fault.empty();
  Opening opening = folder;
  opening.label = seriesLabel(listing.series[0], 0);
  session.series.offer(std::move(folder), std::move(listing));
  if (isOnly) session.open(opening, progress);
  return (isOnly ? opening.label + " is open"
                 : "choose one of " + std::to_string(count) + " series") +
         (left.empty() ? "" : "; " + left);
}

std::string openListed(Session& session, std::size_t index, Progress& progress) {
  Library& library = session.library;
  const auto& [file, name, keptAt] = library.at(index);
  // truth, seeds and meshes belong to the vessel tree that was open
  Document document = withFile({}, {file, name}, session.nextFile(), session.options, progress);
  progress.check();
  const auto kept = session.keepUnsaved();  // nothing can be undone afterwards
  const std::lock_guard swap(session.swapping);
  session.saving.holdCase(document);
  session.saving.holdSeeds(nullptr);
  session.findings.clear();
  library.setOpenCase(index);
  session.history.begin(std::move(document));
  if (library.isPublished())
    session.saving.saveNowhere(keptAt);
  else
    session.saving.saveTo(file);
  session.findUnsaved();
  return name + " is open" +
         (kept.empty() ? "" : "; unsaved work on the case before is in " + nameOf(kept.front()));
}

void reloadFile(Session& session, const OpenFile& file, const Moment& from, Progress& progress) {
  const Opening opening{file.path, file.label, openAs(file.role), file.series};
  if (const FileRole role = openingRole(opening); role != file.role)
    throw invalidInput(file.label + ": it was " + roleName(file.role) + ", and is " +
                       roleName(role) + " now; open it by itself");
  // a mesh is added to the others, and pages know it by its number; other parts replace the one
  // before
  const int id = file.role == FileRole::Mesh ? session.nextFile() : file.id;
  const Document before =
      file.role == FileRole::Mesh ? withoutFile(from.document, file.id) : from.document;
  Document document = withFile(before, opening, id, session.options, progress);
  session.commit("read " + file.label + " again", from, std::move(document),
                 [&session, &file](const Document& read) {
                   if (file.role == FileRole::Case) session.saving.holdCase(read);
                   if (file.role == FileRole::Seeds) session.saving.holdSeeds(read.seeds);
                   session.saving.acceptTarget(file.path);
                 });
  if (session.changedFiles.look(session.now().document)) session.announceState();
}

fs::path foundCopy(Session& session, const Arguments& request) {
  const std::string name = request.text("name");
  for (const fs::path& file : session.unsavedWork.found())
    if (nameOf(file) == name) return file;
  throw Conflict(formats::printable(name) + " is not among the unsaved work any more");
}

}  // namespace

void Session::open(const Opening& opening, Progress& progress) {
  const Moment before = now();
  Document document = withFile(before.document, opening, nextFile(), options, progress);
  const auto hold = [this, &before](const Document& opened) {
    if (opened.value != before.document.value)
      saving.holdCase(opened);
    else if (opened.seeds != before.document.seeds)
      saving.holdSeeds(opened.seeds);
  };
  if (opening.file.isInMemory() && !opening.isFirst) {
    commit("open " + opening.label, before, std::move(document), hold);
    return;
  }
  {
    const std::lock_guard swap(swapping);
    hold(document);
    // the files that the user began with cannot be undone
    history.begin(std::move(document));
  }
  announce();
}

bool Session::offerSeries(const fs::path& folder, Progress& progress) {
  convert::DicomListing listing =
      convert::listDicomSeries(folder, options.volume.options(), progress);
  if (listing.series.size() < 2) return false;
  series.offer({folder, folderName(folder)}, std::move(listing));
  return true;
}

Json Session::openDropped(const std::string& name, std::string bytes, OpenAs as, bool isFirst) {
  auto file = std::make_shared<DroppedFiles>();
  file->add(name, std::move(bytes));
  const std::lock_guard gate(m_gate);
  return startJob("opening " + formats::printable(name), true,
                  [this, file = std::move(file), name, as, isFirst](Progress& progress) mutable {
                    const auto read = std::exchange(file, nullptr);  // goes before the job ends
                    open({read->first(), name, as, {}, read, isFirst}, progress);
                    return formats::printable(name) + " is open";
                  });
}

Json listSeries(Session& session, const Arguments& request, const Moment&) {
  auto files = session.series.end(request.whole("batch"));
  return session.startJob(
      "looking through files of DICOM", true,
      [&session, files = std::move(files), as = seriesAs(request)](Progress& progress) mutable {
        return openOnlySeries(session, std::exchange(files, nullptr), as, progress);
      });
}

Json openSeries(Session& session, const Arguments& request, const Moment&) {
  Opening opening = session.series.opening(request, "series");
  opening.as = seriesAs(request);
  return session.startJob(
      "opening " + opening.label, true, [&session, opening](Progress& progress) {
        const Moment before = session.now();
        session.commit(
            "open " + opening.label, before,
            withFile(before.document, opening, session.nextFile(), session.options, progress));
        return opening.label + " is open";
      });
}

Json closeSeries(Session& session, const Arguments&, const Moment&) {
  session.series.clear();
  session.announceState();
  return session.revision();
}

Json openCase(Session& session, const Arguments& request, const Moment&) {
  const Library& library = session.library;
  if (!library.isOpen()) refuse("no library is open");
  const std::size_t index = request.index("index", library.size());
  if (session.hasUnsaved() && !request.flag("force"))
    throw Conflict("the open case has changes that are not saved");
  return session.startJob(
      "opening " + library.at(index).name, true,
      [&session, index](Progress& progress) { return openListed(session, index, progress); });
}

Json reload(Session& session, const Arguments& request, const Moment& from) {
  const auto id = static_cast<int>(request.index("id", kMostFiles));
  const auto& files = from.document.files;
  const auto file =
      std::find_if(files.begin(), files.end(), [id](const OpenFile& f) { return f.id == id; });
  if (file == files.end() || file->path.empty())
    refuse("no file of number " + std::to_string(id) + " was named");
  return session.startJob("reading " + file->label + " again", true,
                          [&session, from, file = *file](Progress& progress) {
                            reloadFile(session, file, from, progress);
                            return file.label + " was read again";
                          });
}

Json closeFile(Session& session, const Arguments& request, const Moment& from) {
  const auto id = static_cast<int>(request.index("id", kMostFiles));
  return session.commit("close a file", from, withoutFile(from.document, id));
}

Json save(Session& session, const Arguments& request, const Moment& from) {
  Document document = from.document;
  fs::path file;
  {
    // a job may have put another document with another file in its place meanwhile
    const std::lock_guard swap(session.swapping);
    session.requireNow(from);
    file = session.saving.save(document, request.flag("force"));
    session.history.restamp(document.files);
  }
  session.keepUnsaved();
  const std::size_t waiting = waitingSeeds(document).size();
  session.sendMessage(
      "note",
      file.filename().string() + " is saved" +
          (waiting == 0 ? "" : ", with " + counted(waiting, "seed that waits", "seeds that wait")));
  session.announce();
  return session.revision();
}

Json recover(Session& session, const Arguments& request, const Moment& from) {
  const fs::path file = foundCopy(session, request);
  const std::string name = nameOf(file);
  return session.startJob(
      "reading " + name, true, [&session, file, name, from](Progress& progress) {
        Document before = from.document;
        // a copy has all that waited
        before.seeds = std::make_shared<const Seeds>(trackedSeeds(from.document));
        const Document read = withFile(before, {file, name}, 0, session.options, progress);
        Document document = from.document;
        if (holdsProposals(file)) {
          document.proposals = proposalsFor(from.document, read.value);
        } else {
          document.value = read.value;
          document.seeds = read.seeds;
        }
        session.commit("take " + name, from, std::move(document));
        return "this is " + name + ", which was not saved";
      });
}

Json forget(Session& session, const Arguments& request, const Moment&) {
  session.unsavedWork.remove(foundCopy(session, request));
  session.announce();
  return session.revision();
}

}  // namespace lumen::viewer
