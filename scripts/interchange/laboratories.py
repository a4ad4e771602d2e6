"""Files as the programs of laboratories write them, header and all, tried as try_import.py does.

    pip install numpy scipy h5py npTDMS openpyxl hdf5storage pyuff
    python scripts/interchange/laboratories.py target/debug/dashpot /tmp/trial

A development tool: no test needs it.
"""

import datetime
import struct

import h5py
import numpy as np
import openpyxl
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

import dialects
import try_import
from dialects import HEADER, UNITS_MM, UNITS_SI, axis, frf, set58, v73
from try_import import ACC, ACCELERANCE, DISP, FORCE, FREQ, FS, G, LINE, MOBILITY, N, RECEPTANCE, T, case, listed, number, table, text

try_import.CASES.clear()

START = datetime.datetime(2024, 3, 1, 12, 0, 0)
MICRO = [START + datetime.timedelta(microseconds=round(1e6 * t)) for t in T]
FORCE58 = dict(ordinate=(13, "N"), denominator=(0, "NONE"), abscissa=(17, "s"))
ACC58 = dict(ordinate=(12, "m/s^2"), denominator=(0, "NONE"), abscissa=(17, "s"))


def force58(**more):
    return set58(1, FORCE, T, **{**FORCE58, **more})


def acc58(**more):
    return set58(1, ACC, T, **{**ACC58, **more})


# Universal Files.


@case("simcenter-property-sets.unv")
def _(p):
    extra = ["    -1", "  1858", "     1     0     0     0     0     0     0     0     0     0     0     0", "  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00",
             "  1.00000E+00  1.00000E+00  1.00000E+00  1.00000E+00  1.00000E+00  1.00000E+00", "  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00", "NONE", "NONE", "NONE", "    -1"]
    systems = ["    -1", "  2420", "         1", "Part1", "         1         0         0", "CS1", "    1.0000000000000000E+00    0.0000000000000000E+00    0.0000000000000000E+00",
               "    0.0000000000000000E+00    1.0000000000000000E+00    0.0000000000000000E+00", "    0.0000000000000000E+00    0.0000000000000000E+00    1.0000000000000000E+00",
               "    0.0000000000000000E+00    0.0000000000000000E+00    0.0000000000000000E+00", "    -1"]
    text(p, HEADER + UNITS_SI + systems + extra + frf(), end="\r\n")


@case("simcenter-runs.uff")
def _(p):
    text(p, HEADER + UNITS_SI + [line for _ in range(3) for line in force58() + acc58()], end="\r\n")


@case("m+p-smartoffice.uff")
def _(p):
    cross = set58(3, ACCELERANCE * 2, FREQ, ordinate=(12, "m/s^2*N"), denominator=(0, "NONE"))
    drive = set58(2, np.full(len(FREQ), 2.0), FREQ, response=(1, 3), reference=(0, 0), ordinate=(13, "N^2"), denominator=(0, "NONE"))
    coherence = set58(6, np.full(len(FREQ), 0.999), FREQ, ordinate=(0, ""), denominator=(0, ""))
    text(p, HEADER + drive + cross + frf(ids=["FRF H1", "SO Analyzer", "01-Mar-24 12:00:00", "Hanning 80%", "Avg 5"]) + coherence, end="\r\n")


@case("polytec-scan.uff")
def _(p):
    nodes = ["    -1", "    15", f"{1:10d}{0:10d}{0:10d}{8:10d}{0.1:13.5E}{0.2:13.5E}{0.0:13.5E}", "    -1"]
    lines = nodes + UNITS_SI + set58(4, MOBILITY, FREQ, response=(1, 3), reference=(0, 0), ordinate=(11, "m/s"), denominator=(13, "N"), names=("Vib", "Ref1"))
    text(p, lines, end="\r\n")


@case("bk-connect.uff")
def _(p):
    text(p, HEADER + frf(ordinate=(12, "m/s²"), denominator=(13, "N"), ids=["Frequency Response H1(Response,Force)", "BK Connect", "2024-03-01", "NONE", "NONE"]), "cp1252", "\r\n")


@case("bk-exponents-in-axis.uff")
def _(p):
    lines = frf()
    lines[10] = axis(12, (1, 0, -2), "Acceleration", "m/s²")
    lines[11] = axis(13, (0, 1, 0), "Excitation force", "N")
    text(p, lines, "latin-1", "\r\n")


@case("writeuff-widths.uff")
def _(p):
    lines = frf()
    raw = np.column_stack([ACCELERANCE.real, ACCELERANCE.imag]).ravel().astype("<f8").tobytes()
    with open(p, "wb") as f:
        f.write(b"    -1\n" + f"{58:6d}b{1:6d}{2:6d}{11:12d}{len(raw):12d}                                                \n".encode())
        for line in lines[2:13]:
            f.write(line.encode() + b"\n")
        f.write(raw + b"    -1\n")


@case("vax-floats.uff", (), LINE)
def _(p):
    raw = b"\x00" * (16 * len(FREQ))
    with open(p, "wb") as f:
        f.write(b"    -1\r\n" + f"{58:6d}b{1:6d}{1:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}\r\n".encode())
        for line in frf()[2:13]:
            f.write(line.ljust(80).encode() + b"\r\n")
        f.write(raw + b"\r\n    -1\r\n")


@case("rotation-channel.uff", (), "opens")
def _(p):
    text(p, UNITS_SI + force58() + acc58() + set58(1, ACC * 0.1, T, response=(1, 5), **{**ACC58, "ordinate": (12, "rad/s^2")}))


@case("two-spellings-of-a-point.uff")
def _(p):
    text(p, UNITS_SI + force58(names=("Plate", "NONE"), reference=(0, 0)) + acc58(names=("Plate", "NONE"), reference=(0, 0)), end="\r\n")


# MATLAB.


@case("dewesoft.mat")
def _(p):
    scipy.io.savemat(p, {"Data1_Force": FORCE[:, None], "Data1_time_Force": T[:, None], "Data1_Acc_1": ACC[:, None], "Data1_time_Acc_1": T[:, None],
                         "Sample_rate": FS, "Start_store_time": "2024/03/01 12:00:00", "File_name": "Test_0001.dxd"})


@case("dewesoft-sampling-only.mat")
def _(p):
    scipy.io.savemat(p, {"Force": FORCE[:, None], "Acc_1": ACC[:, None], "SampleRate": FS, "Duration": N / FS})


@case("pulse-struct.mat")
def _(p):
    kind = [("Name", object), ("Unit", object), ("Samplingfrequency", object), ("Data", object)]
    channels = np.zeros((1, 2), dtype=kind)
    channels[0, 0], channels[0, 1] = ("Force", "N", FS, FORCE[:, None]), ("Acc 1", "m/s²", FS, ACC[:, None])
    scipy.io.savemat(p, {"Signals": channels, "FileHeader": {"NumberOfChannels": 2.0, "Date": "01-03-2024"}})


@case("siemens-array.mat")
def _(p):
    kind = [("x_values", object), ("y_values", object), ("function_record", object)]
    signals = np.zeros((1, 2), dtype=kind)
    for i, (values, unit, name) in enumerate([(FORCE, "N", "Force:1:+Z"), (ACC, "m/s^2", "Plate:1:+Z")]):
        signals[0, i] = ({"start_value": 0.0, "increment": 1 / FS, "number_of_values": float(N), "quantity": {"label": "s"}},
                         {"values": values[:, None], "quantity": {"label": unit, "quantity_terms": {"term": "x"}}}, {"name": name, "type": "Time"})
    scipy.io.savemat(p, {"Signal": signals})


@case("int16-scaled.mat")
def _(p):
    f, a = np.abs(FORCE).max() / 30000, np.abs(ACC).max() / 30000
    scipy.io.savemat(p, {"fs": FS, "force": {"data": np.round(FORCE / f).astype("i2")[:, None], "scale": f, "unit": "N"},
                         "acc": {"data": np.round(ACC / a).astype("i2")[:, None], "scale": a, "unit": "m/s^2"}})


def string(f, refs, name, words):
    return refs.create_dataset(name, data=np.array([[ord(c)] for c in words], dtype="u2"))


def cells(f, name, words):
    refs = f.require_group("#refs#")
    made = []
    for i, word in enumerate(words):
        data = string(f, refs, f"{name}{i}", word)
        data.attrs["MATLAB_class"] = np.bytes_("char")
        data.attrs["MATLAB_int_decode"] = np.int32(2)
        made.append(data.ref)
    cell = f.create_dataset(name, data=np.array([made], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
    cell.attrs["MATLAB_class"] = np.bytes_("cell")


@case("v73-string-cells.mat")
def _(p):
    def fill(f):
        dialects.matlab(f, "data", np.vstack([FORCE, ACC]))
        dialects.matlab(f, "fs", [[FS]])
        cells(f, "names", ["Force", "Acc 1"])
        cells(f, "units", ["N", "m/s^2"])
    v73(p, fill)


@case("v73-data-cells.mat")
def _(p):
    def fill(f):
        refs = f.require_group("#refs#")
        made = [dialects.matlab(refs, word, values[None, :]).ref for word, values in [("d0", FORCE), ("d1", ACC)]]
        cell = f.create_dataset("data", data=np.array([made], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
        cell.attrs["MATLAB_class"] = np.bytes_("cell")
        cells(f, "labels", ["Force [N]", "Acc 1 [m/s^2]"])
        dialects.matlab(f, "dt", [[1 / FS]])
    v73(p, fill)


@case("v73-struct-array.mat")
def _(p):
    def fill(f):
        refs, top = f.require_group("#refs#"), f.create_group("channel")
        top.attrs["MATLAB_class"] = np.bytes_("struct")
        for field, both in [("data", (FORCE, ACC)), ("fs", (FS, FS))]:
            made = [dialects.matlab(refs, f"{field}{i}", np.atleast_2d(v)).ref for i, v in enumerate(both)]
            top.create_dataset(field, data=np.array([made], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
        for field, both in [("name", ("Force", "Acc 1")), ("unit", ("N", "m/s^2"))]:
            made = []
            for i, word in enumerate(both):
                data = string(f, refs, f"{field}{i}", word)
                data.attrs["MATLAB_class"] = np.bytes_("char")
                made.append(data.ref)
            top.create_dataset(field, data=np.array([made], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
    v73(p, fill)


# HDF5.


@case("pandas-fixed.h5")
def _(p):
    with h5py.File(p, "w") as f:
        g = f.create_group("df")
        g.attrs["pandas_type"] = np.bytes_("frame")
        g.create_dataset("axis0", data=np.array([b"force [N]", b"acc [m/s^2]"]))
        g.create_dataset("axis1", data=T)
        g.create_dataset("block0_items", data=np.array([b"force [N]", b"acc [m/s^2]"]))
        g.create_dataset("block0_values", data=np.column_stack([FORCE, ACC]))


@case("milliseconds.h5")
def _(p):
    with h5py.File(p, "w") as f:
        for name, values, unit in [("Time", T * 1e3, "ms"), ("Force", FORCE, "N"), ("Acc", ACC / G * 1e3, "mg")]:
            f.create_dataset(name, data=values.astype("f8")).attrs["Unit"] = unit


@case("keysight-like.h5")
def _(p):
    with h5py.File(p, "w") as f:
        for i, (name, values) in enumerate([("Channel 1", FORCE), ("Channel 2", ACC)]):
            g = f.create_group(f"Waveforms/{name}")
            g.attrs["XInc"], g.attrs["XOrg"], g.attrs["YUnits"], g.attrs["NumPoints"] = 1 / FS, 0.0, ["N", "m/s^2"][i], N
            g.create_dataset(name + " Data", data=values.astype("f4"))


# TDMS and LVM.


@case("daqmx-scales.tdms")
def _(p):
    def scaled(name, values, unit):
        slope = float(np.abs(values).max() / 30000)
        raw = np.round(values / slope).astype("i2")
        return ChannelObject("Log", name, raw, {"wf_increment": 1 / FS, "wf_samples": N, "unit_string": unit, "NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": np.uint32(2),
                                                "NI_Scale[1]_Scale_Type": "Linear", "NI_Scale[1]_Linear_Slope": slope, "NI_Scale[1]_Linear_Y_Intercept": 0.0,
                                                "NI_Scale[1]_Linear_Input_Source": np.uint32(0xFFFFFFFF)})
    with TdmsWriter(str(p)) as w:
        w.write_segment([RootObject({}), GroupObject("Log"), scaled("Force", FORCE, "N"), scaled("Acc 1", ACC, "m/s^2")])


@case("many-segments.tdms")
def _(p):
    with TdmsWriter(str(p)) as w:
        for k in range(7):
            part = slice(100 * k, 100 * k + 100)
            properties = {"wf_increment": 1 / FS, "wf_start_offset": 0.0, "wf_samples": 100}
            w.write_segment([RootObject({}), GroupObject("Log"), ChannelObject("Log", "Force", FORCE[part], {**properties, "unit_string": "N"}),
                             ChannelObject("Log", "Acc 1", ACC[part], {**properties, "unit_string": "m/s^2"})])


@case("diadem.tdms")
def _(p):
    with TdmsWriter(str(p)) as w:
        w.write_segment([RootObject({"name": "test"}), GroupObject("General", {}), ChannelObject("General", "Time", T, {"unit_string": "s", "monotony": "increasing", "displaytype": "Numeric"}),
                         ChannelObject("General", "Kraft", FORCE, {"unit_string": "N", "minimum": -5.0}), ChannelObject("General", "Beschl_1", ACC / G, {"unit_string": "g"})])


@case("german-labview.lvm")
def _(p):
    dialects.lvm(p, "One", comma=True)


# Text.


@case("polytec.txt")
def _(p):
    head = ["Source File Name:\tScan_1.svd", "Point Index:\t1", "Component:\tRoot", "Signal:\tFFT - H1 Vib Velocity / Ref1 Force - Real & Imaginary", "", "Frequency\tReal\tImaginary",
            "[ Hz ]\t[ m/s/N ]\t[ m/s/N ]"]
    text(p, head + table([FREQ, MOBILITY.real, MOBILITY.imag], "\t"), "cp1252", "\r\n")


@case("polytec-magnitude.txt")
def _(p):
    head = ["Source File Name:\tScan_1.svd", "Signal:\tFFT - Vib & Ref1 H1 Velocity / Force - Magnitude", "", "Frequency\tMagnitude\tPhase", "[ Hz ]\t[ mm/s / N ]\t[ ° ]"]
    text(p, head + table([FREQ, np.abs(MOBILITY) * 1e3, np.degrees(np.angle(MOBILITY))], "\t"), "cp1252", "\r\n")


@case("pulse-frf.txt")
def _(p):
    head = ["Title1:\tFrequency Response H1(Acc,Force) - Input", "Title2:\tWorking : Input : Input : FFT Analyzer", "X-Axis:\tFrequency\tHz\t", "Y-Axis:\t[(m/s²)/N]", "Date:\t01-03-2024",
            "Header Size:\t7", "Number of points:\t160"]
    rows = [f"{i + 1}\t{f:.5e}\t{h.real:.6e}\t{h.imag:.6e}".replace(".", ",") for i, (f, h) in enumerate(zip(FREQ, ACCELERANCE))]
    text(p, head + rows, "cp1252", "\r\n")


@case("dewesoft-export.csv")
def _(p):
    head = ["File name: Test_0001.dxd", "Start time: 3/1/2024 12:00:00.000 PM", "Sample rate: 1000 Hz", "", "Data info", "Ch. no;Name;Description;Unit", "1;Force;-;N", "2;Acc 1;-;m/s2", "",
            "Time (s);Force (N);Acc 1 (m/s2)"]
    text(p, head + table([T, FORCE, ACC], ";"), "utf-8-sig", "\r\n")


@case("head-artemis.txt")
def _(p):
    head = ["Filename: C:\\Messung\\Balken.hdf", "Abscissa: Time [s]", "Delta Time: 0.001", "1. Channel: Force [N]", "2. Channel: Acc 1 [m/s²]", ""]
    text(p, head + table([T, FORCE, ACC], "\t"), "cp1252", "\r\n")


@case("header-step-comma.csv")
def _(p):
    text(p, ["Messung 3;Balken", "Abtastintervall [s];0,001", "Kraft [N];Weg [µm]"] + table([FORCE, DISP * 1e6], ";", True), "cp1252", "\r\n")


@case("header-khz.txt")
def _(p):
    text(p, ["Beam test", "Sampling frequency: 1 kHz", "", "Force (N)\tAcc (g)"] + table([FORCE, ACC / G], "\t"))


@case("thousands-semicolon.csv")
def _(p):
    def german(value):
        return f"{value:,.4f}".replace(",", " ").replace(".", ",").replace(" ", ".")
    text(p, ["Zeit [ms];Kraft [mN];Beschl. [mm/s²]"] + [";".join(german(v) for v in row) for row in zip(1000 * T, FORCE * 1e3, ACC * 1e3)], "latin-1", "\r\n")


@case("python-isoformat.csv")
def _(p):
    text(p, ["timestamp,force [N],acc [m/s^2]"] + table([[m.isoformat() for m in MICRO], FORCE, ACC], ","))


@case("iso-blank-utc.csv")
def _(p):
    stamps = [m.strftime("%Y-%m-%d %H:%M:%S.%f") + "+00:00" for m in MICRO]
    text(p, [",force,acc"] + table([stamps, FORCE, ACC], ","))


@case("unix-seconds.csv")
def _(p):
    stamps = [f"{1709294400 + t:.3f}" for t in T]
    text(p, ["timestamp,force_N,acc_m_s2"] + table([stamps, FORCE, ACC], ","))


@case("unix-milliseconds.csv")
def _(p):
    stamps = [f"{1709294400000 + round(1000 * t)}" for t in T]
    text(p, ["timestamp_ms,force_N,acc_m_s2"] + table([stamps, FORCE, ACC], ","))


@case("unix-nanoseconds.csv")
def _(p):
    stamps = [f"{(1709294400000 + round(1000 * t)) * 1000000}" for t in T]
    text(p, ["timestamp_ns,force_N,acc_m_s2"] + table([stamps, FORCE, ACC], ","))


@case("repeated-names.csv", (), "opens")
def _(p):
    text(p, ["Time [s],Force [N],Acc [g],Acc [g]"] + table([T, FORCE, ACC / G, ACC / G / 2], ","))


@case("two-time-columns.csv")
def _(p):
    stamps = [m.strftime("%d.%m.%Y %H:%M:%S,%f")[:-3] for m in MICRO]
    text(p, ["Zeitstempel;Zeit [s];Kraft [N];Beschleunigung [m/s²]"] + table([stamps, T, FORCE, ACC], ";", True), "utf-8-sig", "\r\n")


@case("two-time-units.csv")
def _(p):
    text(p, ["Time [s],Time [ms],Force [N],Acc [m/s^2]"] + table([T, 1000 * T, FORCE, ACC], ","))


@case("leading-nan.csv")
def _(p):
    rows = table([T, FORCE, ACC], ",")
    text(p, ["Time [s],Force [N],Acc [m/s^2]"] + [f"{t:.4f},NaN,NaN" for t in T[:5] - 0.005] + rows)


@case("na-at-end.csv")
def _(p):
    text(p, ["Time [s];Force [N];Acc [m/s^2]"] + table([T, FORCE, ACC], ";") + [f"{T[-1] + k / FS:.4f};#N/A;#N/A" for k in (1, 2, 3)])


@case("empty-cells-within.csv", (), LINE)
def _(p):
    rows = table([T, FORCE, ACC], ",")
    rows[300] = rows[300].rsplit(",", 1)[0] + ","
    text(p, ["Time [s],Force [N],Acc [m/s^2]"] + rows)


@case("pandas-index.csv")
def _(p):
    text(p, [",Time [s],Force [N],Acc [m/s^2]"] + [f"{i},{row}" for i, row in enumerate(table([T, FORCE, ACC], ","))])


@case("pandas-two-levels.csv")
def _(p):
    text(p, ["channel,Force,Acc 1", "unit,N,m/s^2", "time [s],,"] + table([T, FORCE, ACC], ","))


@case("oros.txt")
def _(p):
    text(p, ["FRF H1 Ch2/Ch1", "Frequency (Hz)\tReal ((m/s²)/N)\tImag ((m/s²)/N)"] + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], "\t"), "cp1252", "\r\n")


@case("signalcalc.csv")
def _(p):
    text(p, ['"DP900 export"', '"Frequency (Hz)","H1,1(f) Magnitude (g/N)","H1,1(f) Phase (deg)","C1,1(f)"'] + table([FREQ, np.abs(ACCELERANCE) / G, np.degrees(np.angle(ACCELERANCE)), np.full(len(FREQ), 0.999)], ","))


@case("phyphox.csv", (), "opens")
def _(p):
    text(p, ['"Time (s)","Acceleration x (m/s^2)","Acceleration y (m/s^2)","Acceleration z (m/s^2)"'] + table([T, ACC, ACC / 2, ACC / 3], ","))


@case("vibrationview.csv")
def _(p):
    text(p, ["Time (s),Ch1 Force (lbf),Ch2 Accel (G)"] + table([T, FORCE / 4.4482216152605, ACC / G], ","))


@case("tektronix.csv", (), "opens")
def _(p):
    left = ["Record Length,7.000000e+02,", "Sample Interval,1.000000e-03,", "Trigger Point,0.000000e+00,", "Source,CH1,", "Vertical Units,V,", "Horizontal Units,s,"]
    text(p, [(left[i] if i < len(left) else ",,") + f",{t:.9f},{a:.6e}," for i, (t, a) in enumerate(zip(T, ACC))], end="\r\n")


@case("keysight.csv", (), "opens")
def _(p):
    text(p, ["x-axis,1,2", "second,Volt,Volt"] + table([T, FORCE, ACC], ","))


@case("lecroy.csv", (), LINE)
def _(p):
    text(p, ["LECROYWR64Xi,12345,Waveform", "Segments,1,SegmentSize,700", "Segment,TrigTime,TimeSinceSegment1", "#1,01-Mar-2024 12:00:00,0", "Time,Ampl"] + table([T, ACC], ","))


@case("units-in-own-brackets.txt")
def _(p):
    text(p, ["Time\t[ s ]\tForce [ N ]\tAcc  [ m / s^2 ]".replace("\t[ s ]", " [ s ]")] + table([T, FORCE, ACC], "\t"))


# Spreadsheets.


@case("titles-and-notes.xlsx")
def _(p):
    file = openpyxl.Workbook()
    notes = file.active
    notes.title = "Read me"
    notes["A1"] = "Beam, shaker at point 1"
    sheet = file.create_sheet("Run 1")
    sheet["B2"] = "Steady state at 20 Hz"
    sheet.merge_cells("B2:D2")
    sheet["B4"], sheet["C4"], sheet["D4"] = "Time", "Force", "Acceleration"
    sheet["B5"], sheet["C5"], sheet["D5"] = "[s]", "[N]", "[m/s²]"
    for i, row in enumerate(listed(T, FORCE, ACC)):
        for j, value in enumerate(row):
            sheet.cell(row=6 + i, column=2 + j, value=value)
    sheet["F6"], sheet["F7"] = "mean", "max"
    file.save(p)


@case("statistics-below.xlsx")
def _(p):
    file = openpyxl.Workbook()
    sheet = file.active
    for row in [["Time [s]", "Force [N]", "Acc [m/s^2]"]] + listed(T, FORCE, ACC):
        sheet.append(row)
    sheet.append([])
    sheet.append(["max", 5.0, float(ACC.max())])
    sheet.append(["rms", 3.5, float(ACC.std())])
    file.save(p)


@case("runs-in-sheets.xlsx")
def _(p):
    file = openpyxl.Workbook()
    file.remove(file.active)
    for k in range(3):
        sheet = file.create_sheet(f"Lauf {k + 1}")
        for row in [["Zeit", "Kraft", "Beschleunigung"], ["s", "N", "m/s²"]] + listed(T, FORCE, ACC):
            sheet.append(row)
    file.save(p)


if __name__ == "__main__":
    try_import.main()
