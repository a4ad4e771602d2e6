#!/usr/bin/env python3
"""Checks our NASTRAN readers and writers against pyNastran, both ways.

    pip install pyNastran scipy
    pynastran_check.py PATH/TO/dashpot

1. pyNastran writes bulk data (GRID, CBAR, DMIG in small and large field) and ascii OUTPUT4 (dense, sparse, BIGMAT); each goes
   into a project and `dashpot simulate` must give the harmonics that the same matrices in Matrix Market give.
2. Binary OUTPUT4 of both byte orders is made here from its description; pyNastran must read it as it was meant, and then we.
3. `dashpot export --to nastran` is read by pyNastran: CDAMP2, and the DMIG equals the matrix of `--to json`.
4. At a grid point that moves askew (CD) a dashpot is a CBUSH in the basic system, and the DMIG turned by pyNastran's axes is it.
"""
import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from pyNastran.bdf.bdf import BDF
from pyNastran.op4.op4 import OP4, read_op4
from scipy.io import mmwrite
from scipy.sparse import coo_matrix

DASHPOT = Path(sys.argv[1]).resolve()
N = 6
K = np.diag([3e4, 2.5e4, 2e4, 2e4, 2e4, 1.1e4]) - np.diag([1e4] * 5, 1) - np.diag([1e4] * 5, -1)
M = np.diag([1.0, 1.5, 0.75, 1.25, 1.0, 0.5])
LABELS = [f"{11 + i}z" for i in range(N)]


def project(structure):
    return f"""[project]
format = 1
[structure]
kind = "matrices"
{structure}
[[source]]
law = "viscous"
dofs = ["12z"]
state = "known"
c = 2.0
[[source]]
law = "viscous"
dofs = ["14z", "15z"]
state = "known"
c = 3.0
[[run]]
file = "r.csv"
frequency = 11.0
force_dof = "13z"
force_n = 2.0
"""


def simulated(folder, structure):
    (folder / "p.toml").write_text(project(structure))
    subprocess.run([DASHPOT, "simulate", "p.toml", "--out", "out", "--as", "harmonics"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    lines = (folder / "out" / "harmonics.csv").read_text().split("\n")
    return np.array([[float(cell) for cell in line.split(",")[4:6]] for line in lines[1:] if line])


def same(name, found, expected, tolerance=1e-12):
    error = np.abs(found - expected).max() / np.abs(expected).max()
    print(f"{'ok  ' if error <= tolerance else 'BAD '} {name}: {error:.1e}")
    return error <= tolerance


def bulk(folder, name, size, is_double):
    model = BDF(log=None, debug=None)
    for i in range(N):
        model.add_grid(11 + i, [0.1 * i, 0.0, 0.0])
    model.add_mat1(1, 7e10, None, 0.3)
    model.add_pbar(1, 1, A=1.0)
    for i in range(N - 1):
        model.add_cbar(1 + i, 1, [11 + i, 12 + i], [0.0, 0.0, 1.0], None)
    for matrix_name, matrix in (("KAAX", K), ("MAAX", M)):
        rows, columns = np.nonzero(np.tril(matrix))
        model.add_dmig(matrix_name, 6, 2, 0, None, N,
                       [(11 + int(j), 3) for j in columns], [(11 + int(i), 3) for i in rows],
                       [float(matrix[i, j]) for i, j in zip(rows, columns)])
    model.write_bdf(str(folder / name), size=size, is_double=is_double, write_header=False)


def binary_output4(name, matrix, order, kind, layout):
    """One matrix; layout 0 dense, 1 strings, 2 strings with BIGMAT."""
    letter, words = ("f", 1) if kind == 1 else ("d", 2)
    out = b""

    def record(content):
        return struct.pack(order + "i", len(content)) + content + struct.pack(order + "i", len(content))

    rows = -N if layout == 2 else N
    out += record(struct.pack(order + "4i", N, rows, 6, kind) + name.ljust(8).encode())
    for j in range(N):
        filled = np.nonzero(matrix[:, j])[0]
        first, last = filled[0], filled[-1]
        values = matrix[first:last + 1, j]
        count = len(values) * words
        body = struct.pack(f"{order}{len(values)}{letter}", *values)
        if layout == 0:
            head = struct.pack(order + "3i", j + 1, first + 1, count)
        elif layout == 1:
            head = struct.pack(order + "4i", j + 1, 0, count + 1, first + 1 + 65536 * (count + 1))
        else:
            head = struct.pack(order + "5i", j + 1, 0, count + 2, count + 1, first + 1)
        out += record(head + body)
    return out + record(struct.pack(order + "3i", N + 1, 1, words) + struct.pack(order + letter, 1.0))


def main():
    good = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        mmwrite(folder / "m.mtx", coo_matrix(M), symmetry="symmetric", precision=17)
        mmwrite(folder / "k.mtx", coo_matrix(K), symmetry="symmetric", precision=17)
        table = "dof,node,direction\n" + "".join(f"{label},{label[:-1]},z\n" for label in LABELS)
        (folder / "dofs.csv").write_text(table)
        expected = simulated(folder, 'mass = "m.mtx"\nstiffness = "k.mtx"\ndofs = "dofs.csv"')
        for size, is_double in ((8, False), (16, False), (16, True)):
            bulk(folder, "model.bdf", size, is_double)
            found = simulated(folder, 'mass = "model.bdf"\nstiffness = "model.bdf"')
            good.append(same(f"bulk data of pyNastran, size {size}, double {is_double}", found, expected, 1e-6))
        sparse = {"KAA": (6, coo_matrix(K)), "MAA": (6, coo_matrix(M))}
        dense = {"KAA": (6, K), "MAA": (6, M)}
        structure = 'mass = "m.op4"\nstiffness = "m.op4"\ndofs = "dofs.csv"'
        for title, matrices, big in (("dense", dense, False), ("sparse", sparse, False), ("BIGMAT", sparse, True)):
            OP4(debug=None).write_op4(str(folder / "m.op4"), matrices, name_order=None, is_binary=False) if not big else \
                OP4(debug=None).write_op4(str(folder / "m.op4"), matrices, is_binary=False)
            good.append(same(f"ascii OUTPUT4 of pyNastran, {title}", simulated(folder, structure), expected))
        for order in "<>":
            for kind in (1, 2):
                for layout in (0, 1, 2):
                    content = b"".join(binary_output4(n, m, order, kind, layout) for n, m in (("KAA", K), ("MAA", M)))
                    (folder / "m.op4").write_bytes(content)
                    title = f"binary OUTPUT4 {order} type {kind} layout {layout}"
                    try:
                        read = read_op4(str(folder / "m.op4"), debug=None)["KAA"]
                        theirs = read.data if hasattr(read, "data") else read[1]
                        theirs = theirs.toarray() if hasattr(theirs, "toarray") else theirs
                        good.append(same(f"{title}: read by pyNastran", theirs, K))
                    except Exception as error:  # pyNastran does not read every variant
                        print(f"-    {title}: pyNastran does not read it ({type(error).__name__})")
                    good.append(same(f"{title}: read by us", simulated(folder, structure), expected))
        good.append(exported(folder))
        good.append(turned(folder))
    sys.exit(0 if all(good) else 1)


def exported(folder):
    """Our NASTRAN files in pyNastran."""
    structure = 'mass = "m.mtx"\nstiffness = "k.mtx"\ndofs = "dofs.csv"'
    (folder / "p.toml").write_text(project(structure))
    run = dict(cwd=folder, check=True, stdout=subprocess.DEVNULL)
    frequencies = [8.0, 14.0, 20.0, 26.0, 30.0]
    text = project(structure).split("[[run]]")[0] + "".join(
        f'[[run]]\nfile = "{i}.csv"\nfrequency = {f}\nforce_dof = "13z"\nforce_n = 2.0\n' for i, f in enumerate(frequencies))
    (folder / "t.toml").write_text(text)
    subprocess.run([DASHPOT, "simulate", "t.toml", "--out", "."], **run)
    candidates = text.replace('state = "known"\n', 'state = "forced"\n').replace("c = 2.0\n", "").replace("c = 3.0\n", "")
    (folder / "p.toml").write_text(candidates.replace('force_dof = "13z"\nforce_n = 2.0\n', ""))
    for to, out in (("nastran", "c.bdf"), ("json", "c.json")):
        subprocess.run([DASHPOT, "export", "p.toml", "--to", to, "--out", out], **run)
    model = BDF(log=None, debug=None)
    model.read_bdf(str(folder / "c.bdf"), punch=True, xref=False)
    pairs = sorted(((list(e.nodes), e.c1, e.c2, round(e.b, 6)) for e in model.elements.values()), key=str)
    print("     CDAMP2 as pyNastran reads them:", pairs)
    model = BDF(log=None, debug=None)
    model.read_bdf(str(folder / "c-dmig.bdf"), punch=True, xref=False)
    matrix, rows, _ = model.dmigs["CDAMP"].get_matrix(is_sparse=False)
    ours = np.zeros((N, N))
    document = json.loads((folder / "c.json").read_text())
    viscous = np.array(find(document, "viscous"))
    for i, (grid_i, _) in rows.items():
        for j, (grid_j, _) in rows.items():
            ours[grid_i - 11 if grid_i > 10 else grid_i - 1, grid_j - 11 if grid_j > 10 else grid_j - 1] = matrix[i, j]
    return same("DMIG of ours, read by pyNastran", ours, viscous, 1e-9)


def turned(folder):
    """Our dashpot in z at grid point 12, whose axes lie askew in space."""
    deck = "CORD2R,5,,0.,0.,0.,1.,0.3,-0.2\n,0.1,1.,1.\nGRID,11,,0.,0.,0.\nGRID,12,,1.,0.,0.,5\n"
    for name, own in (("KAAX", "3.+4"), ("MAAX", "1.")):
        deck += f"DMIG,{name},0,6,2,0\nDMIG,{name},11,3,,11,3,{own}\n" + "".join(f"DMIG,{name},12,{c},,12,{c},{own}\n" for c in (1, 2, 3))
    (folder / "turned.bdf").write_text(deck)
    text = project('mass = "turned.bdf"\nstiffness = "turned.bdf"').split("[[source]]")[0]
    text += '[[source]]\nlaw = "viscous"\ndofs = ["12z"]\nstate = "forced"\n'
    truth = text.replace('state = "forced"', 'state = "known"\nc = 2.0')
    for name, head, force in (("t.toml", truth, 'force_dof = "12z"\nforce_n = 2.0\n'), ("p.toml", text, "")):
        (folder / name).write_text(head + "".join(f'[[run]]\nfile = "{i}.csv"\nfrequency = {f}\n{force}' for i, f in enumerate([20.0, 27.0, 30.0])))
    run = dict(cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([DASHPOT, "simulate", "t.toml", "--out", "."], **run)
    subprocess.run([DASHPOT, "export", "p.toml", "--to", "nastran", "--out", "turned-c.bdf"], **run)
    model = BDF(log=None, debug=None)
    model.read_bdf(str(folder / "turned-c.bdf"), punch=True, xref=False)
    (bush,), (properties,) = model.elements.values(), model.properties.values()
    good = bush.type == "CBUSH" and bush.cid == 0 and list(bush.node_ids)[0] == 12 and abs(properties.Bi[2] - 2.0) < 1e-6
    print(f"{'ok  ' if good else 'BAD '} CBUSH of ours as pyNastran reads it: {bush.type} at {list(bush.node_ids)}, CID {bush.cid}, B {properties.Bi}")
    both = BDF(log=None, debug=None)
    (folder / "both.bdf").write_text(deck + (folder / "turned-c-dmig.bdf").read_text())
    both.read_bdf(str(folder / "both.bdf"), punch=True, xref=True)
    axes = both.coords[5].beta()
    matrix, rows, columns = both.dmigs["CDAMP"].get_matrix(is_sparse=False)
    own = np.zeros((3, 3))
    for i, (_, a) in rows.items():
        for j, (_, b) in columns.items():
            own[a - 1, b - 1] = matrix[i, j]
    return same("DMIG of ours in the axes of pyNastran", axes.T @ own @ axes, np.diag([0.0, 0.0, 2.0]), 1e-6) and good


def find(document, key):
    """The first value of a key, wherever it stands."""
    if isinstance(document, dict):
        if key in document and isinstance(document[key], list):
            return document[key]
        document = list(document.values())
    if isinstance(document, list):
        for part in document:
            found = find(part, key) if isinstance(part, (dict, list)) else None
            if found is not None:
                return found
    return None


if __name__ == "__main__":
    main()
