"""Whole exports of measuring programs, with their long headers and mixed contents, tried as try_import.py does.

    pip install numpy scipy h5py hdf5storage npTDMS openpyxl pyuff
    python scripts/interchange/exports.py target/release/dashpot /tmp/trial

A development tool: no test needs it.
"""

import numpy as np
import openpyxl
import scipy.io

import try_import
from try_import import ACC, ACCELERANCE, FORCE, FREQ, FS, G, MOBILITY, N, T, case, number, table, text

try_import.CASES.clear()
from dialects import HEADER, UNITS_SI, set58  # noqa: E402

try_import.CASES.clear()

SIZE, PHASE = np.abs(ACCELERANCE), np.degrees(np.angle(ACCELERANCE))


# Text tables.


@case("catman-long-header.asc")
def _(p):
    names = ["Zeit  1 - Standardmessrate", "Kraft_Shaker", "Beschl_Mitte"]
    head = ["HBM_CATMAN_DATAFILE", "HEADER", "FILE", "Exportdatum: 01.03.2024 11:59:12", "Bediener: Müller", "Anzahl Kanäle: 3", ""]
    head += [f"Kanal {k + 1}: {n}\tLänge: {N}\tAbtastrate: {FS:.0f} Hz\tSensor: {s}\tNullwert: 0,0123\tKalibrierung: 2 Punkte"
             for k, (n, s) in enumerate(zip(names, ["-", "U9C 500N", "IEPE 100 mV/g"]))]
    head += ["", "\t".join(names), "\t".join(["s", "N", "m/s²"]), "\t".join(["Startzeit: 11:58:01"] * 3)]
    text(p, head + table([T, FORCE, ACC], "\t", True), "cp1252", "\r\n")


@case("catman-two-rates.asc", (), "opens")
def _(p):
    slow = [number(y, True) for y in 20 + 0.01 * T[::10]]
    slow_t = [number(t, True) for t in T[::10]]
    lines = ["Zeit  1 - Standardmessrate\tKraft\tBeschl\tZeit  2 - langsame Messrate\tTemperatur", "s\tN\tm/s²\ts\t°C"]
    for i, row in enumerate(table([T, FORCE, ACC], "\t", True)):
        lines.append(row + ("\t" + slow_t[i] + "\t" + slow[i] if i < len(slow) else "\t\t"))
    text(p, lines, "cp1252", "\r\n")


@case("european-counter-units.csv")
def _(p):
    lines = ["Messung;7;;;", "Datum;01.03.2024;;;", ";;;;", "Nr.;Zeit;Kraft F1;Beschleunigung a1;", "[-];[ms];[kN];[mm/s²];"]
    text(p, lines + [row + ";" for row in table([np.arange(N) + 1, T * 1e3, FORCE / 1e3, ACC * 1e3], ";", True)], "cp1252", "\r\n")


@case("dewesoft-header.txt")
def _(p):
    lines = ["Data information", "File name: Test_0007.dxd", "Start time: 3/1/2024 11:58:01.123", "Number of channels: 2", "Sample rate: 1000", "Store type: always fast", "",
             "Data1", "Data type:\tSynchronous", "Time (s)\tForce/AI 1 (N)\tAcc/AI 2 (g)"]
    text(p, lines + table([T, FORCE, ACC / G], "\t"), "utf-8-sig", "\r\n")


@case("bk-pulse-time.txt")
def _(p):
    lines = ["[Header Version:]\t3", "Title1:\tTime(Force) - Input", "X-axis title:\tTime", "X-axis unit:\ts", "X-axis size:\t%d" % N, "X-axis delta:\t%.10g" % (1 / FS), "",
             "Time [s]\tForce [N]\tAcceleration [m/s^2]"]
    text(p, lines + table([T, FORCE, ACC], "\t"), "cp1252", "\r\n")


@case("polytec-psv-complex.txt", ["--references", "1"])
def _(p):
    lines = ["Source File Name:\tplate.svd", "Point Index:\t1", "Component:\tRoot", "Signal:\tFFT - Vib & Ref1 - H1 Velocity / Force", "",
             "Frequency\tReal ( H1 Velocity / Force )\tImaginary ( H1 Velocity / Force )", "[ Hz ]\t[ (m/s) / N ]\t[ (m/s) / N ]"]
    text(p, lines + table([FREQ, MOBILITY.real, MOBILITY.imag], "\t"), "cp1252", "\r\n")


@case("frf-several-responses.csv", (), "opens")
def _(p):
    heads = ["Frequenz [Hz]"] + [h for k in (1, 2) for h in (f"Betrag H({k},1) [(m/s²)/N]", f"Phase H({k},1) [°]")]
    text(p, [";".join(heads)] + table([FREQ, SIZE, PHASE, SIZE / 2, PHASE], ";", True), "cp1252", "\r\n")


@case("frf-named-channels.csv")
def _(p):
    text(p, ["Frequency (Hz),Acc 1+Z / Force 1+Z Real (g/N),Acc 1+Z / Force 1+Z Imag (g/N),Coherence Acc 1+Z / Force 1+Z"]
         + table([FREQ, ACCELERANCE.real / G, ACCELERANCE.imag / G, 0.999 + 0 * FREQ], ","))


@case("testlab-points-above.txt")
def _(p):
    lines = ["Test.Lab\tBlock export", "Function class\tFRF", "Point\tBeam:1\tDirection\t+Z", "Reference\tBeam:1\tDirection\t+Z", "",
             "Frequency\tReal\tImaginary", "Hz\t(m/s^2)/N\t(m/s^2)/N"]
    text(p, lines + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], "\t"), "utf-8", "\r\n")


# LabVIEW measurement files.


def lvm_head(decimal, columns):
    return ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", f"Decimal_Separator\t{decimal}", "Multi_Headings\tYes", f"X_Columns\t{columns}",
            "Time_Pref\tRelative", "Operator\tuser", "Date\t2024/03/01", "Time\t11:58:01,1234", "***End_of_Header***\t", ""]


def lvm_segment(start, stop, comma=True):
    rows = slice(start, stop)
    head = ["Channels\t2\t\t\t", f"Samples\t{stop - start}\t\t{stop - start}\t", "Date\t2024/03/01\t\t2024/03/01\t", f"Time\t11:58:0{1 + start // 500},0\t\t11:58:01,0\t", "Y_Unit_Label\tN\t\tm/s^2\t",
            "X_Dimension\tTime\t\tTime\t", f"X0\t{number(T[start], comma)}\t\t{number(T[start], comma)}\t", f"Delta_X\t{number(1 / FS, comma)}\t\t{number(1 / FS, comma)}\t", "***End_of_Header***\t\t\t\t",
            "X_Value\tForce\tX_Value\tAcc\tComment"]
    return head + [row + "\t" for row in table([T[rows], FORCE[rows], T[rows], ACC[rows]], "\t", comma)] + [""]


@case("lvm-multi-headings.lvm")
def _(p):
    text(p, lvm_head(",", "Multi") + lvm_segment(0, 300) + lvm_segment(300, N), "cp1252", "\r\n")


# MAT, spreadsheets, Universal Files.


def signal(values, unit, name, start, step, label, kind):
    quantity = lambda word: {"label": word, "quantity_type": "none", "unit_transformation": {"log_reference": 0.0, "factor": 1.0, "offset": 0.0}}
    return {"x_values": {"start_value": start, "increment": step, "number_of_values": float(len(values)), "quantity": quantity(label)},
            "y_values": {"values": values[:, None], "quantity": quantity(unit)},
            "function_record": {"name": name, "type": kind, "primary_channel": {"name": name, "point_id": name.split(":")[1] if ":" in name else "", "direction": "+Z"}, "creation_time": "2024-03-01T11:58:01"}}


@case("simcenter-two-signals.mat")
def _(p):
    held = {"Signal_0": signal(FORCE, "N", "Beam:1:+Z Force", 0.0, 1 / FS, "s", "Signal"), "Signal_1": signal(ACC / G, "g", "Beam:1:+Z", 0.0, 1 / FS, "s", "Signal")}
    scipy.io.savemat(p, held, do_compression=True, long_field_names=True)


@case("simcenter-frf-and-coherence.mat")
def _(p):
    frf = signal(ACCELERANCE, "(m/s^2)/N", "FRF Beam:1:+Z/Beam:1:+Z", 5.0, 0.25, "Hz", "FrequencyResponse")
    for word in ("primary_channel", "secondary_channel"):
        frf["function_record"][word] = {"point": "Beam:1", "direction": "+Z", "name": "Beam:1:+Z"}
    coherence = signal(0.999 + 0 * FREQ, "/", "Coherence Beam:1:+Z/Beam:1:+Z", 5.0, 0.25, "Hz", "Coherence")
    scipy.io.savemat(p, {"FRF_0": frf, "Coherence_0": coherence}, do_compression=True, long_field_names=True)


@case("three-sheets.xlsx")
def _(p):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Info"
    for row in [["Auftrag", "4711"], ["Prüfer", "Müller"], ["Datum", "01.03.2024"]]:
        sheet.append(row)
    sensors = book.create_sheet("Sensoren")
    for row in [["Kanal", "Typ", "Empfindlichkeit"], ["1", "Kraft", "11,2 mV/N"], ["2", "Beschleunigung", "100 mV/g"]]:
        sensors.append(row)
    data = book.create_sheet("Messdaten")
    data.append(["Zeit", "Kraft", "Beschleunigung"])
    data.append(["s", "N", "m/s²"])
    for row in zip(T, FORCE, ACC):
        data.append([float(x) for x in row])
    book.save(p)


@case("mixed-functions.uff", (), "opens")
def _(p):
    time = [line for part in (set58(1, FORCE, T, response=(1, 3), reference=(0, 0), ordinate=(13, "N"), denominator=(0, "")),
                              set58(1, ACC, T, response=(1, 3), reference=(0, 0), ordinate=(12, "m/s^2"), denominator=(0, ""))) for line in part]
    frfs = []
    for node, sign, direction in ((1, 1, 3), (2, -1, -3), (3, 1, 1)):
        more = dict(response=(node, direction), reference=(1, 3))
        frfs += set58(4, sign * ACCELERANCE / node, FREQ, **more)
        frfs += set58(6, 0.999 + 0 * FREQ, FREQ, ordinate=(0, ""), denominator=(0, ""), **more)
    power = set58(2, 2.0 + 0 * FREQ, FREQ, response=(1, 3), reference=(1, 3), ordinate=(13, "N^2"), denominator=(0, ""))
    text(p, HEADER + UNITS_SI + power + frfs + time, end="\r\n")


if __name__ == "__main__":
    try_import.main()
