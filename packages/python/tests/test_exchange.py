# SPDX-License-Identifier: Apache-2.0
"""Cases for networkx, VTK, PyVista and pandas: stand-ins, and the packages where they are installed."""
import csv
import importlib
import os
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy as np

import lumen
from fixture import sample
from lumen._exchange import columns_of


class Graph:
    """A stand-in of networkx.DiGraph."""

    def __init__(self, **facts):
        self.graph, self.nodes, self.edges = facts, {}, {}

    def add_nodes_from(self, nodes):
        self.nodes.update(nodes)

    def add_edges_from(self, edges):
        self.edges.update(((start, end), facts) for start, end, facts in edges)


def package(name):
    """A package, or the reason why it is missing."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"{name} is missing") from None


class GraphTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case

    def check(self, graph):
        tree = self.case.tree
        self.assertEqual(graph.graph, {"frame": "LPS", "units": "mm"})
        self.assertEqual(len(graph.nodes), len(tree))
        joined = np.flatnonzero(tree.parent >= 0)
        self.assertEqual(set(graph.edges), {(int(tree.parent[node]), int(node)) for node in joined})
        for node in (0, len(tree) - 1):
            facts = graph.nodes[node]
            np.testing.assert_array_equal(np.float32(facts["centre"]), tree.centre[node])
            np.testing.assert_array_equal([facts[axis] for axis in "xyz"], facts["centre"])
            self.assertEqual(np.float32(facts["radius"]), tree.radius[node])
            self.assertEqual(facts["branch"], tree.branches[tree.branch[node]].label)
            for name, values in self.case.node_arrays.items():
                self.assertEqual(facts[name], values[node])
        node = int(joined[-1])
        edge = graph.edges[int(tree.parent[node]), node]
        length = np.linalg.norm(tree.centre[node] - tree.centre[tree.parent[node]])
        self.assertAlmostEqual(edge["length"], length, places=5)
        self.assertFalse(edge["link"])

    def test_a_graph_has_the_nodes_and_edges_of_the_tree(self):
        with unittest.mock.patch.dict(sys.modules, {"networkx": types.SimpleNamespace(DiGraph=Graph)}):
            self.check(self.case.to_networkx())

    def check_plain(self, graph):
        plain = unittest.mock.Mock(tree=self.case.tree, node_arrays={"flow": np.ones((len(self.case.tree), 2), np.float32)})
        for facts in (graph.nodes[0], lumen._exchange.graph_of(plain, True).nodes[0]):
            self.assertNotIn("centre", facts)
            self.assertTrue(all(isinstance(value, (str, int, float)) for value in facts.values()))
        self.assertLessEqual({"x", "y", "z", "radius", "branch", "flow_0", "flow_1"}, set(facts))

    def test_a_plain_graph_has_numbers_and_texts(self):
        with unittest.mock.patch.dict(sys.modules, {"networkx": types.SimpleNamespace(DiGraph=Graph)}):
            self.check_plain(self.case.to_networkx(plain=True))

    def test_files_of_graphs(self):
        networkx = package("networkx")
        graph = self.case.to_networkx(plain=True)
        self.check_plain(graph)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.graphml")
            networkx.write_graphml(graph, path)
            again = networkx.read_graphml(path, node_type=int)
        self.assertEqual(again.nodes[3], graph.nodes[3])

    def test_networkx(self):
        networkx = package("networkx")
        graph = self.case.to_networkx()
        self.check(graph)
        roots = [node for node, degree in graph.in_degree() if degree == 0]
        self.assertEqual(roots, np.flatnonzero(self.case.tree.parent < 0).tolist())
        self.assertTrue(networkx.is_forest(graph))


class PolyDataTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case

    def test_a_surface_is_the_vertices_and_triangles_of_the_mesh(self):
        vertices, triangles = self.case.surface(edge="0.5r")
        mesh = self.case.mesh(edge="0.5r")
        np.testing.assert_array_equal(vertices, mesh.vertices)
        np.testing.assert_array_equal(triangles, mesh.triangles)
        self.assertEqual((vertices.dtype, triangles.dtype), (np.float32, np.int32))

    def test_lines_are_the_branches_from_their_parents_on(self):
        tree = self.case.tree
        points, kind, lines, of_points, _ = tree._poly_data()
        self.assertEqual(kind, "Lines")
        self.assertIs(points.base, tree.centre.base)
        np.testing.assert_array_equal(of_points["radius"], tree.radius)
        for line, branch in zip(lines, tree.branches):
            np.testing.assert_array_equal(tree.parent[line[1:]], line[:-1])
            self.assertEqual(line[-1], branch.first_node + branch.node_count - 1)
            self.assertEqual(line[0], branch.first_node if branch.parent_node < 0 else branch.parent_node)

    def check(self, surface, lines):
        mesh, tree = self.case.mesh(), self.case.tree
        self.assertEqual(surface.GetNumberOfPoints(), len(mesh.vertices))
        self.assertEqual(surface.GetNumberOfCells(), len(mesh.triangles))
        corners = [surface.GetCell(7).GetPointId(corner) for corner in range(3)]
        self.assertEqual(corners, mesh.triangles[7].tolist())
        np.testing.assert_array_equal(np.float32(surface.GetPoint(9)), mesh.vertices[9])
        np.testing.assert_array_equal(np.float32(surface.GetPointData().GetArray("normal").GetTuple(9)),
                                      mesh.attributes["normal"][9])
        self.assertEqual(surface.GetCellData().GetArray("group").GetValue(7), mesh.group[7])
        self.assertEqual(lines.GetNumberOfCells(), len(tree.branches))
        self.assertEqual(np.float32(lines.GetPointData().GetArray("radius").GetValue(5)), tree.radius[5])
        last = lines.GetCell(len(tree.branches) - 1)
        self.assertEqual(last.GetNumberOfPoints(), 1 + tree.branches[-1].node_count)

    def test_vtk(self):
        package("vtkmodules.util.numpy_support")
        self.check(self.case.mesh().to_vtk(), self.case.tree.to_vtk())

    def test_pyvista(self):
        pyvista = package("pyvista")
        surface = self.case.to_pyvista()
        self.assertIsInstance(surface, pyvista.PolyData)
        self.check(surface, self.case.tree.to_pyvista())
        self.assertTrue(surface.is_manifold)
        self.assertAlmostEqual(surface.volume, self.case.mesh().volume(), delta=1e-3 * surface.volume)


class TablesTest(unittest.TestCase):
    """Tables have the columns and cells of the files that the engine writes."""

    def rows_of(self, path):
        with open(path, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def check(self, rows_of_table):
        phantom = lumen.phantom("aneurysm")
        sac = lumen.convert(phantom.volume, seeds=phantom.seeds, seeds_only=True)
        for case, against in ((sample().case, sample().case), (sac, None)):
            with tempfile.TemporaryDirectory() as folder:
                answer = case.measure(out=os.path.join(folder, "out"), against=against)
                tables = answer.tables()
                for path in answer["files"]:
                    kind = os.path.splitext(os.path.basename(path))[0]
                    with self.subTest(kind=kind):
                        self.compare(rows_of_table(tables[kind]), self.rows_of(path))
                        with open(path, encoding="utf-8") as file:  # of a table that is empty, too
                            self.assertEqual(columns_of(kind), file.readline().rstrip("\n").split(","))
            self.assertGreater(len(rows_of_table(tables["stations"])), 10)

    def compare(self, ours, theirs):
        self.assertEqual(len(ours), len(theirs))
        for our, their in zip(ours, theirs):
            self.assertEqual(list(our), list(their))
            for name, text in their.items():
                value = our[name]
                if name == "case":
                    self.assertEqual(value, os.path.basename(text))
                elif isinstance(value, str):
                    self.assertEqual(value, text)
                elif text == "":
                    self.assertTrue(np.isnan(value), name)
                else:
                    self.assertAlmostEqual(float(value), float(text), delta=1e-5 * max(1, abs(float(text))))

    def test_tables_have_the_columns_of_files(self):
        with unittest.mock.patch.dict(sys.modules, {"pandas": types.SimpleNamespace(DataFrame=lambda rows, columns=None: list(rows))}):
            self.check(lambda table: table)

    def test_pandas(self):
        package("pandas")
        self.check(lambda table: table.to_dict("records"))
        empty = lumen.Answer(cases=[{"case": "a.lumen", "narrowings": []}]).tables()["narrowings"]
        self.assertEqual(list(empty.columns)[:4], ["case", "vessel", "finding", "x_mm"])
        self.assertEqual(len(empty), 0)


if __name__ == "__main__":
    unittest.main()
