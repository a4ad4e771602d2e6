"""Files as laboratories export them, tried with `dashpot import` and `dashpot identify`.

    pip install numpy scipy h5py npTDMS openpyxl hdf5storage pyuff
    python scripts/interchange/try_import.py target/debug/dashpot /tmp/trial

All files hold the same test: 2 kg on a spring at 21 Hz with a dashpot of C = 8 N s/m, driven by 5 N at 20 Hz (time records), or
its frequency response. Each ends in a project in which `identify` finds C at the one DOF, or in one clear line where no
program could know better; the table that is printed says which. A development tool: no test needs it.
"""

import datetime
import io
import json
import pathlib
import subprocess
import sys
import wave

import h5py
import hdf5storage
import numpy as np
import openpyxl
import pyuff
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

M, F0, C = 2.0, 21.0, 8.0
K = M * (2 * np.pi * F0) ** 2
G = 9.80665
FS, N = 1000.0, 700
T = np.arange(N) / FS
W = 2 * np.pi * 20.0
H = 1.0 / (K - M * W**2 + 1j * W * C)
FORCE = 5.0 * np.cos(W * T)
DISP = np.real(5.0 * H * np.exp(1j * W * T))
ACC = -W**2 * DISP
VEL = np.real(1j * W * 5.0 * H * np.exp(1j * W * T))
FREQ = np.arange(5.0, 45.0, 0.25)
OMEGA = 2 * np.pi * FREQ
RECEPTANCE = 1.0 / (K - M * OMEGA**2 + 1j * OMEGA * C)
ACCELERANCE = -OMEGA**2 * RECEPTANCE
MOBILITY = 1j * OMEGA * RECEPTANCE
LINE = "line"

CASES = []


def case(name, arguments=(), expect="c"):
    """Registers a writer of the file `name`; expect: "c" (the dashpot is found), "opens" (a project), LINE (refused in one line)."""

    def register(writer):
        CASES.append((name, writer, list(arguments), expect))
        return writer

    return register


def number(value, comma=False, digits=9):
    text = f"{value:.{digits}g}"
    return text.replace(".", ",") if comma else text


def table(columns, separator, comma=False, digits=9):
    return [separator.join(number(v, comma, digits) if not isinstance(v, str) else v for v in row) for row in zip(*columns)]


def text(path, lines, encoding="utf-8", end="\n"):
    path.write_bytes(end.join([*lines, ""]).encode(encoding))


# Text tables of time records.


@case("german-excel.csv")
def _(p):
    text(p, ["Zeit;Kraft;Beschl. Punkt 1", "s;N;m/s²"] + table([T, FORCE, ACC], ";", True), "utf-8-sig", "\r\n")


@case("german-latin1-g.csv")
def _(p):
    text(p, ["Prüfling: Träger", "", "Zeit [s];Kraft [N];Beschleunigung [g]"] + table([T, FORCE, ACC / G], ";", True), "latin-1")


@case("utf16-tabs-comma.txt")
def _(p):
    text(p, ["Zeit [s]\tKraft [N]\tBeschleunigung [m/s²]"] + table([T, FORCE, ACC], "\t", True), "utf-16")


@case("utf16-no-bom.txt")
def _(p):
    text(p, ["Time [s]\tForce [N]\tAcc [m/s2]"] + table([T, FORCE, ACC], "\t"), "utf-16-le")


@case("time-in-ms.csv")
def _(p):
    text(p, ["Time (ms),Force (N),Acc (g)"] + table([T * 1e3, FORCE, ACC / G], ","))


@case("time-in-microseconds.csv")
def _(p):
    text(p, ["Time [us],Force [N],Acc [g]"] + table([T * 1e6, FORCE, ACC / G], ","))


@case("iso-dates.csv")
def _(p):
    start = datetime.datetime(2024, 3, 1, 12, 0, 0)
    times = [(start + datetime.timedelta(milliseconds=1000 * t)).isoformat(timespec="milliseconds") for t in T]
    text(p, ["timestamp,force_N,acc_g"] + table([times, FORCE, ACC / G], ","))


@case("german-dates.csv")
def _(p):
    start = datetime.datetime(2024, 3, 1, 12, 0, 0)
    times = [(start + datetime.timedelta(milliseconds=1000 * t)).strftime("%d.%m.%Y %H:%M:%S,%f")[:-3] for t in T]
    text(p, ["Datum/Zeit;Kraft [N];Beschleunigung [m/s²]"] + table([times, FORCE, ACC], ";", True))


@case("american-dates.csv")
def _(p):
    start = datetime.datetime(2024, 3, 1, 12, 59, 59, 900000)
    times = [(start + datetime.timedelta(milliseconds=1000 * t)).strftime("%m/%d/%Y %I:%M:%S.%f")[:-3] + " PM" for t in T[:100]]
    more = [(start + datetime.timedelta(milliseconds=1000 * t)).strftime("%m/%d/%Y %I:%M:%S.%f")[:-3] + " PM" for t in T[100:]]
    text(p, ["Date Time,Force (lbf),Acc (g)"] + table([times + more, FORCE / 4.4482216152605, ACC / G], ","))


@case("clock-only.csv")
def _(p):
    times = [f"12:00:{t:06.3f}" for t in T]
    text(p, ["Time,Force [N],Acceleration [m/s^2]"] + table([times, FORCE, ACC], ","))


@case("date-and-time-columns.csv")
def _(p):
    times = [f"12:00:{t:06.3f}" for t in T]
    text(p, ["Date,Time,Force [N],Acceleration [m/s^2]"] + table([["2024-03-01"] * N, times, FORCE, ACC], ","))


@case("dewesoft.txt")
def _(p):
    head = ["File name: Test_0001.dxd", "Start time: 3/1/2024 12:00:00.000", "Number of channels: 2", "Sample rate: 1000 Hz",
            "Store type: always fast", "Post time: ", "Global header information: ", "", "Events", "Event Type\tEvent Time\tComment",
            "1\t0.0000\tstoring started at 12:00:00.000", "2\t0.7000\tstoring stopped at 12:00:00.700", "", "Data1",
            "Time (s)\tForce (N) \tAcc1 (m/s2) "]
    text(p, head + table([T, FORCE, ACC], "\t"), end="\r\n")


@case("dewesoft-semicolon.csv")
def _(p):
    head = ["Data;", "Time;AI 1/Kraft;AI 2/Beschleunigung", "s;N;g"]
    text(p, head + table([T, FORCE, ACC / G], ";", True))


@case("catman.asc")
def _(p):
    head = ["HBM_CATMAN_DATAFILE\t5.4", "VERSION\t1", "NUMBER OF CHANNELS=3", "MAXLINES=700", "Zeit  1 - Standardmessrate [s]\tKraft [N]\tAcc_1 [m/s²]",
            "s\tN\tm/s²", "Kommentar\t\t", "Sample rate=1000.0 Hz\tSample rate=1000.0 Hz\tSample rate=1000.0 Hz", "SensorType=\tU9C/1kN\tB12"]
    text(p, head + table([T, FORCE, ACC], "\t", True), "latin-1")


@case("bk-connect.csv")
def _(p):
    head = ["BK Connect Export,,", "Function,Time,Time", "Signal,Force 1,Acc 1", "Unit,N,m/s²", "X-axis,s,s", "Delta X,0.001,0.001", "X,Y,Y"]
    text(p, head + table([T, FORCE, ACC], ","))


@case("testlab.txt")
def _(p):
    head = ["Point\tRun 1:Shaker:+Z\tRun 1:Plate:1:+Z", "Function class\tTime\tTime", "X axis unit\ts\ts", "Y axis unit\tN\tg", "Linear\tReal\tReal", "s\tN\tg"]
    text(p, head + table([T, FORCE, ACC / G], "\t"))


@case("mp-vibcontrol.txt")
def _(p):
    head = ["; m+p international", "; Project : Beam", "; Sample frequency : 1000.000 Hz", "", "Time[s]    Force[N]    Acceleration[m/s^2]"]
    text(p, head + table([T, FORCE, ACC], "    "))


@case("commented-header.txt")
def _(p):
    text(p, ["# recorded by daq.py", "# fs: 1000 Hz", "# time [s], force [N], acc [m/s^2]"] + table([T, FORCE, ACC], ", "))


@case("per-cent-header.txt")
def _(p):
    text(p, ["% t(s) F(N) a(m/s^2)"] + table([T, FORCE, ACC], "  "))


@case("rate-in-header.csv")
def _(p):
    text(p, ["Sampling rate;1000 Hz", "Kraft [N];Beschleunigung [m/s²]"] + table([FORCE, ACC], ";", True))


@case("no-time.csv", ["--sampling-hz", "1000"])
def _(p):
    text(p, ["Force [N],Acc [m/s^2]"] + table([FORCE, ACC], ","))


@case("no-time-no-rate.csv", (), LINE)
def _(p):
    text(p, ["Force [N],Acc [m/s^2]"] + table([FORCE, ACC], ","))


@case("no-header.csv", (), LINE)
def _(p):
    text(p, table([T, FORCE, ACC], ","))


@case("sample-number.csv", ["--sampling-hz", "1000"])
def _(p):
    text(p, ["Sample,Force [N],Acc [m/s^2]"] + table([np.arange(N), FORCE, ACC], ","))


@case("kilonewton-millimetre.csv")
def _(p):
    text(p, ["Zeit [s];Kraft [kN];Weg [mm]"] + table([T, FORCE / 1e3, DISP * 1e3], ";", True))


@case("pound-inch.csv")
def _(p):
    text(p, ["Time (sec),Load (lbf),Displacement (in)"] + table([T, FORCE / 4.4482216152605, DISP / 0.0254], ","))


@case("micrometre-latin1.txt")
def _(p):
    text(p, ["t/s\tF/N\ts/µm"] + table([T, FORCE, DISP * 1e6], "\t", True), "latin-1")


@case("vibrometer-mm-s.csv")
def _(p):
    text(p, ["Time [ s ],Force [ N ],Vibrometer Velocity [ mm/s ]"] + table([T, FORCE, VEL * 1e3], ","))


@case("milli-g.csv")
def _(p):
    text(p, ["time_s,force_N,acc_mg"] + table([T, FORCE, ACC / G * 1e3], ","))


@case("suffix-units.csv")
def _(p):
    text(p, ["time_s,force_N,acceleration_m_s2"] + table([T, FORCE, ACC], ","))


@case("sensitivity-row.csv")
def _(p):
    head = ["Channel;Time;Force;Acc 1", "Unit;s;mV;mV", "Sensitivity;;22.5 mV/N;100 mV/g"]
    text(p, head + [";" + row for row in table([T, FORCE * 22.5, ACC / G * 100], ";")])


@case("sensitivity-in-name.csv")
def _(p):
    text(p, ["Time [s];Force (22.5 mV/N) [mV];Acc 1 (100 mV/g) [mV]"] + table([T, FORCE * 22.5, ACC / G * 100], ";"))


@case("volts-only.csv", (), "opens")
def _(p):
    text(p, ["Time [s],AI0 [V],AI1 [V]"] + table([T, FORCE, ACC], ","))


@case("fixed-width.txt")
def _(p):
    rows = [f"{t:10.4f}{f:14.6E}{a:14.6E}" for t, f, a in zip(T, FORCE, ACC)]
    text(p, ["  TIME[s]      FORCE[N]    ACC[m/s2]"] + rows)


@case("fixed-width-touching.txt")
def _(p):
    rows = [f"{t:8.4f}{f:13.6E}{a:13.6E}" for t, f, a in zip(T, FORCE, ACC)]
    text(p, ["TIME[s] FORCE[N] ACC[m/s2]"] + rows)


@case("thousands.csv")
def _(p):
    def german(v):
        return f"{v:,.4f}".replace(",", "#").replace(".", ",").replace("#", ".")
    rows = [f"{number(t, True)};{german(f)};{german(a)}" for t, f, a in zip(T, FORCE * 1e3, ACC * 1e3)]
    text(p, ["Zeit [s];Kraft [mN];Beschleunigung [mm/s²]"] + rows)


@case("quoted.csv")
def _(p):
    text(p, ['"Time [s]","Force [N]","Acc, point 1 [m/s^2]"'] + ['"' + row.replace(",", '","') + '"' for row in table([T, FORCE, ACC], ",")])


@case("pipes.txt")
def _(p):
    text(p, ["| Time [s] | Force [N] | Acc [m/s^2] |"] + ["| " + row + " |" for row in table([T, FORCE, ACC], " | ")])


@case("time-column-each.csv")
def _(p):
    text(p, ["Time [s],Force [N],Time [s],Acc [m/s^2]"] + table([T, FORCE, T, ACC], ","))


@case("x-y-pairs.csv")
def _(p):
    text(p, ["Force,,Acc,", "X [s],Y [N],X [s],Y [m/s^2]"] + table([T, FORCE, T, ACC], ","))


@case("index-and-time.csv")
def _(p):
    text(p, [",time,force,acc"] + table([np.arange(N), T, FORCE, ACC], ","))


@case("trailing-words.csv")
def _(p):
    text(p, ["Time [s];Force [N];Acc [g];Comment"] + [row + (";start" if i == 0 else ";") for i, row in enumerate(table([T, FORCE, ACC / G], ";"))] + ["End of file"])


@case("exponents-comma.txt")
def _(p):
    rows = ["\t".join(f"{v:.6E}".replace(".", ",") for v in row) for row in zip(T, FORCE, ACC)]
    text(p, ["Temps (s)\tForce (N)\tAccélération (m/s²)"] + rows)


@case("italian.csv")
def _(p):
    text(p, ["Tempo [s];Forza [N];Accelerazione [m/s^2]"] + table([T, FORCE, ACC], ";", True))


@case("french-velocity.csv")
def _(p):
    text(p, ["Temps [s];Effort [N];Vitesse [m/s]"] + table([T, FORCE, VEL], ";", True))


@case("blank-lines-nan.csv")
def _(p):
    rows = table([T, FORCE, ACC], ",")
    text(p, ["", "time,force,acc", "s,N,m/s^2", ""] + rows + ["", ""])


@case("nan-within.csv", (), LINE)
def _(p):
    rows = table([T, FORCE, ACC], ",")
    rows[100] = "0.1,NaN,0.5"
    text(p, ["time [s],force [N],acc [m/s^2]"] + rows)


@case("sigma.lvm")
def _(p):
    head = ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", "Decimal_Separator\t,", "Multi_Headings\tYes",
            "X_Columns\tOne", "Time_Pref\tRelative", "Operator\tx", "Date\t2024/03/01", "Time\t12:00:00,0", "***End_of_Header***\t", "\t"]
    lines = list(head)
    for block in range(2):
        rows = slice(block * N // 2, (block + 1) * N // 2)
        lines += ["Channels\t2\t\t", f"Samples\t{N // 2}\t{N // 2}\t", "Date\t2024/03/01\t2024/03/01\t", f"Time\t12:00:0{block},0\t12:00:0{block},0\t",
                  "Y_Unit_Label\tN\tm/s^2\t", "X_Dimension\tTime\tTime\t", f"X0\t{number(T[rows][0], True)}\t{number(T[rows][0], True)}\t", "Delta_X\t0,001\t0,001\t",
                  "***End_of_Header***\t\t\t", "X_Value\tForce\tAcc 1\tComment"]
        lines += [row + "\t" for row in table([T[rows], FORCE[rows], ACC[rows]], "\t", True)]
        lines += ["", ]
    text(p, lines, end="\r\n")


@case("many-columns.lvm")
def _(p):
    head = ["LabVIEW Measurement\t", "Separator\tTab", "Decimal_Separator\t,", "Multi_Headings\tNo", "X_Columns\tMulti", "***End_of_Header***\t",
            "Channels\t2\t\t\t", f"Samples\t{N}\t\t{N}\t", "Y_Unit_Label\tNewtons\t\tg\t", "X_Dimension\tTime\t\tTime\t", "X0\t0,0\t\t0,0\t", "Delta_X\t0,001\t\t0,001\t",
            "***End_of_Header***\t\t\t\t", "X_Value\tForce\tX_Value\tAcc 1\tComment"]
    text(p, head + [row + "\t" for row in table([T, FORCE, T, ACC / G], "\t", True)], end="\r\n")


# Structured files of time records.


@case("plain.mat")
def _(p):
    scipy.io.savemat(p, {"t": T, "force": FORCE, "acc": ACC})


@case("fs.mat")
def _(p):
    scipy.io.savemat(p, {"fs": FS, "Force": FORCE[:, None], "Acc1": ACC[:, None]})


@case("v4.mat")
def _(p):
    scipy.io.savemat(p, {"time": T, "F": FORCE, "acc": ACC}, format="4")


@case("timetable-like.mat")
def _(p):
    scipy.io.savemat(p, {"data": {"Time": T, "Variables": np.column_stack([FORCE, ACC]),
                                  "Properties": {"VariableNames": np.array(["Force", "Acc1"], dtype=object),
                                                 "VariableUnits": np.array(["N", "m/s^2"], dtype=object)}}})


@case("columns-and-names.mat")
def _(p):
    scipy.io.savemat(p, {"data": np.column_stack([T, FORCE, ACC / G]), "names": np.array(["time", "Force", "Acc 1"], dtype=object),
                         "units": np.array(["s", "N", "g"], dtype=object)})


@case("struct-array.mat")
def _(p):
    kind = [("name", object), ("unit", object), ("data", object), ("fs", object)]
    channels = np.zeros(2, dtype=kind)
    channels[0] = ("Force", "N", FORCE, FS)
    channels[1] = ("Acc 1", "m/s^2", ACC, FS)
    scipy.io.savemat(p, {"channel": channels})


def lms(values, label, name):
    return {"x_values": {"start_value": 0.0, "increment": 1 / FS, "number_of_values": float(N), "quantity": {"label": "s"}},
            "y_values": {"values": values, "quantity": {"label": label}}, "function_record": {"name": name, "type": "Time"}}


@case("testlab.mat")
def _(p):
    scipy.io.savemat(p, {"Signal_0": lms(FORCE[:, None], "N", "Force:1:+Z"), "Signal_1": lms(ACC[:, None], "m/s^2", "Plate:1:+Z")})


@case("testlab-one.mat")
def _(p):
    one = lms(np.column_stack([FORCE, ACC]), "", "")
    one["function_record"] = {"name": np.array(["Force:1:+Z", "Acc:1:+Z"], dtype=object), "type": "Time"}
    one["y_values"]["quantity"] = {"label": np.array(["N", "m/s^2"], dtype=object)}
    scipy.io.savemat(p, {"signal": one})


@case("iddata-like.mat")
def _(p):
    scipy.io.savemat(p, {"z": {"OutputData": ACC[:, None], "InputData": FORCE[:, None], "Ts": 1 / FS, "OutputName": "acc", "InputName": "force",
                               "OutputUnit": "m/s^2", "InputUnit": "N", "TimeUnit": "seconds"}})


@case("iddata-fields.mat")
def _(p):
    scipy.io.savemat(p, {"z": {"y": ACC[:, None], "u": FORCE[:, None], "Ts": 1 / FS, "OutputName": "acc 1", "InputName": "force", "OutputUnit": "m/s^2", "InputUnit": "N"}})


@case("channels-dewesoft.mat")
def _(p):
    scipy.io.savemat(p, {"Data1_Force": np.column_stack([T, FORCE]), "Data1_Acc_1": np.column_stack([T, ACC]), "Sample_rate": FS})


@case("simulink.mat")
def _(p):
    scipy.io.savemat(p, {"out": {"time": T, "signals": {"values": np.column_stack([FORCE, ACC]), "dimensions": 2.0, "label": np.array(["force", "acc"], dtype=object)}}})


@case("v73.mat")
def _(p):
    hdf5storage.savemat(str(p), {"t": T, "force": FORCE, "acc": ACC}, format="7.3")


@case("v73-struct.mat")
def _(p):
    hdf5storage.savemat(str(p), {"run": {"t": T, "force": FORCE, "acc": ACC, "fs": FS}}, format="7.3")


@case("attributes.h5")
def _(p):
    with h5py.File(p, "w") as f:
        run = f.create_group("run 1")
        run.attrs["sampling_rate"] = FS
        for name, values, unit in [("force", FORCE, "N"), ("acc_1", ACC / G, "g")]:
            run.create_dataset(name, data=values, compression="gzip").attrs["units"] = unit


@case("columns.h5")
def _(p):
    with h5py.File(p, "w") as f:
        data = f.create_dataset("data", data=np.column_stack([T, FORCE, ACC]), chunks=True)
        data.attrs["columns"] = ["time", "force", "acc 1"]
        data.attrs["units"] = ["s", "N", "m/s^2"]


@case("compound.h5")
def _(p):
    rows = np.zeros(N, dtype=[("time", "f8"), ("force", "f4"), ("acc", "f8")])
    rows["time"], rows["force"], rows["acc"] = T, FORCE, ACC
    with h5py.File(p, "w") as f:
        f.create_dataset("table", data=rows)


@case("scale.h5")
def _(p):
    with h5py.File(p, "w") as f:
        time = f.create_dataset("time", data=T)
        time.make_scale("time")
        for name, values, unit in [("force", FORCE, "N"), ("acc", ACC, "m/s^2")]:
            data = f.create_dataset(name, data=values.astype("f4"))
            data.attrs["unit"] = unit
            data.dims[0].attach_scale(time)


@case("arrays.npz")
def _(p):
    np.savez(p, time=T, force=FORCE, acc=ACC)


@case("packed.npz")
def _(p):
    np.savez_compressed(p, fs=FS, data=np.column_stack([FORCE, ACC]), channels=np.array(["force", "acc"]))


@case("structured.npy", (), LINE)
def _(p):
    rows = np.zeros(N, dtype=[("time", "f8"), ("force", "f8"), ("acc", "f8")])
    rows["time"], rows["force"], rows["acc"] = T, FORCE, ACC
    np.save(p, rows)


@case("columns.npy", (), LINE)
def _(p):
    np.save(p, np.column_stack([T, FORCE, ACC]))


def waveform(name, values, unit):
    return ChannelObject("Measurement", name, values, {"wf_increment": 1 / FS, "wf_start_offset": 0.0, "wf_samples": N, "unit_string": unit})


@case("waveform.tdms")
def _(p):
    with TdmsWriter(p) as writer:
        writer.write_segment([RootObject({}), GroupObject("Measurement"), waveform("Force", FORCE, "N"), waveform("Acc 1", ACC / G, "g")])


@case("time-channel.tdms")
def _(p):
    with TdmsWriter(p) as writer:
        writer.write_segment([ChannelObject("Log", "Time", T, {"unit_string": "s"}), ChannelObject("Log", "Force", FORCE, {"unit_string": "N"}),
                              ChannelObject("Log", "Acceleration", ACC, {"unit_string": "m/s^2"})])


@case("timestamps.tdms")
def _(p):
    stamps = np.datetime64("2024-03-01T12:00:00.000000") + (T * 1e6).astype("timedelta64[us]")
    with TdmsWriter(p) as writer:
        writer.write_segment([ChannelObject("Log", "Time", stamps), ChannelObject("Log", "Force", FORCE, {"unit_string": "N"}),
                              ChannelObject("Log", "Acceleration", ACC, {"unit_string": "m/s^2"})])


@case("stereo.wav", (), "opens")
def _(p):
    with wave.open(str(p), "wb") as f:
        f.setnchannels(2), f.setsampwidth(2), f.setframerate(1000)
        f.writeframes((np.column_stack([FORCE / 6, ACC / np.abs(ACC).max() / 1.1]) * 32767).astype("<i2").tobytes())


def book(path, rows, name="Tabelle1", more=()):
    file = openpyxl.Workbook()
    sheet = file.active
    sheet.title = name
    for row in rows:
        sheet.append(row)
    for other, cells in more:
        extra = file.create_sheet(other)
        for row in cells:
            extra.append(row)
    file.save(path)


def listed(*columns):
    return [list(map(lambda v: v if isinstance(v, (str, datetime.datetime)) else float(v), row)) for row in zip(*columns)]


@case("german.xlsx")
def _(p):
    book(p, [["Versuch 7"], [], ["Zeit", "Kraft", "Beschleunigung"], ["s", "N", "g"]] + listed(T, FORCE, ACC / G))


@case("dates.xlsx")
def _(p):
    start = datetime.datetime(2024, 3, 1, 12, 0, 0)
    times = [start + datetime.timedelta(milliseconds=float(1000 * t)) for t in T]
    book(p, [["Time", "Force [N]", "Acc [m/s^2]"]] + listed(times, FORCE, ACC))


@case("text-numbers.xlsx")
def _(p):
    book(p, [["Zeit [s]", "Kraft [N]", "Weg [mm]"]] + [[number(v, True) for v in row] for row in zip(T, FORCE, DISP * 1e3)])


@case("second-sheet.xlsx")
def _(p):
    book(p, [["Customer", "ACME"], ["Sensor", "B&K 4507"]], "Info", [("Data", [["Time [s]", "Force [N]", "Acc [m/s^2]"]] + listed(T, FORCE, ACC))])


@case("offset-table.xlsx")
def _(p):
    book(p, [[], ["", "", "Messung"], ["", "", "Zeit [s]", "Kraft [N]", "Beschl. [m/s²]"]] + [[None, None, *row] for row in listed(T, FORCE, ACC)])


def uff_time(name, values, node, unit, kind):
    return {"type": 58, "func_type": 1, "rsp_node": node, "rsp_dir": 3, "ref_node": 0, "ref_dir": 0, "data": values, "x": T, "id1": name, "rsp_ent_name": "NONE",
            "ref_ent_name": "NONE", "abscissa_spacing": 1, "abscissa_min": 0.0, "abscissa_inc": 1 / FS, "spec_data_type": kind, "ordinate_spec_data_type": kind,
            "ordinate_axis_units_lab": unit, "abscissa_spec_data_type": 17, "abscissa_axis_units_lab": "s", "orddenom_spec_data_type": 0,
            "orddenom_axis_units_lab": "NONE", "binary": 0, "ord_data_type": 4}


@case("time.uff")
def _(p):
    file = pyuff.UFF(str(p))
    file.write_sets(uff_time("Force", FORCE, 1, "N", 13), "overwrite")
    file.write_sets(uff_time("Acc", ACC, 1, "m/s^2", 12), "add")


# Frequency responses.


def polar(values):
    return np.abs(values), np.degrees(np.unwrap(np.angle(values)))


@case("frf-real-imag.csv")
def _(p):
    text(p, ["Frequency [Hz],H11 Real [m/s^2/N],H11 Imag [m/s^2/N]"] + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], ","))


@case("frf-bare-words.csv", ["--form", "accelerance"])
def _(p):
    text(p, ["f;Re;Im"] + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], ";", True))


@case("frf-magnitude-phase.csv")
def _(p):
    size, phase = polar(ACCELERANCE)
    text(p, ["Freq (Hz),Magnitude (g/N),Phase (deg)"] + table([FREQ, size / G, phase], ","))


@case("frf-mobility-radians.csv", ["--form", "mobility"])
def _(p):
    size, phase = polar(MOBILITY)
    text(p, ["Freq,Mag,Phase"] + table([FREQ, size, np.radians(phase)], ","))


@case("frf-decibel.csv")
def _(p):
    size, phase = polar(ACCELERANCE)
    text(p, ["Frequenz;Betrag;Phase;Kohärenz", "Hz;dB re 1 (m/s²)/N;°;-"] + table([FREQ, 20 * np.log10(size), phase, 0.999 + 0 * FREQ], ";", True))


@case("frf-compliance.txt")
def _(p):
    text(p, ["Frequency(Hz)\tCompliance Real (mm/N)\tCompliance Imaginary (mm/N)"] + table([FREQ, RECEPTANCE.real * 1e3, RECEPTANCE.imag * 1e3], "\t"))


@case("frf-complex-text.csv", ["--form", "receptance"])
def _(p):
    text(p, ["frequency,H"] + [f"{f},{h.real:.8e}{h.imag:+.8e}j" for f, h in zip(FREQ, RECEPTANCE)])


@case("frf-complex-comma.csv", ["--form", "accelerance"])
def _(p):
    text(p, ["Frequenz;H11"] + [f"{f};{h.real:.8e}{h.imag:+.8e}i".replace(".", ",") for f, h in zip(FREQ, ACCELERANCE)])


@case("frf-complex-blanks.csv", ["--form", "accelerance"])
def _(p):
    text(p, ["Frequency,FRF"] + [f"{f},{h.real:.8e} {'-' if h.imag < 0 else '+'} {abs(h.imag):.8e}i" for f, h in zip(FREQ, ACCELERANCE)])


@case("frf-two-header-rows.xlsx")
def _(p):
    book(p, [["Frequency", "Point 1/Point 1", None], ["Hz", "Real", "Imag"], [None, "m/s²/N", "m/s²/N"]] + listed(FREQ, ACCELERANCE.real, ACCELERANCE.imag))


@case("frf-unit-per-part.xlsx")
def _(p):
    size, phase = polar(ACCELERANCE)
    book(p, [["f [Hz]", "|H| [m/s²/N]", "phi [°]"]] + listed(FREQ, size, phase))


@case("frf-no-header.txt", ["--columns", "real-imag", "--form", "accelerance"])
def _(p):
    text(p, table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], " "))


@case("frf-omega.csv")
def _(p):
    text(p, ["omega [rad/s],Re(H) [m/N],Im(H) [m/N]"] + table([OMEGA, RECEPTANCE.real, RECEPTANCE.imag], ","))


@case("frf.mat", ["--form", "accelerance"])
def _(p):
    scipy.io.savemat(p, {"f": FREQ, "FRF": ACCELERANCE[:, None]})


@case("frf-parts.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"freq": FREQ, "H_re": RECEPTANCE.real, "H_im": RECEPTANCE.imag})


@case("frf-cube.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"f": FREQ, "H": RECEPTANCE[:, None, None] * np.array([[[1.0, 1e-6]]])})


@case("frf-idfrd.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"g": {"Frequency": OMEGA, "FrequencyUnit": "rad/TimeUnit", "ResponseData": RECEPTANCE[None, None, :], "InputName": "force", "OutputName": "disp"}})


@case("frf-testlab.mat")
def _(p):
    one = {"x_values": {"start_value": 5.0, "increment": 0.25, "number_of_values": float(len(FREQ)), "quantity": {"label": "Hz"}},
           "y_values": {"values": ACCELERANCE[:, None], "quantity": {"label": "(m/s^2)/N"}}, "function_record": {"name": "FRF Plate:1:+Z/Shaker:1:+Z", "type": "FRF"}}
    scipy.io.savemat(p, {"FRF": one})


@case("frf.npz", ["--form", "mobility"])
def _(p):
    np.savez(p, freq=FREQ, mag=np.abs(MOBILITY), phase=np.angle(MOBILITY))


@case("frf-complex.npz", ["--form", "mobility"])
def _(p):
    np.savez(p, f=FREQ, H=MOBILITY)


@case("frf.h5")
def _(p):
    with h5py.File(p, "w") as f:
        group = f.create_group("frf")
        group.create_dataset("frequency", data=FREQ).attrs["unit"] = "Hz"
        group.create_dataset("H_1_1", data=ACCELERANCE).attrs["unit"] = "(m/s^2)/N"


@case("frf.uff")
def _(p):
    file = pyuff.UFF(str(p))
    file.write_sets({"type": 58, "func_type": 4, "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3, "data": ACCELERANCE, "x": FREQ, "id1": "FRF",
                     "rsp_ent_name": "NONE", "ref_ent_name": "NONE", "abscissa_spacing": 1, "abscissa_min": 5.0, "abscissa_inc": 0.25, "ordinate_spec_data_type": 12,
                     "ordinate_axis_units_lab": "m/s^2", "orddenom_spec_data_type": 13, "orddenom_axis_units_lab": "N", "abscissa_spec_data_type": 18,
                     "abscissa_axis_units_lab": "Hz", "binary": 0, "ord_data_type": 6}, "overwrite")


@case("psd.csv", (), LINE)
def _(p):
    text(p, ["Frequency [Hz],PSD [g^2/Hz]"] + table([FREQ, np.abs(ACCELERANCE) ** 2], ","))


@case("stepped-sine.csv")
def _(p):
    size, phase = polar(ACCELERANCE)
    text(p, ["Frequency [Hz];Force [N];Acceleration [g];Phase [deg]"] + table([FREQ, 5 + 0 * FREQ, 5 * size / G, phase], ";"))


def run(binary, folder, name, arguments, expect):
    project = folder / (name + ".toml")
    project.unlink(missing_ok=True)
    made = subprocess.run([binary, "import", str(folder / name), "--out", str(project), *arguments], capture_output=True, text=True, timeout=120)
    said = (made.stderr.strip() or made.stdout.strip()).replace("\n", " ")
    if made.returncode != 0:
        lines = len([line for line in made.stderr.strip().splitlines() if line])
        return ("as wanted" if expect == LINE and lines == 1 else "REFUSED"), said
    if expect == LINE:
        return "OPENED", said
    found = subprocess.run([binary, "identify", str(project), "--json"], capture_output=True, text=True, timeout=120)
    if expect == "opens":
        return "as wanted", said
    try:
        c = [source["parameters"]["c"] for source in json.loads(found.stdout)["sources"]]
    except (ValueError, KeyError):
        return "NO RESULT", found.stderr.strip()[:300]
    right = len(c) == 1 and abs(c[0] / C - 1) < 0.01
    return ("as wanted" if right else "WRONG"), f"c = {c}; {said}"


def main():
    binary, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    only = sys.argv[3:]
    folder.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for name, writer, arguments, expect in CASES:
        if only and not any(word in name for word in only):
            continue
        (folder / name).unlink(missing_ok=True)
        writer(folder / name)
        verdict, words = run(binary, folder, name, arguments, expect)
        wrong += verdict != "as wanted"
        print(f"{verdict:10} {name:28} {words[:260]}", flush=True)
    print(f"{len(CASES)} files, {wrong} not as wanted")


if __name__ == "__main__":
    main()
