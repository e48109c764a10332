# SPDX-License-Identifier: Apache-2.0
"""Angiograms and label maps of a BIDS data set, by the names of their files."""
import dataclasses
import pathlib
import re

from .errors import Fault
from .files import read_json

SUFFIXES = ("angio", "ct", "TOF")
ENDINGS = (".nii.gz", ".nii")
LABEL_MAP = "dseg"
# entities that may differ between a volume and the label map of it
OWN_OF_LABELS = ("desc", "space", "res", "den", "label", "atlas", "seg")
LABEL = re.compile(r"[0-9A-Za-z]+$")


@dataclasses.dataclass
class Volume:
    """An angiogram, with the label map that belongs to it, if there is one."""
    file: pathlib.Path
    place: str  # of the file in its data set, with slashes
    entities: dict
    suffix: str
    labels: pathlib.Path = None

    @property
    def subject(self):
        return self.entities["sub"]

    @property
    def session(self):
        return self.entities.get("ses", "")

    @property
    def folder(self):
        """The folder of its derivatives, relative to theirs."""
        return pathlib.PurePosixPath(self.place).parent

    @property
    def stem(self):
        return "_".join(f"{key}-{value}" for key, value in self.entities.items())

    @property
    def name(self):
        return f"{self.stem}_{self.suffix}"

    def derivative(self, out, desc, ending):
        """A file of the derivatives: the volume's name with desc-DESC."""
        return pathlib.Path(out) / self.folder / f"{self.stem}_desc-{desc}_{self.suffix}{ending}"

    @property
    def case_id(self):
        """An id as libraries of lumen have it: 1 to 64 of a to z, 0 to 9 and -."""
        return re.sub("[^a-z0-9]+", "-", self.name.lower())[:64].strip("-")


def parse_name(name):
    """Entities and suffix of "sub-01_ses-a_angio.nii.gz", or None for another name."""
    ending = next((e for e in ENDINGS if name.endswith(e)), None)
    if ending is None:
        return None
    *pairs, suffix = name[:-len(ending)].split("_")
    entities = {}
    for pair in pairs:
        key, dash, value = pair.partition("-")
        if not dash or not key.isalnum() or not LABEL.match(value) or key in entities:
            return None
        entities[key] = value
    return (entities, suffix) if "sub" in entities else None


def check_root(root):
    """Raises Fault for a folder that is no BIDS data set."""
    if not root.is_dir():
        raise Fault(f"{root}: there is no such folder, expected a BIDS data set")
    if not (root / "dataset_description.json").is_file():
        raise Fault(f"{root}: found no dataset_description.json in it, expected a BIDS data set")
    return read_json(root / "dataset_description.json", "description of a data set")


def image_files(root, subjects, sessions):
    """(file, place, entities, suffix) of all images below the folders of subjects, sorted."""
    for folder in sorted(root.glob("sub-*")):
        if not folder.is_dir() or (subjects and folder.name[4:] not in subjects):
            continue
        for file in sorted(folder.rglob("*.nii*")):
            parsed = parse_name(file.name)
            if parsed is None or parsed[0]["sub"] != folder.name[4:]:
                continue
            if sessions and parsed[0].get("ses") not in sessions:
                continue
            yield file, file.relative_to(root).as_posix(), *parsed


def label_maps(folders, subjects, sessions):
    """Label maps by their entities but those of label maps alone."""
    found = {}
    for folder in folders:
        for file, _, entities, suffix in image_files(folder, subjects, sessions):
            if suffix != LABEL_MAP:
                continue
            key = frozenset((k, v) for k, v in entities.items() if k not in OWN_OF_LABELS)
            if key in found and found[key] != file:
                raise Fault(f"{file}: is a label map of the same image as {found[key]}; "
                            "--labels names the folder whose maps count")
            found[key] = file
    return found


def find_volumes(root, suffixes, subjects=(), sessions=(), label_folders=()):
    """All angiograms of a data set. Raises Fault where there is none, or a label is not there."""
    check_root(root)
    maps = label_maps(label_folders or [root], subjects, sessions)
    volumes = []
    for file, place, entities, suffix in image_files(root, subjects, sessions):
        if suffix not in suffixes:
            continue
        labels = maps.get(frozenset(entities.items()))
        volumes.append(Volume(file, place, entities, suffix, labels))
    missing = [s for s in subjects if not (root / f"sub-{s}").is_dir()]
    if missing:
        raise Fault(f"{root}: there is no participant {', '.join(missing)}")
    if not volumes:
        expected = ", ".join(f"*_{s}{ENDINGS[0]}" for s in suffixes)
        raise Fault(f"{root}: found no angiogram, expected files such as {expected}; "
                    "--suffix names another suffix")
    refuse_equal_ids(volumes)
    return volumes


def refuse_equal_ids(volumes):
    """Two volumes must not share a name in the derivatives or in the library."""
    first = {}
    for volume in volumes:
        other = first.setdefault(volume.case_id, volume)
        if other is not volume:
            raise Fault(f"{volume.file}: its name becomes the id {volume.case_id}, "
                        f"as that of {other.file} does")


def label_table(label_map):
    """The table of names and roles of a label map, or None: the one with most entities of the map in the nearest
    folder of its data set, from its own folder up (BIDS, inheritance principle)."""
    own = set(label_map.name.split(".")[0].split("_"))
    for folder in label_map.parents:
        tables = [file for file in sorted(folder.glob(f"*{LABEL_MAP}.tsv")) if set(file.stem.split("_")) <= own]
        if tables:
            return max(tables, key=lambda file: file.stem.count("_"))
        if (folder / "dataset_description.json").exists():
            return None
    return None
