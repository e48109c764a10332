# SPDX-License-Identifier: Apache-2.0
"""Cases, meshes and measures as objects of networkx, VTK, PyVista and pandas, which are imported when asked for."""
from __future__ import annotations

import itertools
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np


class PolyData:
    """What VTK draws: a mixin of classes with ``_poly_data``, which returns points (n, 3), the kind of cells ("Polys"
    or "Lines"), the cells as lists of points, and the arrays of points and of cells by name."""

    def to_vtk(self):
        """A ``vtkPolyData``, mm, LPS: a copy."""
        from vtkmodules.util import numpy_support  # type: ignore
        from vtkmodules.vtkCommonCore import vtkPoints  # type: ignore
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData  # type: ignore
        points, kind, cells, of_points, of_cells = self._poly_data()
        data, places, lists = vtkPolyData(), vtkPoints(), vtkCellArray()
        places.SetData(numpy_support.numpy_to_vtk(points, deep=True))
        ends = np.cumsum([0, *map(len, cells)])
        corners = np.concatenate(cells) if len(cells) else np.empty(0)
        lists.SetData(*(numpy_support.numpy_to_vtkIdTypeArray(numbers.astype(np.int64), deep=True)
                        for numbers in (ends, corners)))
        data.SetPoints(places)
        getattr(data, f"Set{kind}")(lists)
        for arrays, owner in ((of_points, data.GetPointData()), (of_cells, data.GetCellData())):
            for name, values in arrays.items():
                array = numpy_support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
                array.SetName(name)
                owner.AddArray(array)
        return data

    def to_pyvista(self):
        """A ``pyvista.PolyData``, mm, LPS: ``case.mesh().to_pyvista().plot()``."""
        import pyvista  # type: ignore
        return pyvista.wrap(self.to_vtk())


def graph_of(case) -> Any:
    """The tree of a case as a networkx.DiGraph: see :meth:`lumen.Case.to_networkx`."""
    import networkx  # type: ignore
    tree = case.tree
    labels = [branch.label for branch in tree.branches]
    columns = {"centre": list(map(tuple, tree.centre.tolist())), "radius": tree.radius.tolist(),
               "branch": [labels[branch] for branch in tree.branch]}
    if tree.inlier_rate is not None:
        columns["inlier_rate"] = tree.inlier_rate.tolist()
    columns.update((name, values.tolist()) for name, values in case.node_arrays.items())
    graph = networkx.DiGraph(frame="LPS", units="mm")
    graph.add_nodes_from((node, dict(zip(columns, values))) for node, values in enumerate(zip(*columns.values())))
    joined = np.flatnonzero(tree.parent >= 0)
    for pairs, is_link in ((np.column_stack([tree.parent[joined], joined]), False), (tree.links.astype(int), True)):
        lengths = np.linalg.norm(np.diff(tree.centre[pairs], axis=1)[:, 0], axis=1)
        graph.add_edges_from((int(start), int(end), {"length": float(length), "link": is_link})
                             for (start, end), length in zip(pairs, lengths))
    return graph


def tables_of(answer: Dict[str, Any]) -> Dict[str, Any]:
    """The tables of a measurement: see :meth:`lumen.Answer.tables`."""
    import pandas  # type: ignore
    rows: Dict[str, List[Dict[str, Any]]] = {}
    cases = answer.get("cases", [])
    changes = [{"case": cases[0]["case"], **answer["changes"]}] if answer.get("changes") else []
    for part in [*cases, *changes]:
        for kind, facts in part.items():
            if isinstance(facts, list):
                rows.setdefault(kind, []).extend({"case": part["case"], **_row(one)} for one in facts)
    return {kind: pandas.DataFrame(some) for kind, some in rows.items()}


def _row(facts: Dict[str, Any]) -> Dict[str, Any]:
    """The cells of a row, in the columns that ``lumen measure --out`` writes."""
    row = dict(itertools.chain.from_iterable(_cells(name, value) for name, value in facts.items()))
    absent = [f"{name}: {value['absent']}" for name, value in facts.items()
              if isinstance(value, dict) and value["absent"]]
    row["absent"] = "; ".join(absent)
    return row


def _cells(name: str, value: Any) -> Iterator[Tuple[str, Any]]:
    if isinstance(value, dict):
        nothing = float("nan")
        yield name, nothing if value["value"] is None else value["value"]
        yield f"{name}_pm", nothing if value["plus_minus"] is None else value["plus_minus"]
    elif isinstance(value, list) or name.endswith("place_mm"):
        stem, unit = (name[:-3], "_mm") if name.endswith("_mm") else (name, "")
        stem = "" if stem == "place" else stem + "_"
        yield from ((f"{stem}{axis}{unit}", number) for axis, number in zip("xyz", value or [float("nan")] * 3))
    else:
        yield name, value
