# SPDX-License-Identifier: Apache-2.0
"""lumen-bids BIDS_DIR OUT participant|group|list: the command line of a BIDS app."""
import argparse
import pathlib
import sys

from . import group, participant
from .dataset import SUFFIXES, find_volumes
from .describe import describe_dataset
from .errors import USAGE, Fault
from .program import Program

ABOUT = """Vessels of the angiograms of a BIDS data set, by lumen.

participant  writes derivatives of each volume into OUT: case, mesh, centerline, check, measures,
             report; a volume is made again only if its content, its label map, an option or the
             version of lumen is another
group        makes OUT/library of all cases, the table OUT/measures.tsv, and OUT/quality.html,
             the volumes first that are unlike the others
list         writes OUT/volumes.csv, the list from which lumen library build makes a library on
             this machine, and the workflow of Snakemake on a cluster"""

EXIT_CODES = "Exit codes: 0 done, 1 failed, 2 usage, 3 invalid input, as those of lumen."


def parser():
    made = argparse.ArgumentParser(prog="lumen-bids", description=ABOUT, epilog=EXIT_CODES,
                                   formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("bids_dir", metavar="BIDS_DIR", help="data set")
    made.add_argument("out", metavar="OUT", help="folder of the derivatives")
    made.add_argument("level", choices=("participant", "group", "list"), help="level of analysis")
    made.add_argument("--participant-label", "--participant_label", nargs="+", default=[],
                      metavar="LABEL", help="only these participants, without sub-")
    made.add_argument("--session-label", "--session_label", nargs="+", default=[],
                      metavar="LABEL", help="only these sessions, without ses-")
    made.add_argument("--suffix", nargs="+", default=list(SUFFIXES), metavar="SUFFIX",
                      help="suffixes of angiograms (default: %(default)s)")
    made.add_argument("--labels", action="append", default=[], metavar="DIR",
                      help="data set with label maps, *_dseg.nii.gz, which name the vessels "
                           "and state what is none (default: BIDS_DIR)")
    made.add_argument("--config", metavar="FILE", help="options of lumen convert, one on a line")
    made.add_argument("--export", action="append", default=[], metavar="TARGET",
                      help="also the folder of this target of lumen export; may be repeated")
    made.add_argument("--statements", metavar="FILE",
                      help="JSON object of statements about all cases of the library: anatomy, "
                           "modality, consent, deidentification, synthetic, licence, ...")
    made.add_argument("--title", default="Vessels", help="title of the library (default: Vessels)")
    made.add_argument("--licence", default="", metavar="SPDX", help="licence of a new library")
    made.add_argument("--jobs", type=int, default=1, metavar="N", help="volumes at once")
    made.add_argument("--threads", type=int, default=0, metavar="N",
                      help="threads of each run of lumen (default: all cores)")
    made.add_argument("--lumen", metavar="PROGRAM", help="the program lumen (default: $LUMEN, the "
                                                         "one beside this program, or in PATH)")
    made.add_argument("--skip-bids-validation", "--skip_bids_validator", action="store_true",
                      help="does nothing: lumen-bids reads the names that it needs, and no more")
    return made


def without_prefix(labels, prefix):
    return [label.removeprefix(prefix) for label in labels]


def run(options):
    root, out = pathlib.Path(options.bids_dir), pathlib.Path(options.out)
    labels = [pathlib.Path(folder) for folder in options.labels]
    volumes = find_volumes(root, options.suffix, without_prefix(options.participant_label, "sub-"),
                           without_prefix(options.session_label, "ses-"), labels)
    if out.resolve() == root.resolve():
        raise Fault(f"{out}: is the data set itself, expected another folder", USAGE)
    group.read_statements(options.statements)
    if options.level == "list":
        return group.write_volume_list(volumes, out, options)
    stated = [pathlib.Path(file).parent for file in (options.config, options.statements) if file]
    program = Program(options.lumen, options.threads, [root, out, *labels, *stated])
    describe_dataset(out, root, program.version)
    level = participant if options.level == "participant" else group
    return level.run(volumes, out, options, program)


def main():
    options = parser().parse_args()
    try:
        return run(options)
    except Fault as error:
        print(f"lumen-bids: error: {error}", file=sys.stderr)
        return error.code
    except KeyboardInterrupt:
        print("lumen-bids: interrupted", file=sys.stderr)
        return 130
