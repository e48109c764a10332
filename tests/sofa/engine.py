# SPDX-License-Identifier: Apache-2.0
"""Runs scenes in an installed SOFA without a window, and measures what an instrument did in them."""
import os, pathlib, re, subprocess, xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLUGINS = ["BeamAdapter", "SofaImplicitField", "SofaDistanceGrid"]


def find_sofa(given=None):
    """The folder of an installed SOFA: as given, LUMEN_SOFA, or beside the repository; None if there is none."""
    for place in (given, os.environ.get("LUMEN_SOFA"), ROOT.parent / "shared/sofa/v25.06"):
        if place and (pathlib.Path(place) / "bin").is_dir() and (pathlib.Path(place) / "plugins/BeamAdapter").is_dir():
            return pathlib.Path(place).resolve()
    return None


def usable(sofa, folder):
    """`sofa` itself, or, if it was copied without its symbolic links, a tree of links to it in `folder`."""
    if os.access(sofa / "bin/runSofa", os.X_OK): return sofa
    subprocess.run([ROOT / "converters/export/sofa_plugin/link_sofa.sh", sofa, folder], check=True)
    return pathlib.Path(folder)


def run(sofa, scene, steps, plugins=(), timeout=3600):
    """The lines that SOFA prints for N steps of a scene, and its steps per second."""
    names = [n for n in PLUGINS if (sofa / "plugins" / n).is_dir()]
    libraries = [sofa / "lib"] + [sofa / "plugins" / n / "lib" for n in names + ["SceneChecking"]]
    environment = dict(os.environ, LD_LIBRARY_PATH=":".join(map(str, libraries)))
    command = [str(sofa / "bin/runSofa"), "-g", "batch", "-n", str(steps)]
    for name in names: command += ["-l", str(sofa / "plugins" / name / "lib" / f"lib{name}.so")]
    for plugin in plugins: command += ["-l", str(plugin)]
    done = subprocess.run(command + [scene.name], cwd=scene.parent, env=environment, capture_output=True, timeout=timeout)
    text = (done.stdout + done.stderr).decode(errors="replace")
    lines = [line for line in re.split(r"[\r\n]+", text) if line.strip() and not re.search(r"#.*\]\s*\d+/\d+", line)]
    rate = re.search(r"\(\s*([\d.]+) FPS\)", text)
    if done.returncode != 0: lines.append(f"[ERROR] runSofa ended with {done.returncode}")
    return lines, float(rate[1]) if rate else None


def faults(lines):
    """The warnings of SOFA about components and data that are wrong."""
    return [line for line in lines if "[ERROR]" in line or "[WARNING]" in line or "[FATAL]" in line]


def positions(file):
    """The times, s, and for each the (n, 3) positions, mm, that a WriteState recorded."""
    import numpy as np
    times, points = [], []
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["T="]: times.append(float(words[1]))
        elif words[:1] == ["X="]: points.append(np.array(words[1:], float).reshape(-1, 3))
    return times[:len(points)], points


class Tools:
    """The instruments of a scene: their radii, mm, from the outermost, and how far each is in after a time."""

    def __init__(self, scene):
        root = xml.etree.ElementTree.parse(scene).getroot()
        node = lambda name: next(n for n in root.iter("Node") if n.get("name") == name)
        control = next(root.iter("InterventionalRadiologyController"))
        script = next(root.iter("BeamAdapterActionController"))
        names = [word.removeprefix("interpolation_") for word in control.get("instruments").split()]
        self.radii = [max(float(rod.get("radius")) for rod in node(f"rest_{name}") if rod.get("radius")) for name in names]
        self.start, self.step = int(control.get("controlledInstrument")), float(control.get("step"))
        self.script = list(zip(map(float, script.get("timeSteps").split()), map(int, script.get("actions").split())))

    def tips(self, time):
        """How far each instrument is in, mm."""
        tips, active = [0.0] * len(self.radii), self.start
        for when, action in self.script:
            if when >= time: break
            if action == 1: tips[active] += self.step
            elif action in (8, 9, 10): active = action - 8
        return tips

    def radius_at(self, behind, time):
        """The radius where the combination is, so far behind its tip."""
        import numpy as np
        tips = self.tips(time)
        result = np.zeros_like(behind)
        for tip, radius in zip(reversed(tips), reversed(self.radii)): result[behind >= max(tips) - tip] = radius
        return result


def depths(model, times, points, tools):
    """For each record the greatest depth of the instruments in the wall, mm; negative: they are clear. Between points,
    which are at most a beam apart, there are three more."""
    import numpy as np
    result = []
    for time, place in zip(times, points):
        between = [place[:-1] + share * np.diff(place, axis=0) for share in (0, 0.25, 0.5, 0.75)]
        samples = np.concatenate([np.stack(between, 1).reshape(-1, 3), place[-1:]])
        steps = np.linalg.norm(np.diff(samples, axis=0), axis=1)
        behind = np.concatenate([np.cumsum(steps[::-1])[::-1], [0]])
        distance = model.query(samples, model.cursor(samples)).distance
        result.append(float((distance + tools.radius_at(behind, time)).max()))
    return np.array(result)
