# SPDX-License-Identifier: Apache-2.0
"""One vessel tree as voxels, lines and triangles, and files that state it in many ways: `Turned`."""
import dataclasses, itertools, math

# Straight vessels, mm LPS: start, end, radius. No axis, sign or order of axes leaves the fork as it is.
VESSELS = (((-21, 13, 42), (-19.5, 14, 49), 2.0), ((-19.5, 14, 49), (-15, 15, 55), 1.5), ((-19.5, 14, 49), (-21.5, 19, 54.5), 1.2))
LOW = (-24.0, 10.0, 40.0)  # the first voxel
AXIS_ALIGNED = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
# columns of a rotation by 20 degrees about z, then 15 about x
_C, _S, _D, _T = math.cos(math.radians(20)), math.sin(math.radians(20)), math.cos(math.radians(15)), math.sin(math.radians(15))
OBLIQUE = ((_C, _S * _D, _S * _T), (-_S, _C * _D, _C * _T), (0, -_T, _D))


@dataclasses.dataclass
class Turned:
    """A file that states a fact in its own way. `answer`: "same" as the original, without a word or with one; "warned", which
    need not be the same but holds `words`; or "refused" with `words`. `original` is
    what its case is compared with."""
    format: str
    fact: str
    files: dict  # contents by name; the first is the one to read
    answer: str = "same"
    words: str = ""
    options: tuple = ()
    original: "Turned" = None
    isTurned: bool = False  # its voxels lie in another order than the original's

    def title(self):
        return f"{self.format}: {self.fact}"


def is_inside(p):
    for a, b, radius in VESSELS:
        along = [b[i] - a[i] for i in range(3)]
        off = [p[i] - a[i] for i in range(3)]
        t = max(0.0, min(1.0, sum(x * y for x, y in zip(off, along)) / sum(x * x for x in along)))
        if sum((off[i] - t * along[i]) ** 2 for i in range(3)) <= radius * radius: return True
    return False


@dataclasses.dataclass
class Grid:
    """Voxels with their place, mm LPS: `axes` are unit vectors, the first index runs fastest."""
    size: tuple
    spacing: tuple
    axes: tuple
    origin: tuple
    values: list

    def turned(self, order, flips):
        """The same voxels at the same places; axis `a` is the axis `order[a]` of before, backwards if `flips[a]`."""
        size = tuple(self.size[o] for o in order)
        step = (1, self.size[0], self.size[0] * self.size[1])
        start, origin, axes = 0, list(self.origin), []
        for a, o in enumerate(order):
            sign = -1 if flips[a] else 1
            axes.append(tuple(sign * x for x in self.axes[o]))
            if not flips[a]: continue
            start += step[o] * (self.size[o] - 1)
            for i in range(3): origin[i] += self.axes[o][i] * self.spacing[o] * (self.size[o] - 1)
        walk = [step[o] * (-1 if flips[a] else 1) for a, o in enumerate(order)]
        values = [self.values[start + i * walk[0] + j * walk[1] + k * walk[2]]
                  for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
        return Grid(size, tuple(self.spacing[o] for o in order), tuple(axes), tuple(origin), values)

    def ras(self):
        """Axes and origin with x and y negated."""
        return [(-a[0], -a[1], a[2]) for a in self.axes], (-self.origin[0], -self.origin[1], self.origin[2])


def grid(axes=AXIS_ALIGNED, size=(28, 26, 36), spacing=(0.45, 0.5, 0.55), low=LOW):
    places = ([low[r] + sum(n * s * a[r] for n, s, a in zip(index[::-1], spacing, axes)) for r in range(3)]
              for index in itertools.product(*map(range, size[::-1])))
    return Grid(size, spacing, axes, tuple(low), [int(is_inside(p)) for p in places])


def grids():
    """Two lattices, by the name of their original."""
    return {"aligned": grid(), "oblique": grid(OBLIQUE, (34, 34, 42), (0.5, 0.45, 0.5), (-22.1, 8.2, 37.2))}


def turns():
    """The 48 ways in which three axes may run."""
    return list(itertools.product(itertools.permutations(range(3)), itertools.product((False, True), repeat=3)))


def turn_name(turn):
    return "axes " + "".join("-+"[not flip] + "ijk"[o] for o, flip in zip(*turn))


def samples():
    """The vessels as lists of places with radii, 0.5 mm apart at most; each vessel begins at its parent's end."""
    lines = []
    for a, b, radius in VESSELS:
        n = math.ceil(math.dist(a, b) / 0.5)
        lines.append([(*(a[i] + (b[i] - a[i]) * k / n for i in range(3)), radius) for k in range(n + 1)])
    return lines
