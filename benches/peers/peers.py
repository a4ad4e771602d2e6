"""The same work by Dashpot and by open programs in Python: what each takes and how right each is.

    python3 -m venv peers && peers/bin/pip install -r benches/peers/requirements.txt
    cargo build --release --no-default-features --bin dashpot --example peers
    peers/bin/python benches/peers/peers.py

Every problem is made here, with its answer; both sides get the same numbers. Peers that are not installed are passed over. Times
are medians of the call alone, files and start-up aside, but for `dashpot methods` and `identify`, which are whole programs. The
table is what docs/verification.md shows.
"""

import argparse
import contextlib
import io
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import least_squares, nnls

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "sample-data" / "hammer-frf"


def timed(work, repeat):
    """The answer of `work` and the median of its times, s."""
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        answer = work()
        times.append(time.perf_counter() - start)
    return answer, statistics.median(times)


def columns(rows, count, used, noise, rng):
    """Squares of sums of sines, as the energies of dashpots on a beam are; the columns `used` make the right-hand side."""
    weights = rng.random((rows, 12)) - 0.5
    place = (np.arange(count) + 0.37) / count
    shapes = np.sin(np.outer(np.arange(1, 13), np.pi * place))
    a = (weights @ shapes) ** 2
    b = a[:, used].sum(axis=1) * (1 + noise * (rng.random(rows) - 0.5))
    return {"a": a.tolist(), "b": b.tolist()}


def steady(rng):
    """Eight channels of 5000 samples: 23.457 Hz with its third harmonic, 2 % noise."""
    omega, samples, channels = 2 * np.pi * 23.457, 5000, 8
    t = np.arange(samples) / 2000.0
    truth = np.zeros((channels, 3), complex)
    truth[:, 0] = np.exp(-1j * 0.3 * np.arange(channels))
    truth[:, 2] = 0.05 * np.exp(1j * np.arange(channels))
    clean = sum(np.real(np.outer(truth[:, h], np.exp(1j * (h + 1) * omega * t))) for h in range(3))
    values = clean + 0.02 * rng.standard_normal(clean.shape)
    return {"time": t.tolist(), "channels": values.tolist(), "harmonics": 3}, omega, truth


OSCILLATOR = {"c": 0.05, "k": 400.0, "k3": 8000.0, "x0": 0.1, "step": 2 * np.pi / 20.0 / 24.0, "samples": 15279}


def rates(_, y):
    """The oscillator, then its derivatives by c, k3, x0 and v0, two entries each."""
    c, k, k3 = (OSCILLATOR[name] for name in ("c", "k", "k3"))
    x, v = y[0], y[1]
    slope = k + 3 * k3 * x * x
    out = np.empty(10)
    out[0], out[1] = v, -c * v - k * x - k3 * x**3
    out[2::2] = y[3::2]
    out[3::2] = -slope * y[2::2] - c * y[3::2]
    out[3] -= v
    out[5] -= x**3
    return out


def integrate(tolerance):
    """The oscillator by SciPy's DOP853 at every sample."""
    t = OSCILLATOR["step"] * np.arange(OSCILLATOR["samples"])
    start = [OSCILLATOR["x0"], 0, 0, 0, 0, 0, 1, 0, 0, 1]
    return solve_ivp(rates, (0, t[-1]), start, method="DOP853", t_eval=t, rtol=tolerance, atol=1e-3 * tolerance).y[0]


def fit_by_least_squares(problem, start):
    """Frequency and harmonics at once by `least_squares`, amplitudes eliminated (variable projection)."""
    t, y, count = np.array(problem["time"]), np.array(problem["channels"]).T, problem["harmonics"]

    def basis(omega):
        waves = [f(h * omega * t) for h in range(1, count + 1) for f in (np.cos, np.sin)]
        return np.column_stack([np.ones_like(t), t, *waves])

    def left(omega):
        design = basis(omega[0])
        return (y - design @ np.linalg.lstsq(design, y, rcond=None)[0]).ravel()

    omega = least_squares(left, [start], x_scale=[1e-3 * start], xtol=1e-15, ftol=1e-15).x[0]
    parts = np.linalg.lstsq(basis(omega), y, rcond=None)[0][2:]
    return omega, (parts[0::2] - 1j * parts[1::2]).T


def cantilever(damped):
    """Mass, stiffness and damping of the beam of the sample `hammer-frf`: ten Euler-Bernoulli elements."""
    length, breadth, depth, modulus, density, n = 0.56, 0.04, 0.004, 69e9, 2700.0, 10
    h, inertia, area = length / n, breadth * depth**3 / 12, breadth * depth
    ke = modulus * inertia / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h], [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    )
    me = density * area * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h], [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
    )
    m, k, c = (np.zeros((2 * n + 2, 2 * n + 2)) for _ in range(3))
    for e in range(n):
        at = slice(2 * e, 2 * e + 4)
        m[at, at] += me
        k[at, at] += ke
    for dof, value in damped:
        c[dof + 1, dof + 1] += value
    return m[2:, 2:], k[2:, 2:], c[2:, 2:]


def true_ratios(count):
    """Frequencies, Hz, and damping ratios of the sample's truth: dashpots of 0.5 and 0.2 N s/m at DOFs 5 and 13."""
    m, k, c = cantilever([(5, 0.5), (13, 0.2)])
    n = len(m)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]])
    roots = np.linalg.eigvals(state)
    roots = sorted((r for r in roots if r.imag > 0), key=abs)[:count]
    assert np.allclose([abs(r) for r in roots], np.sqrt(eigh(k, m, eigvals_only=True)[:count]), rtol=1e-3)
    return [(abs(r) / 2 / np.pi, -r.real / abs(r)) for r in roots]


def responses(noise, rng):
    """Receptances of DOFs 7, 11, 15, 19 to a force at 19, 0 to 400 Hz, with noise of each line's own size."""
    m, k, c = cantilever([(5, 0.5), (13, 0.2)])
    f = np.arange(0.25, 400.0, 0.25)
    force = np.zeros(len(m))
    force[18] = 1.0
    h = np.array([np.linalg.solve(k - (w * w) * m + 1j * w * c, force)[[6, 10, 14, 18]] for w in 2 * np.pi * f]).T
    return f, h * (1 + noise * (rng.standard_normal(h.shape) + 1j * rng.standard_normal(h.shape)) / np.sqrt(2))


def by_pyema(truth):
    """Damping ratios by the poly-reference least-squares complex frequency method of pyEMA on like responses."""
    try:
        import pyEMA
    except ImportError:
        return None
    f, h = responses(0.02, np.random.default_rng(12))

    # A band a mode and wider limits of stability than its defaults, with which it misses the first mode.
    bands = [(0.5 * frequency, max(1.5 * frequency, 100.0)) for frequency, _ in truth]

    def work():
        found = []
        for (lower, upper), (frequency, _) in zip(bands, truth):
            keep = (f >= lower) & (f <= min(upper, f[-1]))
            model = pyEMA.Model(h[:, keep], f[keep], lower=f[keep][0], upper=f[keep][-1], pol_order_high=30, frf_type="receptance")
            with contextlib.redirect_stderr(io.StringIO()):
                model.get_poles(show_progress=False)
            model.select_closest_poles([frequency], f_window=0.2 * frequency, fn_temp=0.01, xi_temp=0.2)
            found.append((model.nat_freq[0], model.nat_xi[0]))
        return found

    return timed(work, 3)


def by_abess(problem, size):
    """The best subset by abess (splicing, no proof, signs free)."""
    try:
        from abess import LinearRegression
    except ImportError:
        return None
    a, b = np.array(problem["a"]), np.array(problem["b"])

    def work():
        model = LinearRegression(support_size=[size], fit_intercept=False)
        model.fit(a, b)
        return sorted(np.flatnonzero(model.coef_).tolist())

    return timed(work, 5)


def run(program, *arguments):
    """What a program prints, and its time, s."""
    start = time.perf_counter()
    done = subprocess.run([program, *arguments], check=True, capture_output=True, text=True)
    return json.loads(done.stdout), time.perf_counter() - start


def worst(found, truth):
    """Largest relative error of damping ratios, each by the mode that is nearest in frequency."""
    nearest = [min(found, key=lambda pair: abs(pair[0] - frequency)) for frequency, _ in truth]
    return max(abs(ratio / true - 1) for (_, ratio), (_, true) in zip(nearest, truth))


def residual(problem, picked, signs_free=False):
    """What a set of columns leaves of the right-hand side."""
    a, b = np.array(problem["a"])[:, picked], np.array(problem["b"])
    left = np.linalg.norm(a @ np.linalg.lstsq(a, b, rcond=None)[0] - b) if signs_free else nnls(a, b)[1]
    return left / np.linalg.norm(b)


def table(rows):
    print("| work | peer | its time | its error | our time | our error | ratio of times |")
    print("|---|---|---|---|---|---|---|")
    for work, peer, seconds, error, own, own_error in rows:
        print(f"| {work} | {peer} | {1e3 * seconds:.3g} ms | {error} | {1e3 * own:.3g} ms | {own_error} | {seconds / own:.3g} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--release", default=ROOT / "target" / "release", type=pathlib.Path, help="folder of our programs")
    release = parser.parse_args().release
    rng = np.random.default_rng(1)
    steady_problem, omega, amplitudes = steady(rng)
    problems = {
        "nnls": columns(48, 80, [8, 20, 40, 53, 77], 0.04, rng),
        "subset": {**columns(24, 90, [10, 22, 45, 60, 87], 0.04, rng), "size": 5},
        "steady": steady_problem,
        "oscillator": OSCILLATOR,
    }
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(problems, file)
        file.flush()
        ours, _ = run(release / "examples" / "peers", file.name)
    rows = []

    p = problems["nnls"]
    (x, norm), seconds = timed(lambda: nnls(np.array(p["a"]), np.array(p["b"])), 51)
    own = np.array(ours["nnls"]["x"])
    own_norm = np.linalg.norm(np.array(p["a"]) @ own - np.array(p["b"]))
    rows.append(("non-negative least squares, 48 x 80", "scipy nnls", seconds, f"residual {norm:.9g}", ours["nnls"]["seconds"], f"{own_norm:.9g}"))

    p, found = problems["subset"], ours["subset"]
    answer = by_abess(p, p["size"])
    if answer:
        rows.append(("best 5 of 90 columns, 24 rows", "abess", answer[1], f"residual {residual(p, answer[0], signs_free=True):.4%}, signs free", found["seconds"], f"{residual(p, found['columns']):.4%}" + (", proved" if found["proved"] else "")))

    start = omega * (1 + 2e-4)
    (peer_omega, peer_amplitudes), seconds = timed(lambda: fit_by_least_squares(steady_problem, start), 3)
    own = ours["steady"]
    own_amplitudes = np.array(own["amplitudes"]) @ np.array([1, 1j])
    off = lambda y: np.abs(y - amplitudes).max()
    rows.append(("frequency and harmonics, 8 channels x 5000 samples", "scipy least_squares, told the frequency to 2e-4", seconds, f"{abs(peer_omega / omega - 1):.1e}, {off(peer_amplitudes):.1e}", own["seconds"], f"{abs(own['omega'] / omega - 1):.1e}, {off(own_amplitudes):.1e}"))

    exact = integrate(1e-12)
    for tolerance, answer in zip((1e-3, 1e-4), ours["oscillator"]):
        x, seconds = timed(lambda: integrate(tolerance), 3)
        peer_off, own_off = (np.abs(np.array(v) - exact).max() / OSCILLATOR["x0"] for v in (x, answer["x"]))
        rows.append((f"Duffing decay, 15 279 samples, four derivatives, {answer['substeps']} steps a sample", f"scipy solve_ivp DOP853, rtol {tolerance:.0e}", seconds, f"{peer_off:.1e}", answer["seconds"], f"{own_off:.1e}"))

    truth = true_ratios(4)
    document, seconds_own = run(release / "dashpot", "identify", str(SAMPLE / "project.toml"), "--json")
    own = [(mode["frequency_hz"], mode["damping_ratio"]) for mode in document["modes"]]
    answer = by_pyema(truth)
    if answer:
        found, seconds = answer
        rows.append(("damping ratios of four modes from responses of four sensors with 2 % noise (ours: two references, 8 averages)", "pyEMA, poly-reference LSCF, a band a mode", seconds, f"{worst(found, truth):.2%}", seconds_own, f"{worst(own, truth):.2%} (with the places of the dashpots)"))
    table(rows)
    print(f"\nPython {sys.version.split()[0]}, NumPy {np.__version__}", file=sys.stderr)


if __name__ == "__main__":
    main()
