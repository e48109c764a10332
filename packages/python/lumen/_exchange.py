# SPDX-License-Identifier: Apache-2.0
"""Cases, meshes and measures as objects of networkx, VTK, PyVista and pandas, which are imported when asked for."""
from __future__ import annotations

import itertools
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np


class PolyData:
    """Things that VTK draws: a mixin of classes with ``_poly_data``, which returns points (n, 3), the kind of cells ("Polys"
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


def graph_of(case, plain: bool) -> Any:
    """The tree of a case as a networkx.DiGraph: see :meth:`lumen.Case.to_networkx`."""
    import networkx  # type: ignore
    tree = case.tree
    labels = [branch.label for branch in tree.branches]
    columns: Dict[str, List[Any]] = {} if plain else {"centre": list(map(tuple, tree.centre.tolist()))}
    columns.update(zip("xyz", tree.centre.T.tolist()), radius=tree.radius.tolist(),
                   branch=[labels[branch] for branch in tree.branch])
    if tree.inlier_rate is not None:
        columns["inlier_rate"] = tree.inlier_rate.tolist()
    for name, values in case.node_arrays.items():
        if plain and values.ndim > 1:
            columns.update((f"{name}_{number}", some) for number, some in enumerate(values.T.tolist()))
        else:
            columns[name] = values.tolist()
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
    return {kind: pandas.DataFrame(some, columns=None if some else columns_of(kind)) for kind, some in rows.items()}


# Keys of the rows of a table, which is empty where a case has none: labels, places and values (spec/answers).
_COURSE = ("place_mm greatest_curvature_place_mm smallest_radius_place_mm",
           "length_mm chord_mm tortuosity sum_of_angles_rad_per_cm inflection_count_metric mean_curvature_per_mm "
           "greatest_curvature_per_mm turns_over_90_deg turning_deg_per_cm smallest_radius_mm mean_radius_mm volume_mm3 "
           "wall_area_mm2")
_KEYS = {
    "stations": ("vessel", "place_mm tangent", "along_mm curvature_per_mm torsion_per_mm inscribed_radius_mm area_mm2 "
                 "perimeter_mm smallest_diameter_mm largest_diameter_mm circularity taper_mm_per_mm"),
    "vessels": ("vessel", _COURSE[0], f"{_COURSE[1]} taper_mm_per_mm"),
    "paths": ("inlet end vessels", f"{_COURSE[0]} greatest_take_off_place_mm least_calibre_step_place_mm",
              f"{_COURSE[1]} forks greatest_take_off_deg least_calibre_step largest_catheter_fr"),
    "forks": ("parent larger smaller",
              "place_mm normal parent_vector_mm larger_vector_mm smaller_vector_mm",
              "angle_deg larger_take_off_deg smaller_take_off_deg larger_in_plane_deg smaller_in_plane_deg "
              "parent_out_of_plane_deg larger_out_of_plane_deg smaller_out_of_plane_deg larger_calibre_step "
              "smaller_calibre_step area_ratio murray_exponent asymmetry"),
    "narrowings": ("vessel finding", "place_mm",
                   "along_mm length_mm diameter_mm healthy_diameter_mm nascet_percent area_percent"),
    "sacs": ("aneurysm position", "place_mm normal tip_place_mm",
             "neck_diameter_mm neck_area_mm2 height_mm reach_mm width_mm dome_volume_mm3 dome_area_mm2 aspect_ratio "
             "size_ratio bottleneck_factor undulation_index ellipticity_index non_sphericity_index inflow_angle_deg"),
}


def columns_of(kind: str) -> List[str]:
    """The columns of a table without rows."""
    table = kind.replace("_changes", "s")
    if table not in _KEYS:
        return []
    labels, places, values = (words.split() for words in _KEYS[table])
    nothing = {"value": None, "plus_minus": None, "absent": "-"}
    facts: Dict[str, Any] = dict.fromkeys([*labels, *(["before"] if table != kind else [])])
    facts.update({name: [0, 0, 0] for name in places})
    facts.update({name: nothing for name in values})
    return ["case", *_row(facts)]


def _row(facts: Dict[str, Any]) -> Dict[str, Any]:
    """The cells of a row, in the columns that ``lumen measure --out`` writes."""
    row = dict(itertools.chain.from_iterable(_cells(name, value) for name, value in facts.items()))
    absent = [f"{name}: {_remark(value)}" for name, value in facts.items() if isinstance(value, dict) and _remark(value)]
    row["absent"] = "; ".join(absent)
    return row


def _remark(value: Dict[str, Any]) -> str:
    """Why a number is not there, or is a bound."""
    if value.get("at_most") is not None:
        return f"at most {value['at_most']:g}: the volume shows no less"
    return value["absent"] or ""


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
