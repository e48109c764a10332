# SPDX-License-Identifier: Apache-2.0
"""Parts of lumen's modules for the command-line interface of 3D Slicer (the Execution Model).

A module is NAME.py with NAME.xml beside it. Arguments are read by that XML, so it is stated once which there are. The work is
done by the program lumen; its progress becomes <filter-progress> on standard output, its messages stay on standard error."""
import ctypes, os, pathlib, re, shutil, signal, subprocess, sys
import xml.etree.ElementTree as ElementTree

# Variables by which Slicer finds its own libraries. Another program would load them, too, and fail.
FOREIGN = ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PYTHONHOME", "PYTHONPATH", "QT_PLUGIN_PATH", "LD_PRELOAD")
PERCENT = re.compile(r"^([a-z][a-z ]*): (\d+) % ")
DONE = re.compile(r"^([a-z][a-z ]*): done in ")


class Failure(Exception):
    """A sentence for people; the module ends with exit code 1."""


class Parameter:
    def __init__(self, element):
        text = lambda tag: (element.findtext(tag) or "").strip()
        self.kind, self.name, self.default = element.tag, text("name"), text("default")
        self.flags = [flag for flag in ("-" + text("flag").lstrip("-"), "--" + text("longflag").lstrip("-")) if flag.strip("-")]
        self.index = int(text("index")) if text("index") else None
        self.is_list = element.get("multiple") == "true"

    def value(self, text):
        if self.kind == "boolean": return text in ("1", "true", True)
        if self.kind == "integer": return int(text)
        if self.kind in ("double", "float"): return float(text)
        return text

    def initial(self):
        if self.is_list: return []
        return self.value(self.default) if self.default != "" else (False if self.kind == "boolean" else None)


def parameters_of(xml):
    root = ElementTree.parse(xml).getroot()
    return [Parameter(element) for group in root.iter("parameters") for element in group if element.find("name") is not None]


def take(parameters, words):
    """The values of a command line by name. Slicer writes flags before values, and arguments of an index behind them."""
    by_flag = {flag: parameter for parameter in parameters for flag in parameter.flags}
    values, rest = {parameter.name: parameter.initial() for parameter in parameters}, []
    words = list(words)
    while words:
        word = words.pop(0)
        parameter = by_flag.get(word.split("=", 1)[0]) if word.startswith("-") else None
        if parameter is None:
            if word.startswith("--"): raise Failure(f"{word} is no parameter of this module")
            rest.append(word)
            continue
        if parameter.kind == "boolean" and "=" not in word:
            values[parameter.name] = True
            continue
        if "=" not in word and not words: raise Failure(f"{word} has no value")
        value = parameter.value(word.split("=", 1)[1] if "=" in word else words.pop(0))
        if parameter.is_list: values[parameter.name].append(value)
        else: values[parameter.name] = value
    indexed = sorted((p for p in parameters if p.index is not None), key=lambda p: p.index)
    if len(rest) != len(indexed): raise Failure(f"{len(indexed)} files are needed ({', '.join(p.name for p in indexed)}), {len(rest)} are given")
    for parameter, word in zip(indexed, rest): values[parameter.name] = parameter.value(word)
    return values


def program():
    """The program lumen: that of the environment variable LUMEN, or of the path."""
    found = os.environ.get("LUMEN") or shutil.which("lumen")
    for place in ("/usr/bin/lumen", "/usr/local/bin/lumen"):
        if not found and os.access(place, os.X_OK): found = place
    if not found: raise Failure("the program lumen is not installed; the environment variable LUMEN may state its place")
    return found


def clean_environment():
    return {name: value for name, value in os.environ.items() if name not in FOREIGN}


class Progress:
    """Shares of the stages of a run, as the Execution Model reads them."""

    def __init__(self, name, stages):
        self.name, self.stages, self.seen, self.share = name, stages, [], 0.0
        self.say(f"<filter-start><filter-name>{name}</filter-name><filter-comment>{name}</filter-comment></filter-start>")

    def say(self, text):
        print(text, flush=True)

    def hear(self, line):
        """Takes a line of lumen's; True if it is one of progress."""
        percent, done = PERCENT.match(line), DONE.match(line)
        stage = (percent or done)[1] if percent or done else None
        if stage is None: return False
        if stage not in self.seen: self.seen.append(stage)
        of_stage = int(percent[2]) / 100 if percent else 1.0
        self.share = max(self.share, min(1.0, (len(self.seen) - 1 + of_stage) / max(self.stages, len(self.seen))))
        self.say(f"<filter-comment>{stage}</filter-comment>")
        self.say(f"<filter-stage-progress>{of_stage:.3f}</filter-stage-progress>")
        self.say(f"<filter-progress>{self.share:.3f}</filter-progress>")
        return True

    def end(self):
        self.say("<filter-progress>1</filter-progress>")
        self.say(f"<filter-end><filter-name>{self.name}</filter-name></filter-end>")


def end_with_parent():
    """In the child: the kernel ends it when this module ends, also by the signal that no program sees (Slicer's Cancel)."""
    if sys.platform == "linux": ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG


def run(progress, *arguments):
    """Runs lumen. Ctrl-C and Slicer's Cancel end it, too. Raises Failure with lumen's last message."""
    words = [program(), *(str(word) for word in arguments if word is not None)]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=clean_environment(),
                          preexec_fn=end_with_parent if os.name == "posix" else None) as lumen:
        before = signal.signal(signal.SIGTERM, lambda *_: (lumen.terminate(), sys.exit(143)))
        last = ""
        try:
            for line in lumen.stderr:
                if progress.hear(line): continue
                sys.stderr.write(line)
                if line.strip(): last = line.strip()
        finally:
            signal.signal(signal.SIGTERM, before)
    if lumen.returncode != 0: raise Failure(last.removeprefix("lumen: error: ") or f"lumen ended with {lumen.returncode}")


def main(file, work, stages):
    """Runs `work(values, progress)` for the arguments of the process. `file`: the module's own; `stages`: of lumen's, about."""
    xml = pathlib.Path(file).with_suffix(".xml")
    words = sys.argv[1:]
    if words == ["--xml"]:
        sys.stdout.write(xml.read_text())
        return 0
    if words == ["--version"]:
        print(ElementTree.parse(xml).getroot().findtext("version"))
        return 0
    try:
        values = take(parameters_of(xml), words)
        progress = Progress(ElementTree.parse(xml).getroot().findtext("title"), stages)
        work(values, progress)
        progress.end()
        return 0
    except Failure as failure:
        print(f"{xml.stem}: {failure}", file=sys.stderr)
        return 1
    except ValueError as error:
        print(f"{xml.stem}: a number is wrong: {error}", file=sys.stderr)
        return 1
