"""Files of instruments and of programs that are rarer in laboratories, tried as try_import.py does.

    pip install numpy scipy h5py npTDMS openpyxl hdf5storage pyuff
    python scripts/interchange/instruments.py target/release/dashpot /tmp/trial

A development tool: no test needs it.
"""

import datetime

import h5py
import numpy as np
import openpyxl
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

import try_import
from try_import import ACC, ACCELERANCE, DISP, FORCE, FREQ, FS, G, LINE, MOBILITY, N, RECEPTANCE, T, VEL, case, number, table, text

try_import.CASES.clear()
from dialects import HEADER, UNITS_MM, UNITS_SI, axis, set58  # noqa: E402

try_import.CASES.clear()
PHYPHOX = ["Time (s)", "Linear Acceleration x (m/s^2)", "Linear Acceleration y (m/s^2)", "Linear Acceleration z (m/s^2)", "Absolute acceleration (m/s^2)"]

# Oscilloscopes and data loggers.


@case("tektronix-columns.csv", (), "opens")
def _(p):
    head = [["Record Length", "7.000000e+02"], ["Sample Interval", "1.000000e-03"], ["Trigger Point", "0"], ["", ""], ["Source", "CH1"], ["Vertical Units", "V"],
            ["Vertical Scale", "5.0e+00"], ["Vertical Offset", "0.0"], ["Horizontal Units", "s"], ["Pt Fmt", "Y"], ["Yzero", "0.0"], ["Probe Atten", "1.0"], ["Model Number", "TDS2014B"]]
    lines = []
    for i in range(N):
        first = head[i] if i < len(head) else ["", ""]
        lines.append(",".join([*first, "", f"{T[i]:.12f}", f"  {DISP[i] * 1e5:.5f}", ""]))
    text(p, lines, end="\r\n")


@case("rigol-start-increment.csv", (), "opens")
def _(p):
    lines = ["X,CH1,CH2,Start,Increment,", f"Sequence,Volt,Volt,0.000000e+00,{1 / FS:.6e}"]
    text(p, lines + [f"{i},{FORCE[i]:.6e},{ACC[i]:.6e}," for i in range(N)], end="\r\n")


@case("keysight-seconds-volts.csv", (), "opens")
def _(p):
    text(p, ["x-axis,1,2", "second,Volt,Volt"] + table([T, FORCE, ACC], ","))


@case("picoscope.csv")
def _(p):
    text(p, ["Time,Channel A (Force),Channel B (Acceleration)", "(ms),(N),(g)", ""] + table([T * 1e3, FORCE, ACC / G], ","), end="\r\n")


@case("picoscope-overload.csv", (), LINE)
def _(p):
    rows = table([T * 1e3, FORCE, ACC / G], ",")
    rows[80] = rows[80].rsplit(",", 1)[0] + ",∞"
    text(p, ["Time,Force,Acceleration", "(ms),(N),(g)", ""] + rows)


@case("picoscope.mat", (), "opens")
def _(p):
    scipy.io.savemat(p, {"A": FORCE[:, None].astype("f4"), "B": ACC[:, None].astype("f4"), "Tstart": 0.0, "Tinterval": 1 / FS, "Length": float(N),
                         "ExtraSamples": 0.0, "RequestedLength": float(N), "Version": "PicoScope 6"})


@case("flexlogger.csv")
def _(p):
    head = ["Test name,Beam", "Operator,NI", "Start time,3/1/2024 12:00:00 PM", "", "Time (s),Force (N),Accelerometer 1 (g)"]
    text(p, head + table([T, FORCE, ACC / G], ","), "utf-8-sig", "\r\n")


@case("flexlogger-properties.tdms")
def _(p):
    stamp = {"wf_start_time": np.datetime64("2024-03-01T12:00:00"), "wf_start_offset": 0.0, "wf_increment": 1 / FS, "wf_samples": N, "NI_ChannelName": "x", "NI_UnitDescription": "g"}
    with TdmsWriter(str(p)) as w:
        w.write_segment([RootObject({"name": "Log", "Test_Name": "beam"}), GroupObject("Log Data_1000Hz"),
                         ChannelObject("Log Data_1000Hz", "Force", FORCE, {**stamp, "NI_UnitDescription": "N"}),
                         ChannelObject("Log Data_1000Hz", "Accelerometer 1", ACC / G, stamp), GroupObject("Events"), ChannelObject("Events", "Text", ["start", "stop"])])


@case("hioki-logger.csv")
def _(p):
    head = ['"FILE ID","HIOKI 8847"', '"Trigger Time","2024-03-01 12:00:00"', '"Sampling","1ms"', '"Time[s]","CH1-1[N]","CH1-2[m/s^2]"', '"COMMENT","Force","Acc"']
    text(p, head + table([T, FORCE, ACC], ","), end="\r\n")


@case("arduino-millis.csv")
def _(p):
    text(p, ["23,1.2", "millis,force_N,acc_g"] + table([T * 1e3 + 51234, FORCE, ACC / G], ","))


# Testing machines.


@case("instron-columns.csv")
def _(p):
    head = ['"Total Time (s)","Cycle Elapsed Time (s)","Total Cycles","Position(8800:Position) (mm)","Load(8800:Load) (kN)"']
    text(p, head + table([T, T, np.floor(20 * T), DISP * 1e3, FORCE / 1e3], ","), end="\r\n")


@case("mts-data-acquisition.txt")
def _(p):
    head = ["MTS793|MPT|DEU|1|2|,|.|:|1|0|0|A", "", "Data Header:\tTime:\t3,1 Sec\t01.03.2024 12:00:00", "Data Acquisition:\tTimed",
            "Ch 1 Time\tCh 1 Displacement\tCh 1 Force", "Sec\tmm\tkN"]
    text(p, head + table([T, DISP * 1e3, FORCE / 1e3], "\t", True), "cp1252", "\r\n")


# Telephones.


@case("phyphox.csv", (), "opens")
def _(p):
    own = ACC * np.exp(-8 * T)
    text(p, [",".join(f'"{word}"' for word in PHYPHOX)] + [",".join(f"{v:.9E}" for v in row) for row in zip(T, 0.01 * own, 0.02 * own, own, np.abs(own))])


@case("phyphox-comma.csv", (), "opens")
def _(p):
    own = ACC * np.exp(-8 * T)
    text(p, [";".join(f'"{word}"' for word in PHYPHOX)] + [";".join(f"{v:.9E}".replace(".", ",") for v in row) for row in zip(T, 0.01 * own, 0.02 * own, own, np.abs(own))])


@case("sensor-logger.csv", (), "opens")
def _(p):
    own = ACC * np.exp(-8 * T)
    text(p, ["time,seconds_elapsed,z,y,x"] + [f"{1709294400000000000 + round(t * 1e9)},{t:.9f},{a:.9f},{0.01 * a:.9f},{0.02 * a:.9f}" for t, a in zip(T, own)])


@case("physics-toolbox.csv", (), "opens")
def _(p):
    own = ACC * np.exp(-8 * T) / G
    text(p, ["time,gFx,gFy,gFz,TgF"] + table([T, 0.01 * own, 0.02 * own, own, np.abs(own)], ","))


@case("androsensor.csv", (), "opens")
def _(p):
    own = ACC * np.exp(-8 * T)
    head = "LINEAR ACCELERATION X (m/s²);LINEAR ACCELERATION Y (m/s²);LINEAR ACCELERATION Z (m/s²);Time since start in ms ;YYYY-MO-DD HH-MI-SS_SSS"
    rows = [f"{0.01 * a:.4f};{0.02 * a:.4f};{a:.6f};{1000 * t:.0f};2024-03-01 12-00-{int(t):02d}_{round(1000 * (t % 1)):03d}" for t, a in zip(T, own)]
    text(p, [head] + rows)


# Analysers and their exports.


@case("testlab-stacked-blocks.txt")
def _(p):
    def block(word, unit, values):
        return [f"Section\tRun 1", f"Channel name\t{word}", f"X unit\ts", f"Y unit\t{unit}", "s\t" + unit] + table([T, values], "\t") + [""]
    text(p, block("Force:1:+Z", "N", FORCE) + block("Beam:1:+Z", "m/s^2", ACC), end="\r\n")


@case("crystal-edm.csv", (), "opens")
def _(p):
    head = ["Crystal Instruments,EDM 10.0", "Signal,H_Ch2_Ch1", "Block size,160", "X unit,Hz", "Y unit,(m/s²)/N", "", "Frequency (Hz),H_Ch2_Ch1 Real ((m/s²)/N),H_Ch2_Ch1 Imag ((m/s²)/N)"]
    text(p, head + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], ","), "utf-8-sig", "\r\n")


@case("oros-nvgate.txt")
def _(p):
    head = ["OROS NVGate", "Type\tFRF H1", "Response node\t1\tResponse direction\t+Z", "Reference node\t1\tReference direction\t+Z", "X (Hz)\tReal (m/s²/N)\tImag (m/s²/N)"]
    text(p, head + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], "\t", True), "cp1252", "\r\n")


@case("frf-no-reference-voltage.uff", (), LINE)
def _(p):
    text(p, HEADER + UNITS_SI + set58(4, MOBILITY, FREQ, reference=(0, 0), ordinate=(11, "m/s"), denominator=(0, "V")), end="\r\n")


@case("uff-general-type.uff")
def _(p):
    text(p, HEADER + UNITS_SI + set58(0, ACCELERANCE, FREQ), end="\r\n")


@case("uff-single-uneven-mm.uff")
def _(p):
    text(p, HEADER + UNITS_MM + set58(4, 1e3 * RECEPTANCE, FREQ, ordinate=(8, "mm"), denominator=(13, "N"), even=False), end="\r\n")


@case("dspace-controldesk.mat")
def _(p):
    kind = [("Name", object), ("Type", object), ("Data", object), ("Unit", object), ("XIndex", object)]
    y = np.zeros((1, 2), dtype=kind)
    y[0, 0], y[0, 1] = ("Force", "", FORCE[None, :], "N", 1.0), ("Acc 1", "", ACC[None, :], "m/s^2", 1.0)
    x = np.zeros((1, 1), dtype=[("Name", object), ("Type", object), ("Data", object), ("Unit", object)])
    x[0, 0] = ("Time", "", T[None, :], "s")
    scipy.io.savemat(p, {"rec_001": {"X": x, "Y": y, "Description": {"General": {"DateTime": "01.03.2024"}}, "Capture": {"SamplingPeriod": 1 / FS}}})


@case("mp-analyzer.mat")
def _(p):
    kind = [("Name", object), ("YUnit", object), ("XUnit", object), ("XStart", object), ("XDelta", object), ("Y", object)]
    held = np.zeros((1, 2), dtype=kind)
    held[0, 0], held[0, 1] = ("Force +Z", "N", "s", 0.0, 1 / FS, FORCE[:, None]), ("Acc 1 +Z", "g", "s", 0.0, 1 / FS, ACC[:, None] / G)
    scipy.io.savemat(p, {"mpData": held})


@case("cells-of-structs.mat")
def _(p):
    one = lambda name, unit, values: {"label": name, "units": unit, "samples": values[:, None], "dt": 1 / FS}  # noqa: E731
    cells = np.empty((2, 1), dtype=object)
    cells[0, 0], cells[1, 0] = one("Force", "N", FORCE), one("Acc 1", "m/s^2", ACC)
    scipy.io.savemat(p, {"measurement": cells})


# Earthquakes, Python and spreadsheets.


@case("peer.AT2", (), "opens")
def _(p):
    base = 0.1 * np.sin(2 * np.pi * 3 * T) * np.exp(-T)
    rows = ["".join(f"{v:15.7E}" for v in base[i:i + 5]) for i in range(0, N, 5)]
    text(p, ["PEER NGA STRONG MOTION DATABASE RECORD", "Imperial Valley-02, 5/19/1940, El Centro Array #9, 180", "ACCELERATION TIME SERIES IN UNITS OF G",
             f"NPTS=  {N}, DT=   {1 / FS:.4f} SEC"] + rows)


@case("xarray.nc")
def _(p):
    with h5py.File(p, "w") as f:
        time = f.create_dataset("time", data=T)
        time.attrs["units"] = "s"
        time.make_scale("time")
        names = f.create_dataset("channel", data=np.array(["force", "acc_1"], dtype=h5py.string_dtype()))
        names.make_scale("channel")
        data = f.create_dataset("measured", data=np.vstack([FORCE, ACC]))
        data.dims[0].attach_scale(names), data.dims[1].attach_scale(time)


@case("pandas-table.h5", (), "opens")
def _(p):
    rows = np.zeros(N, dtype=[("index", "f8"), ("force", "f8"), ("acc", "f8")])
    rows["index"], rows["force"], rows["acc"] = T, FORCE, ACC
    with h5py.File(p, "w") as f:
        group = f.create_group("df")
        group.attrs["pandas_type"] = np.bytes_("frame_table")
        group.create_dataset("table", data=rows)


@case("json-attributes.h5")
def _(p):
    with h5py.File(p, "w") as f:
        run = f.create_group("measurements/2024-03-01/run_0001")
        run.attrs["fs"], run.attrs["channel_names"], run.attrs["channel_units"] = FS, ["force", "acc 1"], ["N", "m/s^2"]
        run.create_dataset("samples", data=np.column_stack([FORCE, ACC]).astype("f4"), compression="gzip", chunks=(256, 2))


@case("durations-and-merged-heads.xlsx")
def _(p):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet["B2"], sheet["B3"] = "Prüfprotokoll", "Kunde: Müller AG"
    sheet.merge_cells("C5:D5")
    sheet["B5"], sheet["C5"] = "Zeit", "Messwerte"
    for column, word in zip("BCD", ["", "Kraft", "Beschleunigung"]):
        sheet[column + "6"] = word
    for column, word in zip("BCD", ["hh:mm:ss", "[kN]", "[g]"]):
        sheet[column + "7"] = word
    for i in range(N):
        for column, value in zip("BCD", [datetime.timedelta(milliseconds=i), float(FORCE[i] / 1e3), float(ACC[i] / G)]):
            sheet[f"{column}{i + 8}"] = value
    book.save(p)


@case("old.xls", (), LINE)
def _(p):
    p.write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(2000))


@case("measurement.mf4", (), LINE)
def _(p):
    p.write_bytes(b"MDF     4.10    dashpot " + bytes(3000))


@case("catman.bin", (), LINE)
def _(p):
    p.write_bytes(b"\x93\x13" + bytes(range(256)) * 10)


@case("atfx.atfx", (), LINE)
def _(p):
    text(p, ['<?xml version="1.0" encoding="UTF-8"?>', '<atfx_file version="atfx_file: V1.2">', "<instance_data/>", "</atfx_file>"])


# Cells, heads and stamps as programs write them.


def stamps(form, behind=""):
    start = datetime.datetime(2024, 3, 1, 12)
    return [(start + datetime.timedelta(milliseconds=1000 * t)).strftime(form)[:-3] + behind for t in T]


@case("matlab-duration.csv")
def _(p):
    text(p, ["Time,Force_N,Acc_g"] + table([[f"{t:.6g} sec" for t in T], FORCE, ACC / G], ","))


@case("matlab-datestr.csv")
def _(p):
    text(p, ["Time,Force [N],Acc [g]"] + table([stamps("%d-%b-%Y %H:%M:%S.%f"), FORCE, ACC / G], ","))


@case("american-months.csv")
def _(p):
    text(p, ["Time;Force [N];Acc [g]"] + table([stamps("%b %d, %Y %I:%M:%S.%f", " PM"), FORCE, ACC / G], ";"))


@case("compact-iso.csv")
def _(p):
    text(p, ["Time;Force [N];Acc [g]"] + table([stamps("%Y%m%dT%H%M%S.%f"), FORCE, ACC / G], ";"))


@case("line-breaks-in-heads.csv")
def _(p):
    text(p, ['"Zeit\n[s]";"Kraft\n[N]";"Beschl.\n[m/s²]"'] + table([T, FORCE, ACC], ";", True), "cp1252")


@case("state-in-every-row.csv")
def _(p):
    text(p, ["Time,State,Force [N],Acc [g]"] + table([T, ["running"] * N, FORCE, ACC / G], ","))


@case("numbers-with-units.csv", (), LINE)
def _(p):
    text(p, ["t,F,a"] + [f"{t:.4f} s,{f:.6g} N,{a:.6g} m/s^2" for t, f, a in zip(T, FORCE, ACC)])


@case("page-heads.txt")
def _(p):
    rows = table([T, FORCE, ACC], "\t")
    text(p, [line for i in range(0, N, 100) for line in ["Time [s]\tForce [N]\tAcc [m/s^2]", *rows[i:i + 100], ""]])


@case("cell-table.mat")
def _(p):
    cells = np.empty((3, 3), dtype=object)
    for j, column in enumerate([("Time", "s", T), ("Force", "N", FORCE), ("Acc", "g", ACC / G)]):
        cells[0, j], cells[1, j], cells[2, j] = column[0], column[1], column[2][:, None]
    scipy.io.savemat(p, {"data": cells})


@case("labels-of-one-array.mat")
def _(p):
    scipy.io.savemat(p, {"Fs": FS, "x": np.vstack([FORCE, ACC]), "xLabels": np.array(["Force (N)", "Acc (m/s^2)"], dtype=object), "date": "01-Mar-2024"})


@case("single-matrix.mat", (), LINE)
def _(p):
    scipy.io.savemat(p, {"M": np.column_stack([T, FORCE, ACC])})


@case("units-in-names.tdms")
def _(p):
    with TdmsWriter(str(p)) as w:
        w.write_segment([RootObject({"Sampling Rate": "1000"}), GroupObject("Data"), ChannelObject("Data", "Force (N)", FORCE), ChannelObject("Data", "Acc (g)", ACC / G)])


@case("lists-as-attributes.h5")
def _(p):
    with h5py.File(p, "w") as f:
        f["time"] = T[:, None]
        f["signals"] = np.column_stack([FORCE, ACC / G])
        f["signals"].attrs["names"] = np.array(["Force [N]", "Acc [g]"], dtype=h5py.string_dtype())


if __name__ == "__main__":
    try_import.main()
