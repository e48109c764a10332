# SPDX-License-Identifier: Apache-2.0
"""The expected answers, from the definitions of ../lumen.md: exact fractions throughout, but for square roots and exp, which
have 60 digits. Rotations between two times are found by halving arcs, so questions there are at shares k / 2^n. Gradients are differentiated along with the values, so no formula of a gradient is used."""
import copy, decimal, itertools
from fractions import Fraction

UNDECIDED = Fraction(1, 10 ** 6)  # what a question or a pair of nodes must not depend on, in shares of what is compared
CLOSE = Fraction(3, 10 ** 5)      # of T: the least distance of a value from it


class Undecided(Exception):
    """Rounding would decide an answer."""


def in_60_digits(function, x):
    with decimal.localcontext() as context:
        context.prec = 60
        return Fraction(function(decimal.Decimal(x.numerator) / decimal.Decimal(x.denominator)))


def root(x):
    return in_60_digits(decimal.Decimal.sqrt, x)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def scaled(s, a):
    return [s * x for x in a]


class Jet:
    """A number and its derivatives by the three coordinates of the point."""

    def __init__(self, value, slope=(0, 0, 0)):
        self.value, self.slope = Fraction(value), [Fraction(s) for s in slope]

    @staticmethod
    def of(x):
        return x if isinstance(x, Jet) else Jet(x)

    def __add__(self, other):
        other = Jet.of(other)
        return Jet(self.value + other.value, [a + b for a, b in zip(self.slope, other.slope)])

    def __mul__(self, other):
        other = Jet.of(other)
        return Jet(self.value * other.value, [a * other.value + self.value * b for a, b in zip(self.slope, other.slope)])

    def __truediv__(self, other):
        other = Jet.of(other)
        quotient = self.value / other.value
        return Jet(quotient, [(a - quotient * b) / other.value for a, b in zip(self.slope, other.slope)])

    def __sub__(self, other): return self + Jet.of(other) * -1
    def __rsub__(self, other): return Jet.of(other) - self
    def __rtruediv__(self, other): return Jet.of(other) / self
    __radd__, __rmul__ = __add__, __mul__


def exponential(x):
    e = in_60_digits(decimal.Decimal.exp, x.value)
    return Jet(e, scaled(e, x.slope))


def phi(kernel, parameter, x):
    if kernel == "cauchy":
        q = 1 + parameter * x
        return 1 / (q * q)
    if kernel == "gaussian": return exponential(-parameter * x)
    if x.value >= 1: return Jet(0)
    if kernel == "quartic": return (1 - x) * (1 - x)
    return 1 - Fraction(4, 9) * x * x * x + Fraction(17, 9) * x * x - Fraction(22, 9) * x


def psi(t):
    if t.value <= -1: return Jet(0)
    if t.value >= 1: return Jet(1)
    s = (1 + t) / 2
    return s * s * s * (6 * s * s - 15 * s + 10)


def unit(q):
    length = root(sum(x * x for x in q))
    return [x / length for x in q]


def half_way(p, q):
    """The middle of the shorter arc between two unit quaternions."""
    if dot(p, q) < 0: q = scaled(-1, q)
    return unit([a + b for a, b in zip(p, q)])


def arc(p, q, share):
    """The unit quaternion at a share of the shorter arc."""
    p, q = unit(p), unit(q)
    for _ in range(12):
        if share == 0: return p
        if share == 1: return q
        middle, first = half_way(p, q), share < Fraction(1, 2)
        p, q, share = (p, middle, 2 * share) if first else (middle, q, 2 * share - 1)
    raise Undecided("the share of the time between two poses is not k / 2^n")


def matrix(q):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


class Motion:
    def __init__(self, values):
        self.__dict__.update(values)

    def instant(self, time):
        """The times around one, and the share of the way between them."""
        first, last, end = self.time[0], self.time[-1], len(self.time) - 1
        if self.period:
            time = first + (time - first) % self.period
            if time >= last: return end, 0, (time - last) / (first + self.period - last)
        if time <= first: return 0, 0, Fraction(0)
        if time >= last: return end, end, Fraction(0)
        i = max(i for i, t in enumerate(self.time) if t <= time)
        return i, i + 1, (time - self.time[i]) / (self.time[i + 1] - self.time[i])

    def poses(self, time):
        """Centre, matrix and factor by moving node."""
        i, k, u = self.instant(time)
        def between(a, b): return (1 - u) * a + u * b
        return {node: ([between(a, b) for a, b in zip(self.centre[i][n], self.centre[k][n])],
                       matrix(arc(self.rotation[i][n], self.rotation[k][n], u)), between(self.factor[i][n], self.factor[k][n]))
                for n, node in enumerate(self.node)}


class Answers:
    """A case, all of whose numbers are fractions: centre, radius, parent, links; models and a motion, or None."""

    def __init__(self, tree, models, motion=None):
        self.rest, self.poses, self.motion = tree["centre"], {}, motion and Motion(motion)
        self.centre, self.radius, self.models = tree["centre"], tree["radius"], models
        self.nodes = range(len(self.radius))
        pairs = [(i, p) for i, p in enumerate(tree["parent"]) if p >= 0] + tree["links"]
        self.edges = [{b if a == i else a for a, b in pairs if i in (a, b)} for i in self.nodes]
        self.longest = self.spacings()
        self.ways = [self.ways_from(i) for i in self.nodes]
        self.near = [set() for _ in self.nodes]
        for i in self.nodes:
            for k, way in self.ways[i].items():
                if k != i and self.are_neighbours(way):
                    self.near[i].add(k)
                    self.near[k].add(i)

    def spacings(self):
        return [max((self.square(i, j) for j in self.edges[i]), default=0) for i in self.nodes]

    def at(self, time):
        """The posed case: its neighbours are those at rest."""
        out = copy.copy(self)
        out.poses = self.motion.poses(Fraction(float(time)))
        out.centre = [out.poses[i][0] if i in out.poses else self.centre[i] for i in self.nodes]
        out.radius = [out.poses[i][2] * self.radius[i] if i in out.poses else self.radius[i] for i in self.nodes]
        out.longest = out.spacings()
        return out

    # the tree ----------------------------------------------------------------------------------------------------------

    def square(self, i, k):
        difference = minus(self.centre[i], self.centre[k])
        return dot(difference, difference)

    def length(self, way):
        return sum(root(self.square(a, b)) for a, b in zip(way, way[1:]))

    def ways_from(self, start):
        """The way to every node that the breadth-first search reaches, both ends included."""
        ways, queue = {start: [start]}, [start]
        for node in queue:
            way = ways[node]
            if len(way) > 2 and self.length(way) > 8 * self.radius[start]: continue
            for other in sorted(self.edges[node] - set(ways)):
                ways[other] = way + [other]
                queue.append(other)
        return ways

    def are_neighbours(self, way):
        if len(way) <= 3: return True
        strict, generous = (self.are_far_neighbours(way, sign * UNDECIDED) for sign in (-1, 1))
        if strict != generous: raise Undecided(f"neighbours {way[0]} and {way[-1]}")
        return strict

    def are_far_neighbours(self, way, slack):
        """Rule 3, by a share `slack` of each number more generous than the text."""
        i, k = way[0], way[-1]
        both, distance, length, more = self.radius[i] + self.radius[k], root(self.square(i, k)), self.length(way), 1 + slack
        if not (length <= 4 * both * more and (distance < both * more or length < 2 * distance * more)): return False
        return self.cells_meet(way, slack)

    def tau(self, i, k):
        square, least = self.square(i, k), min(self.radius[i], self.radius[k]) ** 2 / 1000
        if k in self.edges[i]: return max(least, square * 3 / 5)
        return max(least, min(square / 2, (self.longest[i] + self.longest[k]) * 3 / 10))

    def cells_meet(self, way, slack):
        i, k = way[0], way[-1]
        ri, rk, a, square = self.radius[i], self.radius[k], minus(self.centre[k], self.centre[i]), self.square(i, k)
        if square == 0: return ri == rk
        s, distance = (1 + (ri ** 2 - rk ** 2) / square) / 2, root(square)
        q = max((ri * 3 / 2) ** 2 - (s * distance) ** 2, (rk * 3 / 2) ** 2 - ((1 - s) * distance) ** 2) + slack * ri * rk
        if q <= 0: return False
        axis = min(range(3), key=lambda n: abs(a[n]))
        u = cross(a, [int(n == axis) for n in range(3)])
        u = scaled(root(q / dot(u, u)), u)
        v = scaled(1 / distance, cross(a, u))
        middle = [c + s * x for c, x in zip(self.centre[i], a)]
        # half-planes l + m x + n y >= 0 of the points M + x u + y v
        halves = [(1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1)]
        for m in way[1:-1]:
            to = minus(self.centre[m], self.centre[i])
            constant = (dot(self.centre[m], self.centre[m]) - dot(self.centre[i], self.centre[i]) - 2 * dot(to, middle)
                        - self.radius[m] ** 2 + ri ** 2 + max(self.tau(i, m), self.tau(k, m)) + slack * ri * rk)
            halves.append((constant, -2 * dot(to, u), -2 * dot(to, v)))
        return any(all(l + m * x + n * y >= 0 for l, m, n in halves) for x, y in corners(halves))

    # fields ------------------------------------------------------------------------------------------------------------

    def lender(self, node):
        """The node whose blobs are a node's local field, or None."""
        reached, ring = {node}, {node}
        while ring:
            with_blobs = [i for i in ring if self.models["offset"][i] < self.models["offset"][i + 1]]
            if with_blobs: return min(with_blobs)
            ring = set().union(*(self.edges[i] for i in ring)) - reached
            reached |= ring
        return None

    def local(self, node, point):
        m, total, lender = self.models, Jet(0), self.lender(node)
        if lender is None: return total
        if lender in self.poses:
            centre, turn, factor = self.poses[lender]
            moved = minus(point, centre)
            point = [self.rest[lender][i] + sum(turn[k][i] * moved[k] for k in range(3)) / factor for i in range(3)]
        for j in range(m["offset"][lender], m["offset"][lender + 1]):
            d, w = minus(point, m["centre"][j]), m["width"][j]
            total += w * phi(m["kernel"], m["kernelParameter"], dot(d, d) / (w * w))
        return total

    def power(self, node, point):
        d = minus(point, self.centre[node])
        return dot(d, d) - self.radius[node] ** 2

    def weight(self, node, power):
        product = Jet(1)
        for j in sorted(self.near[node]):
            product = product * psi((power[j] - power[node]) / self.tau(node, j))
            if product.value == 0: break
        return product

    def blended(self, node, point):
        power = [self.power(i, point) for i in self.nodes]
        active, weights, field = [node], Jet(0), Jet(0)
        for k in active:
            weight = self.weight(k, power)
            if weight.value == 0: continue
            weights, field = weights + weight, field + weight * self.local(k, point)
            active += sorted(j for j in self.near[k] - set(active) if (power[j] - power[k]).value < self.tau(k, j))
        return field / weights if weights.value else self.local(node, point)

    # answers -----------------------------------------------------------------------------------------------------------

    def least(self, nodes, power):
        """The node of least power, and of equal ones the first."""
        best = min(nodes, key=lambda i: (power[i], i))
        for i in nodes:
            if power[i] != power[best] and power[i] - power[best] < UNDECIDED * max(1, self.radius[i] ** 2):
                raise Undecided(f"powers of {i} and {best}")
        return best

    def follow(self, node, power):
        while power[best := self.least({node} | self.near[node], power)] < power[node]: node = best
        return node

    def shown(self, field):
        level = self.models["isoLevel"]
        if abs(field.value - level) < CLOSE * max(1, level): raise Undecided(f"inside at {float(field.value)}")
        return {"value": float(field.value), "gradient": [float(s) for s in field.slope], "inside": field.value > level}

    def answer(self, point, current=None, time=None):
        if time is not None: return self.at(time).answer(point, current)
        power = [self.power(i, point) for i in self.nodes]
        node = self.least(self.nodes, power) if current is None else self.follow(current, power)
        out = {"node": node, "power": float(power[node])}
        if not self.models: return out
        at = [Jet(x, [int(n == axis) for n in range(3)]) for axis, x in enumerate(point)]
        return {**out, **self.shown(self.local(node, at)), "blended": self.shown(self.blended(node, at))}


def corners(halves):
    """Where the borders of two half-planes cross."""
    for (l, m, n), (p, q, r) in itertools.combinations(halves, 2):
        if (det := m * r - n * q) != 0: yield (n * p - l * r) / det, (l * q - m * p) / det
