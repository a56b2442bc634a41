"""Reads what an .xdmf file of a run describes, with the files of HDF5 beside it, without VTK."""

import dataclasses
import xml.etree.ElementTree

import h5py
import numpy as np

CORNERS = {"Hexahedron": 8, "Quadrilateral": 4}


@dataclasses.dataclass
class Grid:
    """Points n x 3, cells m x 8 or m x 4, fields on points and on cells; the time at which a list shows them."""

    title: str
    time: float
    points: np.ndarray
    cells: np.ndarray
    fields: dict
    cell_fields: dict


def grids(path):
    """Of a list all, of a single mode the one that it has."""
    root = xml.etree.ElementTree.parse(path).find("Domain/Grid")
    return [grid_of(grid, path) for grid in (root.findall("Grid") if root.get("CollectionType") == "Temporal" else [root])]


def grid_of(element, path):
    topology = element.find("Topology")
    cells = values_of(topology.find("DataItem"), path)
    if cells.shape != (int(topology.get("NumberOfElements")), CORNERS[topology.get("TopologyType")]):
        raise ValueError(f"cells of the shape {cells.shape} in {path}")
    time = element.find("Time")
    grid = Grid(element.get("Name"), float("nan") if time is None else float(time.get("Value")),
                values_of(element.find("Geometry/DataItem"), path), cells, {}, {})
    for attribute in element.findall("Attribute"):
        values = values_of(attribute.find("DataItem"), path)
        if (values.ndim == 2 and values.shape[1] == 3) != (attribute.get("AttributeType") == "Vector"):
            raise ValueError(f"{attribute.get('Name')} has the shape {values.shape} in {path}")
        {"Node": grid.fields, "Cell": grid.cell_fields}[attribute.get("Center")][attribute.get("Name")] = values
    return grid


def values_of(item, path):
    """Values of a DataItem, of the type and with the dimensions that it says."""
    name, dataset = item.text.split(":/")
    with h5py.File(path.parent / name) as file:
        values = file[dataset][()]
    wanted = {"Float": np.float32, "Int": np.int32}[item.get("NumberType")]
    if values.dtype != wanted or item.get("Precision") != "4" or values.shape != tuple(map(int, item.get("Dimensions").split())):
        raise ValueError(f"{item.text} is {values.dtype} {values.shape}, described otherwise in {path}")
    return values
