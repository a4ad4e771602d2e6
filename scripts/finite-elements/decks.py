"""NASTRAN decks as people write them, each laid under the hammer test of the samples: the two dashpots must be found at their nodes.

    python scripts/finite-elements/decks.py target/debug/dashpot /tmp/decks

A development tool: no test needs it.
"""

import json
import pathlib
import re
import subprocess
import sys

SAMPLE = pathlib.Path(__file__).resolve().parents[2] / "sample-data" / "hammer-frf"
DECK = (SAMPLE / "model.bdf").read_text()


def cards():
    """Cards of the deck as lists of data fields behind the name."""
    out = []
    for line in DECK.splitlines():
        if line.startswith("$") or not line.strip() or line.startswith(("BEGIN", "ENDDATA")):
            continue
        large = line[:8].strip().endswith("*") or line.startswith("*")
        width = 16 if large else 8
        fields = [line[8 + k * width:8 + (k + 1) * width].strip() for k in range(4 if large else 8)]
        name = line[:8].strip().rstrip("*")
        if name:
            out.append([name, fields])
        else:
            out[-1][1] += fields
    return out


def entries(fields):
    return [tuple(fields[k:k + 3]) for k in range(4, len(fields), 4) if fields[k]]


def small(value):
    """A number in eight characters, as NASTRAN abbreviates it."""
    for digits in range(7, 0, -1):
        text = re.sub(r"E([+-])0*", r"\1", f"{float(value.replace('D', 'E')):.{digits}E}")
        if len(text) <= 8:
            return text
    return text


def free(double=True):
    lines = []
    for name, f in cards():
        if name != "DMIG":
            lines.append(",".join([name] + f).rstrip(","))
        elif f[1] == "0":
            lines.append(",".join([name] + f).rstrip(","))
        else:
            body = [x for g, c, a in entries(f) for x in (g, c, a if double else small(a), "")]
            first, rest = body[:4], body[4:]
            lines.append(",".join([name, f[0], f[1], f[2], "", *first]))
            lines += [",".join(["+", *rest[k:k + 8]]) for k in range(0, len(rest), 8)]
    return lines


def tabbed():
    lines = []
    for name, f in cards():
        if name == "DMIG":
            continue
        lines.append("\t".join([name] + f).rstrip("\t"))
    return lines + [line for line in DECK.splitlines() if line.startswith(("DMIG", "*"))]


def square():
    """Form 1 with both triangles."""
    whole = {}
    for name, f in cards():
        if name == "DMIG" and f[1] != "0":
            for g, c, a in entries(f):
                whole[(f[0], f[1], f[2], g, c)] = a
                whole[(f[0], g, c, f[1], f[2])] = a
    lines = [",".join([n] + f).rstrip(",") for n, f in cards() if n != "DMIG"]
    for m in ("KAAX", "MAAX"):
        lines.append(f"DMIG,{m},0,1,2,0")
        for col in sorted({k[1:3] for k in whole if k[0] == m}):
            body = [x for k, a in whole.items() if k[0] == m and k[1:3] == col for x in (k[3], k[4], a, "")]
            lines.append(",".join(["DMIG", m, *col, "", *body[:4]]))
            lines += [",".join(["", *body[k:k + 8]]) for k in range(4, len(body), 8)]
    return lines


EXECUTIVE = ["SOL 103", "CEND", "TITLE = Träger", "SPC = 1", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,10", "PARAM,POST,-1", "PARAM   WTMASS  1.0",
             "SPC1    1       123456  100", "MAT1    1       6.9+10          .33     2700.", "PBEAM,1,1,1.6-4,2.1-10,2.1-8,,8.5-10", "RBE2,900,110,123456,111"]
LOADS = ["DMIG    PAX            0       9       2       0                       1", "DMIG*   PAX                            1               0",
         "*                    101               3  1.000000000D+00", "DMIG    K4AAX          0       6       3       0",
         "DMIG*   K4AAX                        101               3", "*                    101               3  1.000000000D+00 2.000000000D+00"]


def write(folder):
    """Decks by name: the files that are given to --mass and --stiffness."""
    decks = {}

    def put(name, lines, encoding="utf-8", end="\n", given=None):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes((end.join(lines) + end).encode(encoding))
        decks[given or name] = [path]

    lines = DECK.splitlines()
    put("as-it-is.bdf", lines)
    put("crlf.dat", lines, end="\r\n")
    put("free-double.bdf", ["BEGIN BULK"] + free() + ["ENDDATA"])
    put("free-lower.nas", [line.lower() for line in ["BEGIN BULK"] + free() + ["ENDDATA"]])
    put("tabs.bdf", ["BEGIN BULK"] + tabbed() + ["ENDDATA"])
    put("executive-latin1.bdf", EXECUTIVE + lines[3:], encoding="latin-1")
    put("square.bdf", ["BEGIN BULK"] + square())
    put("loads-beside.pch", [line for line in lines if not line.startswith(("BEGIN", "ENDDATA"))] + LOADS)
    geometry = [line for line in lines if line.startswith(("GRID", "PLOTEL"))]
    matrices = [line for line in lines if line.startswith(("DMIG", "*"))]
    put("parts/mesh.bdf", geometry)
    put("parts/sub/matrices.pch", matrices)
    put("including.bdf", EXECUTIVE + ["INCLUDE 'parts/mesh.bdf'", "include \"parts\\sub\\matrices.pch\"", "ENDDATA"], encoding="latin-1")
    cut = next(i for i, line in enumerate(matrices) if "MAAX" in line)
    put("stiffness.pch", matrices[:cut])
    put("mass.pch", geometry + matrices[cut:])
    del decks["parts/mesh.bdf"], decks["parts/sub/matrices.pch"], decks["mass.pch"], decks["stiffness.pch"]
    decks["two files"] = [folder / "mass.pch", folder / "stiffness.pch"]
    return decks


def main():
    binary, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for name, files in write(folder).items():
        project = folder / "project.toml"
        project.unlink(missing_ok=True)
        words = [binary, "import", str(SAMPLE / "hammer.uff"), "--averages", "8", "--out", str(project), "--mass", str(files[0])]
        words += ["--stiffness", str(files[1])] if len(files) > 1 else []
        made = subprocess.run(words, capture_output=True, text=True)
        found = subprocess.run([binary, "identify", str(project), "--json"], capture_output=True, text=True)
        try:
            sources = {s["dofs"][0]: s["parameters"]["c"] for s in json.loads(found.stdout)["sources"]}
        except (ValueError, KeyError):
            sources = {}
        right = sorted(sources) == ["103z", "107z"] and abs(sources["103z"] / 0.5 - 1) < 0.02 and abs(sources["107z"] / 0.2 - 1) < 0.02
        wrong += not right
        print(f"{'as wanted' if right else 'WRONG':10} {name:24} {sources or (made.stderr + found.stderr).strip()[:200]}", flush=True)
    print(f"{wrong} not as wanted")


if __name__ == "__main__":
    main()
