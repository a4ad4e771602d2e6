"""What an adaptive Runge-Kutta integrator needs for the oscillator of `benches/records.rs` with its four derivatives.

    x'' + 0.05 x' + 400 x + 8000 x^3 = 0,  x(0) = 0.1 m,  derivatives by c, k_3, x_0, x_0' beside it

Needs NumPy and SciPy: python3 scripts/integrator-speed.py
"""

import time

import numpy as np
from scipy.integrate import solve_ivp

C, K, K3 = 0.05, 400.0, 8000.0
STEP, SAMPLES = 2 * np.pi / 20.0 / 24.0, 15_279


def rates(_, y):
    """State, then its derivatives by c, k_3, x_0 and x_0', two entries each."""
    x, v = y[0], y[1]
    slope = K + 3 * K3 * x * x
    out = np.empty(10)
    out[0], out[1] = v, -C * v - K * x - K3 * x**3
    out[2::2] = y[3::2]
    out[3::2] = -slope * y[2::2] - C * y[3::2]
    out[3] -= v
    out[5] -= x**3
    return out


def main():
    instants = STEP * np.arange(SAMPLES)
    start = np.zeros(10)
    start[0], start[6], start[9] = 0.1, 1.0, 1.0
    solve = lambda method, tolerance: solve_ivp(
        rates, (0.0, instants[-1]), start, method, instants, rtol=tolerance, atol=0.1 * tolerance
    )
    exact = solve("DOP853", 1e-12).y[0]
    for method in ("RK45", "DOP853"):
        for tolerance in (1e-4, 1e-6, 1e-8):
            begin = time.process_time()
            found = solve(method, tolerance).y[0]
            seconds = time.process_time() - begin
            off = np.abs(found - exact).max() / 0.1
            print(f"{method} rtol {tolerance:.0e}: {seconds:.3f} s, off by {off:.1e} of the amplitude")


main()
