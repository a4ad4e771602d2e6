#!/usr/bin/env python3
"""From CalculiX to what a structure hides: a cantilever of solid elements with 27 000 degrees of freedom, reduced to 60, with a dashpot and friction on it.

    hidden.py PATH/TO/dashpot FOLDER

Runs `cantilever.py` and `ccx` (Debian: calculix-ccx), which solves for the frequencies as well; reduces the matrices to 24 places
along the middle and fixed-interface modes; simulates 27 runs with six accelerometers and 0.2 % noise on
a model with two dashpots and dry friction that the project does not know, which `identify` is to find among a dashpot and a friction at every
place; and on one with a dashpot and friction, which `diagnose` is to find. Ends with an error where a frequency in the band is off
by more than 0.1 %, or an effect is not found at its place to 2 %.
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

DASHPOT, FOLDER = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
BAND, UP_TO, SENSORS = 400.0, 10_000.0, [10, 30, 50, 70, 90, 120]
PLACES = list(range(5, 121, 5))
HIDDEN = [("viscous", 50, "c", 0.3), ("coulomb", 90, "force", 0.05)]
MORE = [*HIDDEN, ("viscous", 110, "c", 0.2)]
CANDIDATES = "".join(f'\n[[candidates]]\nlaw = "{law}"\nwhere = "each-translation"\n' for law in ("viscous", "coulomb"))


def label(i):
    """DOF in z of the node in the middle of section i of 120 x 8 x 2 elements."""
    return f"{14 + 27 * i}z"


def run(*arguments):
    ran = subprocess.run([str(a) for a in arguments], cwd=FOLDER, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if ran.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {ran.stderr.strip() or ran.stdout.strip()[-400:]}")
    return ran.stdout


def frequencies_of_calculix():
    """The first natural frequencies, Hz, as CalculiX solves for them on the same model."""
    text = (FOLDER / "matrices.inp").read_text().replace("*FREQUENCY, SOLVER=MATRIXSTORAGE", "*FREQUENCY")
    (FOLDER / "modes.inp").write_text(text)
    run("ccx", "-i", "modes")
    rows = re.findall(r"^\s+\d+\s+(\S+)\s+(\S+)\s+(\S+)\s+\S+$", (FOLDER / "modes.dat").read_text(), re.M)
    return sorted(float(row[2]) for row in rows)


def head(title):
    places = ", ".join(f'"{label(i)}"' for i in PLACES)
    return f"""[project]
format = 1
title = "{title}"

[structure]
kind = "matrices"
mass = "matrices.mas"
stiffness = "matrices.sti"

[structure.reduce]
up_to_hz = {UP_TO}
band_hz = {BAND}
dofs = [{places}]

[[source]]
law = "stiffness_proportional"
state = "known"
beta = 2e-5

[[source]]
law = "viscous"
dofs = ["{label(60)}"]
state = "known"
c = 0.5
"""


def projects(modes, hidden, name):
    """Recipe `name-truth.toml` and project `name.toml`, with candidates where identification is to find what is hidden."""
    truth, project = head("The truth"), head("What is known") + (CANDIDATES if name == "identified" else "")
    for law, section, parameter, value in hidden:
        truth += f'\n[[source]]\nlaw = "{law}"\ndofs = ["{label(section)}"]\nstate = "known"\n{parameter} = {value}\n'
    channels = ", ".join(f'"acc@{label(i)} [m/s^2]"' for i in SENSORS)
    truth += f'\n[simulate]\nchannels = ["force@{label(120)} [N]", {channels}]\n'
    number = 0
    for mode in modes[:3]:
        for level, force in enumerate((0.5, 1.0, 2.0), 1):
            for share in (0.98, 1.003, 1.02):
                number += 1
                one = f'\n[[run]]\nfile = "{name}-{number:02}.csv"\nfrequency = {mode * share:.4f}\nlevel = {level}\n'
                project += one
                truth += one + f'force_dof = "{label(120)}"\nforce_n = {force}\n'
    (FOLDER / f"{name}-truth.toml").write_text(truth)
    (FOLDER / f"{name}.toml").write_text(project)
    run(DASHPOT, "simulate", f"{name}-truth.toml", "--out", ".", "--noise", 0.002, "--seed", 5)


def check(hidden, found):
    """What was found, by law and DOFs, against what is hidden."""
    for law, section, parameter, value in hidden:
        got = found.get((law, label(section)), {}).get(parameter)
        assert got is not None, f"{law} at {label(section)} is not found: {found}"
        print(f"{law:8} at {label(section)}: {parameter} = {got:.5g}, in truth {value} ({100 * (got / value - 1):+.2f} %)")
        assert abs(got / value - 1) < 0.02, f"{law} at {label(section)} is off"


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    run(sys.executable, Path(__file__).resolve().with_name("cantilever.py"), ".")
    run("ccx", "-i", "matrices")
    modes = frequencies_of_calculix()
    bending = [f for f in modes if f < BAND]
    driven = [min(modes, key=lambda f: abs(f - g)) for g in (10.5, 66.0, 185.0)]
    projects(driven, HIDDEN, "diagnosed")
    projects(driven, MORE, "identified")
    compared = json.loads(run(DASHPOT, "compare", "diagnosed.toml", "--json"))
    reduction = compared["reduction"]
    kept = reduction["kept_dofs"] + reduction["fixed_interface_modes"]
    print(f"{reduction['from_dofs']} degrees of freedom to {reduction['kept_dofs']} and {reduction['fixed_interface_modes']} modes, {kept} in all")
    worst = 0.0
    for ours, theirs in zip(reduction["modes"], bending):
        error = ours["reduced_hz"] / theirs - 1
        worst = max(worst, abs(error))
        print(f"CalculiX {theirs:10.4f} Hz, reduced {ours['reduced_hz']:10.4f} Hz, {100 * error:+.1e} %")
    assert worst < 1e-3, f"a frequency is off by {100 * worst:.3g} %"
    assert len(reduction["modes"]) == len(bending), "the band holds other modes"
    outcome = json.loads(run(DASHPOT, "identify", "identified.toml", "--json"))
    sources = [source for source in outcome["sources"] if not source["law"].startswith("stiffness")]
    print(f"identify: {outcome['accepted']} sources accepted")
    check(MORE, {(source["law"], *source["dofs"]): source["parameters"] for source in sources})
    found = json.loads(run(DASHPOT, "diagnose", "diagnosed.toml", "--json"))
    print(f"verdict {found['verdict']}, error {100 * found['error_before']:.3g} % before, {100 * found['steps'][-1]['error']:.3g} % after, noise floor {100 * found['noise_floor']:.2g} %")
    check(HIDDEN, {(effect["effect"], *effect["dofs"]): effect["parameters"] for effect in found["steps"][-1]["added"]})


main()
