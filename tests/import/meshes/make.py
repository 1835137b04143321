"""Writes the meshes of this folder with gmsh 4.15.2 and meshio 5.3.5 from PyPI: python make.py"""

import gmsh
import meshio
import numpy


def portal():
    """Two columns, a runway of two spans on them, one brace: physical names on curves and points."""
    gmsh.model.add("portal")
    geo = gmsh.model.geo
    feet = [geo.addPoint(x, 0, 0) for x in (0, 6000, 12000)]
    tops = [geo.addPoint(x, 0, 4000) for x in (0, 6000, 12000)]
    columns = [geo.addLine(foot, top) for foot, top in zip(feet, tops)]
    girder = [geo.addLine(tops[0], tops[1]), geo.addLine(tops[1], tops[2])]
    brace = geo.addLine(feet[0], tops[1])
    geo.synchronize()
    for curve in columns:
        gmsh.model.mesh.setTransfiniteCurve(curve, 3)
    for curve in girder:
        gmsh.model.mesh.setTransfiniteCurve(curve, 5)
    gmsh.model.mesh.setTransfiniteCurve(brace, 2)
    gmsh.model.addPhysicalGroup(1, columns, name="column")
    gmsh.model.addPhysicalGroup(1, girder, name="runway girder")
    gmsh.model.addPhysicalGroup(1, [brace], name="brace")
    gmsh.model.addPhysicalGroup(0, feet, name="support feet")
    gmsh.model.addPhysicalGroup(0, [tops[1]], name="middle")


def plate():
    """A girder along one edge of a plate: triangles are left out."""
    gmsh.model.add("plate")
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (4, 0), (4, 1), (0, 1))]
    lines = [geo.addLine(points[k], points[(k + 1) % 4]) for k in range(4)]
    geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(1, lines[:1], name="girder")
    gmsh.model.addPhysicalGroup(2, [1], name="plate")
    gmsh.model.addPhysicalGroup(0, points[:1], name="left")
    gmsh.model.addPhysicalGroup(0, points[1:2], name="right")


def write(name, dimension, order=1, version=4.1, binary=0, save_all=0):
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1 if name.startswith("plate") else 1e5)
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.setOrder(order)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.option.setNumber("Mesh.SaveAll", save_all)
    gmsh.write(name)


gmsh.initialize(["-v", "2"])
portal()
write("portal.msh", 1)
write("portal_all.msh", 1, save_all=1)
write("portal_22.msh", 1, version=2.2)
write("portal_40.msh", 1, version=4.0)
write("portal_binary.msh", 1, binary=1)
write("portal_22_binary.msh", 1, version=2.2, binary=1)
write("portal_order_2.msh", 1, order=2)
gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
gmsh.model.mesh.setOrder(1)
gmsh.write("gmsh.inp")
mesh = meshio.read("portal.msh")
lines = numpy.vstack([block.data for block in mesh.cells if block.type == "line"])
mesh = meshio.Mesh(mesh.points, [("line", lines)])
mesh.point_sets = {"feet": [0, 1, 2]}
mesh.cell_sets = {"girder": [list(range(6, 14))], "column": [list(range(6))], "brace": [[14]]}
mesh.write("meshio.inp")
gmsh.clear()
plate()
write("plate.msh", 2)
gmsh.finalize()
