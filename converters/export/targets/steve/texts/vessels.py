# The vessels of a case as a vessel tree of stEVE: mm, patient coordinates, LPS, not turned.
import os

HERE = os.path.dirname(os.path.abspath(__file__))
MESH = os.path.join(HERE, "vessel.obj")

# mm, and a unit vector into the vessels
INSERTION_POSITION = {position}
INSERTION_DIRECTION = {direction}

# of each branch its name, and x, y, z and radius of its points, mm
BRANCHES = [
{branches}
]

# the system of vessels of each branch, such as "artery"; empty if the case states none
SYSTEMS = {
{systems}
}


def make_vessel_tree():
    """A FromMesh of stEVE with the radii of the case."""
    import numpy as np
    from eve.intervention.vesseltree import FromMesh
    from eve.intervention.vesseltree.util.branch import BranchWithRadii

    branches = []
    for name, points in BRANCHES:
        values = np.array(points, dtype=np.float32)
        branches.append(BranchWithRadii(name, values[:, :3], values[:, 3]))
    # without a rotation stEVE does not take one: [0, 0, 0] is none
    return FromMesh(MESH, INSERTION_POSITION, INSERTION_DIRECTION, branch_list=branches,
                    rotation_yzx_deg=[0.0, 0.0, 0.0])
