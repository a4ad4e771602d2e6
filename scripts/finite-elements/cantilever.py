#!/usr/bin/env python3
"""Writes a cantilever of CalculiX solid elements (C3D8I), 560 x 40 x 4 mm, clamped at x = 0.

    cantilever.py FOLDER [--elements NX NY NZ] [--response DASHPOTS.inp --frequencies F1 F2 N]

matrices.inp     ccx writes matrices.sti, matrices.mas and matrices.dof from it (SOLVER=MATRIXSTORAGE)
response.inp     with --response: steady-state response to 1 N in z at the middle of the free end, with the dashpots of
                 a file that `dashpot export --to calculix` wrote

Needs nothing but Python; run `ccx -i matrices` in the folder.
"""
import argparse
from pathlib import Path

LENGTH, BREADTH, DEPTH = 0.56, 0.04, 0.004


def node(i, j, k, size):
    """Number of the node at (i, j, k) of the grid."""
    return 1 + k + (size[2] + 1) * (j + (size[1] + 1) * i)


def model(size):
    nx, ny, nz = size
    lines = ["*NODE, NSET=NALL"]
    for i in range(nx + 1):
        for j in range(ny + 1):
            for k in range(nz + 1):
                x, y, z = LENGTH * i / nx, BREADTH * (j / ny - 0.5), DEPTH * (k / nz - 0.5)
                lines.append(f"{node(i, j, k, size)}, {x:.12g}, {y:.12g}, {z:.12g}")
    lines.append("*ELEMENT, TYPE=C3D8I, ELSET=EALL")
    element = 0
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                element += 1
                low = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                corners = [node(a, b, c, size) for c in (k, k + 1) for a, b in low]
                lines.append(f"{element}, " + ", ".join(map(str, corners)))
    lines += ["*MATERIAL, NAME=ALUMINIUM", "*ELASTIC", "69e9, 0.33", "*DENSITY", "2700.",
              "*SOLID SECTION, ELSET=EALL, MATERIAL=ALUMINIUM", "*NSET, NSET=CLAMPED"]
    lines += [str(node(0, j, k, size)) for j in range(ny + 1) for k in range(nz + 1)]
    lines += ["*BOUNDARY", "CLAMPED, 1, 3"]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--elements", type=int, nargs=3, default=[120, 8, 2])
    parser.add_argument("--response", help="file of dashpots")
    parser.add_argument("--frequencies", type=float, nargs=3, default=[5.0, 200.0, 40])
    arguments = parser.parse_args()
    size = arguments.elements
    arguments.folder.mkdir(parents=True, exist_ok=True)
    tip = node(size[0], size[1] // 2, size[2] // 2, size)
    lines = model(size)
    if arguments.response is None:
        steps = ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "10", "*END STEP"]
        name = "matrices.inp"
    else:
        first, last, count = arguments.frequencies
        steps = [f"*INCLUDE, INPUT={arguments.response}", "*STEP", "*FREQUENCY, STORAGE=YES", "30", "*END STEP",
                 "*STEP", "*STEADY STATE DYNAMICS", f"{first}, {last}, {int(count)}, 1.", "*CLOAD", f"{tip}, 3, 1.",
                 "*NSET, NSET=TIP", str(tip), "*NODE FILE, NSET=TIP", "PU", "*NODE PRINT, NSET=TIP", "U", "*END STEP"]
        name = "response.inp"
    (arguments.folder / name).write_text("\n".join(lines + steps) + "\n")
    print(f"{arguments.folder / name}: {(size[0] + 1) * (size[1] + 1) * (size[2] + 1)} nodes, tip node {tip}")


if __name__ == "__main__":
    main()
