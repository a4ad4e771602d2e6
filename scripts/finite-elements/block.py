"""A block of solid elements clamped at one end, in the files of CalculiX (.sti .mas .dof .inp), with any number of degrees of freedom.

    pip install numpy scipy
    python scripts/finite-elements/block.py 120 16 16 /tmp/block
    time target/release/dashpot identify /tmp/block/project.toml

Eight-node bricks of steel by 2 x 2 x 2 points of Gauss, consistent mass. 120 x 16 x 16 elements have 104 040 degrees of freedom.
The project reduces them to a few points; `identify` tells the error on the modes. A development tool: no test needs it.
"""

import pathlib
import sys

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

E, NU, RHO, SIZE = 2.1e11, 0.3, 7850.0, 0.01


def brick():
    c = E / ((1 + NU) * (1 - 2 * NU))
    d = np.zeros((6, 6))
    d[:3, :3] = c * NU
    d[range(3), range(3)] = c * (1 - NU)
    d[range(3, 6), range(3, 6)] = c * (1 - 2 * NU) / 2
    corners = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    k, m = np.zeros((24, 24)), np.zeros((24, 24))
    g = 1 / np.sqrt(3)
    for p in [(x, y, z) for x in (-g, g) for y in (-g, g) for z in (-g, g)]:
        one = 1 + corners * p
        n = one.prod(axis=1) / 8
        dn = np.stack([corners[:, a] * one[:, (a + 1) % 3] * one[:, (a + 2) % 3] / 8 for a in range(3)]) * 2 / SIZE
        b = np.zeros((6, 24))
        for i in range(8):
            x, y, z = dn[:, i]
            b[:, 3 * i:3 * i + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]]
        h = np.kron(n, np.eye(3))
        w = (SIZE / 2) ** 3
        k += w * b.T @ d @ b
        m += w * RHO * h.T @ h
    return k, m


def factor(matrix):
    """Factors of a matrix of symmetric pattern: the ordering for that fills in far less than the default."""
    return sla.splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True})


def lowest(k, m, count):
    """The lowest frequencies, Hz."""
    inverse = sla.LinearOperator(k.shape, factor(k).solve)
    return np.sqrt(np.sort(sla.eigsh(k, count, m, sigma=0, OPinv=inverse)[0])) / (2 * np.pi)


def main():
    nx, ny, nz = map(int, sys.argv[1:4])
    folder = pathlib.Path(sys.argv[4])
    folder.mkdir(parents=True, exist_ok=True)
    number = np.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(nx + 1, ny + 1, nz + 1)
    a = number[:-1, :-1, :-1].ravel()
    along = [number[i:nx + i or None, j:ny + j or None, l:nz + l or None].ravel() for i, j, l in
             [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
    nodes = np.stack(along, axis=1)
    assert len(a) == len(nodes)
    dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), 24)
    rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, (1, 24)).ravel()
    free = np.setdiff1d(np.arange(3 * number.size), (3 * number[0].ravel()[:, None] + np.arange(3)).ravel())
    k, m = brick()
    matrices = {}
    for name, element in (("sti", k), ("mas", m)):
        whole = sp.csr_matrix((np.tile(element.ravel(), len(nodes)), (rows, columns)))[free][:, free]
        matrices[name] = whole
        upper = sp.triu(whole).tocoo()
        np.savetxt(folder / f"block.{name}", np.column_stack([upper.row + 1, upper.col + 1, upper.data]), fmt="%d %d %.12E")
    (folder / "block.dof").write_text("".join(f"{d // 3 + 1}.{d % 3 + 1}\n" for d in free))
    places = SIZE * np.stack(np.meshgrid(range(nx + 1), range(ny + 1), range(nz + 1), indexing="ij"), axis=-1).reshape(-1, 3)
    (folder / "block.inp").write_text("*NODE\n" + "".join(f"{i + 1},{x:.6g},{y:.6g},{z:.6g}\n" for i, (x, y, z) in enumerate(places)))
    force = 3 * number[nx, ny // 2, nz] + 2
    sensors = [3 * number[i, ny // 2, nz] + 2 for i in range(nx // 6, nx + 1, nx // 6)]
    dampers = [(3 * number[nx // 2, ny // 2, nz] + 2, 400.0), (3 * number[nx, ny // 2, nz] + 2, 150.0)]
    place = {d: i for i, d in enumerate(free)}
    label = lambda d: f"{d // 3 + 1}{'xyz'[d % 3]}"
    modes = lowest(matrices["sti"], matrices["mas"], 6)
    print("frequencies, Hz:", modes)
    c = sp.lil_matrix(matrices["sti"].shape)
    for d, value in dampers:
        c[place[d], place[d]] = value
    lines = ["run,frequency_hz,channel,harmonic,cos,sin,cos_std,sin_std"]
    for r, f in enumerate(np.concatenate([modes[:4] * s for s in (0.98, 1.0, 1.02)])):
        w = 2 * np.pi * f
        load = np.zeros(len(free), complex)
        load[place[force]] = 10.0
        x = factor(matrices["sti"] - w**2 * matrices["mas"] + 1j * w * c).solve(load)
        lines.append(f"{r + 1},{f:.9f},force@{label(force)} [N],1,10.0,0.0,0.0,0.0")
        for d in sensors:
            y = -w**2 * x[place[d]]
            s = 1e-3 * abs(y)
            lines.append(f"{r + 1},{f:.9f},acc@{label(d)} [m/s^2],1,{y.real:.9e},{-y.imag:.9e},{s:.3e},{s:.3e}")
    (folder / "harmonics.csv").write_text("\n".join(lines) + "\n")
    wanted = ", ".join(f'"{label(d)}"' for d, _ in dampers)
    (folder / "project.toml").write_text(
        "[project]\nformat = 1\ntitle = \"Block of bricks\"\n[structure]\nkind = \"matrices\"\nmass = \"block.mas\"\nstiffness = \"block.sti\"\n"
        f"[structure.reduce]\nup_to_hz = {2 * modes[3]:.1f}\nband_hz = {1.1 * modes[3]:.1f}\ndofs = [{wanted}]\n"
        "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n[[harmonics]]\nfile = \"harmonics.csv\"\n")


if __name__ == "__main__":
    main()
