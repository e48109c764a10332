# SPDX-License-Identifier: Apache-2.0
"""Corrections of a case by hand."""
from __future__ import annotations

from . import _lumen
from ._calls import called, watch_of
from ._errors import ValueFault
from ._parts import Change


class Editor:
    """Corrections of a case. Each returns a new case and leaves the old one as it is.

    A branch is its label or its index, a node its index. Models that are out of date are fitted
    again, unless ``refit=False`` leaves that to a later :meth:`refit`; ``new.change`` states what
    happened. Raises lumen.Error for what a correction does not allow.
    """

    def __init__(self, case):
        self._case = case

    def delete(self, branch, *, children: bool = False, refit: bool = True, progress=None):
        """Deletes a branch; with ``children`` all that hangs on it, too, which else becomes trees
        of its own."""
        return self._edited(_lumen.edit_delete, (self._branch(branch), children), refit, progress)

    def cut(self, node: int, *, keep_joined: bool = False, label: str = "", refit: bool = True,
            progress=None):
        """Ends a branch before a node. The rest becomes a branch ``label`` of a tree of its own, or,
        with ``keep_joined``, a child in the same lumen."""
        return self._edited(_lumen.edit_cut, (self._node(node), keep_joined, label), refit, progress)

    def join(self, branch, node: int, *, refit: bool = True, progress=None):
        """Joins a branch by its first node to a node of another one."""
        return self._edited(_lumen.edit_join, (self._branch(branch), self._node(node)), refit,
                            progress)

    def merge(self, branch, *, refit: bool = True, progress=None):
        """Appends a branch to the one whose last node it is joined to."""
        return self._edited(_lumen.edit_merge, (self._branch(branch),), refit, progress)

    def reverse(self, branch, *, refit: bool = True, progress=None):
        """Makes the last node of a branch its first; the branch becomes a tree of its own."""
        return self._edited(_lumen.edit_reverse, (self._branch(branch),), refit, progress)

    def root(self, branch, *, refit: bool = True, progress=None):
        """Makes the last node of a branch the root of its tree."""
        return self._edited(_lumen.edit_root, (self._branch(branch),), refit, progress)

    def kind(self, branch, kind: str, *, refit: bool = True, progress=None):
        """Makes a branch a "vessel" or an "aneurysm"."""
        return self._edited(_lumen.edit_kind, (self._branch(branch), kind), refit, progress)

    def rename(self, branch, label: str, *, refit: bool = True, progress=None):
        """Gives a branch another label, which no other branch has."""
        return self._edited(_lumen.edit_rename, (self._branch(branch), label), refit, progress)

    def move(self, node: int, position, radius: float, *, refit: bool = True, progress=None):
        """Moves a node to a position (3,), mm, LPS, and sets the radius there, mm."""
        return self._edited(_lumen.edit_move, (self._node(node), _three(position), radius), refit,
                            progress)

    def widen(self, node: int, radius: float, reach: float, *, refit: bool = True,
              progress=None):
        """Gives a vessel another radius at a node, mm, and less and less up to ``reach`` mm along
        it."""
        return self._edited(_lumen.edit_widen, (self._node(node), radius, reach), refit, progress)

    def push(self, node: int, at, by, radius: float, *, refit: bool = True, progress=None):
        """Pushes the wall near a node: points within ``radius`` mm of ``at`` (3,), mm, LPS, move by
        ``by`` (3,), mm, and less and less towards the rim."""
        arguments = (self._node(node), _three(at), _three(by), radius)
        return self._edited(_lumen.edit_push, arguments, refit, progress)

    def add_node(self, node: int, *, refit: bool = True, progress=None):
        """Puts a node halfway between a node and the next one of its branch."""
        return self._edited(_lumen.edit_add_node, (self._node(node),), refit, progress)

    def delete_node(self, node: int, *, refit: bool = True, progress=None):
        """Deletes a node; its neighbours take its wall points."""
        return self._edited(_lumen.edit_delete_node, (self._node(node),), refit, progress)

    def refit(self, nodes, *, progress=None, threads=None):
        """Fits the models of some nodes again, such as ``new.change.stale``, with the options of
        the case's last fit."""
        core = self._case._core  # pylint: disable=protected-access
        nodes = [int(node) for node in nodes]
        progress, threads, _ = watch_of({"progress": progress, "threads": threads})
        new = called(_lumen.refit, core, nodes, progress, threads)
        return type(self._case)(new, self._case.change)

    def _edited(self, function, arguments, refit, progress):
        core = self._case._core  # pylint: disable=protected-access
        progress, *_ = watch_of({"progress": progress})
        new, change = called(function, core, *arguments)
        change = Change(*change)
        if refit and len(change.stale) > 0:
            new = called(_lumen.refit, new, change.stale.tolist(), progress, 0)
        return type(self._case)(new, change)

    def _branch(self, branch) -> int:
        return self._case.branch(branch)

    def _node(self, node) -> int:
        return range(len(self._case.tree))[node]


def _three(position):
    numbers = [float(number) for number in position]
    if len(numbers) != 3:
        raise ValueFault(f"found {len(numbers)} coordinates, expected 3")
    return numbers
