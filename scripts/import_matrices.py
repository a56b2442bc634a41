#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Converts matrices of another program to a system that squeal and its Python module can read.

    scripts/import_matrices.py CONFIG.yaml --output FOLDER

CONFIG (YAML or JSON) specifies the power of lambda and the coefficient of each matrix:

    description: brake on two springs
    parameters:
      omega: {value: 4*_pi, lower: 2*_pi, upper: 8*_pi, unit: rad/s}
    terms:
      - {name: mass, power: 2, file: matrices.mat, variable: M, symmetry: symmetric}
      - {name: gyroscopic forces, power: 1, coefficient: omega, file: matrices.mat, variable: G, symmetry: skew, kind: rotation}
      - {name: stiffness, power: 0, file: stiffness.npz, symmetry: symmetric, scale: 1000}
    groups: {disc: [[1, 300]], pads: [[301, 400]]}

File names are relative to CONFIG. The format follows from the suffix or from `format`: .mat of MATLAB (version 7.3 with
python3-h5py), .npy and .npz, Matrix Market and the text of Abaqus' *MATRIX GENERATE (.mtx: node, dof, node, dof, value
or row, column, value), DMIG of Nastran (.bdf, .pch), OUTPUT4 (.op4, with pyNastran), Harwell-Boeing (.hb, .rua, .rsa).
One triangle of a symmetric matrix, as written by Abaqus and Nastran, is sufficient. Matrices with nodes and dofs are
sorted by node and dof; FOLDER/rows.csv lists the rows, and a group may be {nodes: [[5001, 6000]]}. Dofs that Abaqus
fixes by 1e36 on the diagonal are omitted. `nodes: model.inp` (or .bdf) with `unit: mm` adds the nodes as points with
the displacements of dofs 1 to 3. `coefficient` is an expression in the parameters with + - * / ^, sin, cos, tan, exp,
log, sqrt, abs and _pi. Requires python3-yaml.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.importing.system_import import import_system, write_labels


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("config", metavar="CONFIG", help="YAML or JSON")
    parser.add_argument("--output", metavar="FOLDER", required=True, type=pathlib.Path, help="folder for system.json and its matrices")
    arguments = parser.parse_args()
    system, remarks, numbering = import_system(arguments.config)
    system.write(arguments.output)
    if numbering.labels is not None:
        write_labels(arguments.output / "rows.csv", numbering.labels)
    print(f"{arguments.config}: {system.size} dofs, {len(system.terms)} terms")
    for term in system.terms:
        print(f"  {term.name}: lambda^{term.power}, {term.coefficient}, {term.matrix.nnz} entries, "
              f"largest {abs(term.matrix).max():.3g}, {term.symmetry}")
    print(*(f"  note: {remark}" for remark in remarks), f"written: {arguments.output / 'system.json'}", sep="\n")


if __name__ == "__main__":
    main()
