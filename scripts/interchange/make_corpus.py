"""Writes the corpus of crates/datafiles/tests: small files of every format, and expected.json with what is in them.

    pip install numpy scipy h5py npTDMS openpyxl hdf5storage pyuff
    python scripts/interchange/make_corpus.py crates/datafiles/tests/corpus

Values are made of integers and powers of two, so that every writer keeps them to the last bit. expected.json gives, for each
file, the format and the channels as [set, channel, unit, step, values]; values are hexadecimal floats, complex ones pairs.
"""

import json
import pathlib
import sys
import wave
import struct

import h5py
import numpy as np
import openpyxl
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter, TdmsFile

OUT = pathlib.Path(sys.argv[1])
OUT.mkdir(parents=True, exist_ok=True)
EXPECTED = {}

N = 24
I = np.arange(N)
FORCE = ((I * 37 + 11) % 64 - 32) / 16.0
ACC = ((I * 53 + 5) % 128 - 64) / 1024.0
# Numbers whose decimal form is long: they show rounding.
ODD = np.sqrt(I + 2.0) * 1e-3
FRF = ACC + 1j * ODD
TIME = I * 0.001
STEP = 0.001


def hexes(values):
    values = np.asarray(values)
    if np.iscomplexobj(values):
        return [[float(v.real).hex(), float(v.imag).hex()] for v in values]
    return [float(v).hex() for v in values]


def expect(name, fmt, channels):
    EXPECTED[name] = {"format": fmt, "channels": [[s, c, u, t, hexes(v)] for s, c, u, t, v in channels]}


def text(name, content, fmt, channels, encoding="utf-8"):
    (OUT / name).write_bytes(content.encode(encoding))
    expect(name, fmt, channels)


def rows(separator, comma=False, time=True, extra=""):
    lines = []
    for i in range(N):
        cells = ([repr(float(TIME[i]))] if time else []) + [repr(float(FORCE[i])), repr(float(ODD[i]))]
        line = separator.join(cells)
        lines.append((line.replace(".", ",") if comma else line) + extra)
    return lines


def tables():
    both = [("", "force", "N", STEP, FORCE), ("", "acc", "m/s^2", STEP, ODD)]
    head = "time [s],force [N],acc [m/s^2]"
    text("plain.csv", "\n".join([head] + rows(",")) + "\n", "csv", both)
    text("bom-crlf.csv", "\ufeff" + "\r\n".join([head] + rows(",")) + "\r\n", "csv", both)
    text("german.csv", "\n".join(["Zeit [s];force [N];acc [m/s^2]"] + rows(";", True)) + "\n", "csv", both)
    text("tabs.txt", "\n".join([head.replace(",", "\t")] + rows("\t")) + "\n", "csv", both)
    text("tabs-comma.txt", "\n".join([head.replace(",", "\t")] + rows("\t", True)) + "\n", "csv", both)
    units = ["Versuch 7", "Prüfer: Müller", "", "Time;force;acc", "s;N;m/s^2"]
    text("units-row-latin1.csv", "\n".join(units + rows(";")) + "\n", "csv", both, "latin-1")
    text("utf16.csv", "\n".join([head] + rows(",")) + "\n", "csv", both, "utf-16")
    deep = [f"key {i}: value {i}" for i in range(60)] + ["Channel,force,acc", "Unit,N,m/s^2", "Serial,12,13"]
    deep_rows = rows(",")
    text("deep-header.csv", "\n".join(deep + deep_rows) + "\n", "csv", [("", "force", "N", STEP, FORCE), ("", "acc", "m/s^2", STEP, ODD)])
    text("trailing-separator.csv", "\n".join([head + ","] + rows(",", extra=",")) + "\n", "csv", both)
    spaces = ["# time [s]  force[N]  acc[m/s^2]"] + ["  " + line for line in rows("   ")]
    text("blanks.txt", "\n".join(["%d columns" % 3] + rows("   ")) + "\n", "txt", [("", "column 2", "", STEP, FORCE), ("", "column 3", "", STEP, ODD)])
    fortran = [line.replace("e", "D") for line in rows("   ")]
    text("d-exponents.txt", "\n".join(fortran) + "\n", "txt", [("", "column 2", "", STEP, FORCE), ("", "column 3", "", STEP, ODD)])
    text("rate-only.csv", "\n".join(["Sampling rate: 1000 Hz", "force [N],acc [m/s^2]"] + rows(",", time=False)) + "\n", "csv", both)
    text("no-time.csv", "\n".join(["force [N],acc [m/s^2]"] + rows(",", time=False)) + "\n", "csv",
         [("", "force", "N", None, FORCE), ("", "acc", "m/s^2", None, ODD)])
    text("quoted.csv", "\n".join(['"time [s]","force, left [N]","acc ""7"" [m/s^2]"'] + rows(",")) + "\n", "csv",
         [("", "force, left", "N", STEP, FORCE), ("", 'acc "7"', "m/s^2", STEP, ODD)])
    text("old-mac.csv", "\r".join([head] + rows(",")) + "\r", "csv", both)
    uneven = np.cumsum(1.0 + (I % 3)) / 64
    lines = [head] + [f"{t!r},{float(f)!r},{float(a)!r}" for t, f, a in zip(map(float, uneven), FORCE, ODD)]
    text("uneven.csv", "\n".join(lines) + "\n", "csv", [("", "force", "N", None, FORCE), ("", "acc", "m/s^2", None, ODD)])
    lines = ["time [s],force [N],acc [m/s^2]"] + [line if i < 20 else line.rsplit(",", 1)[0] + "," for i, line in enumerate(rows(","))]
    text("unequal.csv", "\n".join(lines) + "\n", "csv", [("", "force", "N", STEP, FORCE), ("", "acc", "m/s^2", STEP, ODD[:20])])
    frf = ["Frequency [Hz],H [m/s^2/N]"] + [f"{float(i)!r},{complex(h)!r}" for i, h in zip(I, FRF)]
    text("complex.csv", "\n".join(frf) + "\n", "csv", [("", "H", "m/s^2/N", 1.0, FRF)])
    clock = ["Timestamp,force [N]"] + [f"2024-02-29 23:59:{30 + i * 0.25:09.6f},{float(f)!r}" for i, f in enumerate(FORCE)]
    text("clock.csv", "\n".join(clock) + "\n", "csv", [("", "force", "N", 0.25, FORCE)])


def lvm_segment(names, units, columns, samples, x=True, separator="\t", comma=False, step="0.001000"):
    cells = lambda word, values: separator.join([word] + list(values)) + separator
    out = [cells("Channels", [str(len(names))]), cells("Samples", [str(samples)] * len(names)),
           cells("Date", ["2024/01/02"] * len(names)), cells("Time", ["10:11:12.5"] * len(names)),
           cells("Y_Unit_Label", units), cells("X_Dimension", ["Time"] * len(names)),
           cells("X0", ["0.0000000000000000E+0"] * len(names)), cells("Delta_X", [step.replace(".", ",") if comma else step] * len(names)),
           "***End_of_Header***" + separator, separator.join(["X_Value"] + names + ["Comment"])]
    for i in range(samples):
        line = [f"{i * 0.001:.6f}" if x else ""] + [repr(float(c[i])) for c in columns]
        if comma:
            line = [cell.replace(".", ",") for cell in line]
        out.append(separator.join(line))
    return out


def lvms():
    def head(separator="Tab", decimal=".", x="One", multi="No"):
        s = {"Tab": "\t", "Comma": ","}[separator]
        return [f"LabVIEW Measurement{s}", f"Writer_Version{s}2", f"Reader_Version{s}2", f"Separator{s}{separator}", f"Decimal_Separator{s}{decimal}",
                f"Multi_Headings{s}{multi}", f"X_Columns{s}{x}", f"Time_Pref{s}Absolute", f"***End_of_Header***{s}", s]
    names, units = ["force", "acc"], ["N", "m/s^2"]
    both = [("", "force", "N", STEP, FORCE), ("", "acc", "m/s^2", STEP, ODD)]
    text("one.lvm", "\r\n".join(head() + lvm_segment(names, units, [FORCE, ODD], N)) + "\r\n", "lvm", both)
    text("comma.lvm", "\r\n".join(head(decimal=",") + lvm_segment(names, units, [FORCE, ODD], N, comma=True)) + "\r\n", "lvm", both)
    text("comma-separated.lvm", "\r\n".join(head("Comma") + lvm_segment(names, units, [FORCE, ODD], N, separator=",")) + "\r\n", "lvm", both)
    text("no-x.lvm", "\r\n".join(head(x="No") + lvm_segment(names, units, [FORCE, ODD], N, x=False)) + "\r\n", "lvm", both)
    a = lvm_segment(names, units, [FORCE, ODD], N)
    b = lvm_segment(names, units, [ODD, FORCE], N)
    text("segments.lvm", "\r\n".join(head(multi="Yes") + a + [""] + b) + "\r\n", "lvm",
         [("segment 1", "force", "N", STEP, FORCE), ("segment 1", "acc", "m/s^2", STEP, ODD),
          ("segment 2", "force", "N", STEP, ODD), ("segment 2", "acc", "m/s^2", STEP, FORCE)])


def sheets():
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Run 1"
    sheet.append(["Measured by", "X"])
    sheet.append([])
    sheet.append(["time [s]", "force", "acc"])
    sheet.append(["s", "N", "m/s^2"])
    for i in range(N):
        sheet.append([float(TIME[i]), float(FORCE[i]), float(ODD[i])])
    other = book.create_sheet("far cell")
    other["A1"] = "f [Hz]"
    other["B1"] = "G [g]"
    for i in range(N):
        other.cell(2 + i, 1, float(i))
        other.cell(2 + i, 2, float(FORCE[i]))
    other["A1048576"] = "end"
    book.create_sheet("empty")
    book.save(OUT / "sheets.xlsx")
    # openpyxl writes sixteen digits.
    digits = [float(f"{v:.16g}") for v in ODD]
    expect("sheets.xlsx", "xlsx", [("Run 1", "force", "N", STEP, FORCE), ("Run 1", "acc", "m/s^2", STEP, digits), ("far cell", "G", "g", 1.0, FORCE)])


def mats():
    flat = {"t": TIME, "force": FORCE, "acc": ODD, "fs": 1000.0, "note": "a note"}
    channels = [("", "force", "", STEP, FORCE), ("", "acc", "", STEP, ODD)]
    scipy.io.savemat(OUT / "v5.mat", flat)
    expect("v5.mat", "mat", channels)
    scipy.io.savemat(OUT / "v7.mat", flat, do_compression=True, oned_as="column")
    expect("v7.mat", "mat", channels)
    scipy.io.savemat(OUT / "v4.mat", flat, format="4")
    expect("v4.mat", "mat", channels)
    struct_ = {"run": {"t": TIME, "x": np.stack([FORCE, ODD], axis=1), "fs": 1000.0, "labels": np.array(["Acc 7", "Acc 9"], dtype=object),
                       "inner": {"H": FRF, "note": "deep"}}, "fs": 500.0, "y": np.stack([FORCE, ODD])}
    scipy.io.savemat(OUT / "struct.mat", struct_, do_compression=True)
    expect("struct.mat", "mat", [("run", "Acc 7", "", STEP, FORCE), ("run", "Acc 9", "", STEP, ODD), ("run/inner", "H", "", STEP, FRF),
                                 ("", "y[1]", "", 0.002, FORCE), ("", "y[2]", "", 0.002, ODD)])
    cells = np.empty(2, dtype=object)
    cells[0], cells[1] = {"x": FORCE, "dt": STEP, "x_unit": "N"}, {"x": ODD, "dt": STEP}
    scipy.io.savemat(OUT / "cells.mat", {"runs": cells, "K": np.diag([1.0, 2.0, 3.0]), "s": scipy.sparse.eye(3, format="csc"), "i16": np.arange(5, dtype=np.int16)})
    expect("cells.mat", "mat", [("runs/{1}", "x", "N", STEP, FORCE), ("runs/{2}", "x", "", STEP, ODD),
                                ("K", "K", "", None, np.diag([1.0, 2.0, 3.0]).ravel()), ("", "i16", "", None, np.arange(5.0))])
    mixed = np.empty((2, 3), dtype=object)
    mixed[0, :], mixed[1, :] = ["force", 12.0, "+Z"], ["acc", 3.0, "-Z"]
    one_by_one = np.array([["t"] + [float(t) for t in range(300)]], dtype=object)
    scipy.io.savemat(OUT / "mixed-cells.mat", {"x": FORCE, "dt": STEP, "sensors": mixed, "log": one_by_one}, do_compression=True)
    expect("mixed-cells.mat", "mat", [("", "x", "", STEP, FORCE)])
    record = np.zeros(3, dtype=[("x", object), ("dt", object)])
    for i, v in enumerate([FORCE, ODD, ACC]):
        record[i]["x"], record[i]["dt"] = v, STEP
    scipy.io.savemat(OUT / "struct-array.mat", {"r": record})
    expect("struct-array.mat", "mat", [("r/(1)", "x", "", STEP, FORCE), ("r/(2)", "x", "", STEP, ODD), ("r/(3)", "x", "", STEP, ACC)])
    signal = {"Signal_0": {"x_values": {"start_value": 0.0, "increment": STEP, "number_of_values": float(N), "quantity": {"label": "s"}},
                           "y_values": {"values": ODD.reshape(-1, 1), "quantity": {"label": "m/s^2"}}, "function_record": {"name": "Point 7 +Z", "type": "Signal"}}}
    scipy.io.savemat(OUT / "testlab.mat", signal)
    expect("testlab.mat", "mat", [("Signal_0", "Point 7 +Z", "m/s^2", STEP, ODD)])
    import hdf5storage
    (OUT / "v73.mat").unlink(missing_ok=True)
    hdf5storage.savemat(str(OUT / "v73.mat"), {"t": TIME.reshape(-1, 1), "x": np.stack([FORCE, ODD], axis=1), "H": FRF.reshape(-1, 1), "fs": 1000.0, "note": "text",
                                               "run": {"x": ODD.reshape(-1, 1), "dt": 0.002}}, format="7.3")
    expect("v73.mat", "mat", [("", "x[1]", "", STEP, FORCE), ("", "x[2]", "", STEP, ODD), ("", "H", "", STEP, FRF), ("run", "x", "", 0.002, ODD)])
    v73_structs()


def v73_structs():
    """An array of structs as MATLAB 7.3 keeps it: a data set of references a field."""
    with h5py.File(OUT / "v73-structs.mat", "w", userblock_size=512) as file:
        refs, top = file.create_group("#refs#"), file.create_group("r")
        top.attrs["MATLAB_class"] = np.bytes_("struct")
        for field, both in [("x", (FORCE, ODD)), ("dt", (STEP, STEP))]:
            made = [refs.create_dataset(f"{field}{i}", data=np.atleast_2d(v)) for i, v in enumerate(both)]
            for data in made:
                data.attrs["MATLAB_class"] = np.bytes_("double")
            top.create_dataset(field, data=np.array([[data.ref for data in made]], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
    with open(OUT / "v73-structs.mat", "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: PCWIN64 HDF5 schema 1.00 .".ljust(116) + b" " * 8 + struct.pack("<H", 0x0200) + b"IM")
    expect("v73-structs.mat", "mat", [("r/(1)", "x", "", STEP, FORCE), ("r/(2)", "x", "", STEP, ODD)])


def hdf5s():
    with h5py.File(OUT / "groups.h5", "w") as file:
        file.attrs["operator"] = "X"
        run = file.create_group("run 1")
        run.create_dataset("time", data=TIME).attrs["unit"] = "s"
        run.create_dataset("acc", data=ODD, chunks=(7,), compression="gzip", shuffle=True, fletcher32=True).attrs["units"] = "m/s^2"
        run.create_dataset("force", data=FORCE.astype(">f4")).attrs["unit"] = "N"
        other = file.create_group("run 2/deep")
        other.attrs["sampling_rate"] = 1000.0
        other.create_dataset("x", data=np.stack([FORCE, ODD], axis=1), chunks=(5, 1), compression="lzf")
        other.create_dataset("h", data=FRF)
        other.create_dataset("flags", data=I % 2 == 0)
        own = file.create_dataset("own", data=(FORCE * 16).astype(np.int16))
        own.attrs["dt"] = 0.5
        own.attrs["unit"] = np.bytes_("V")
        file["link"] = h5py.SoftLink("/own")
        file["dangling"] = h5py.SoftLink("/nowhere")
        file.create_dataset("names", data=["a", "b"], dtype=h5py.string_dtype())
        file.create_dataset("empty", data=np.zeros(0))
        file.create_dataset("records", data=np.zeros(3, dtype=[("a", "f8"), ("b", "i4"), ("c", "u1")]))
    expect("groups.h5", "hdf5", [("run 1", "acc", "m/s^2", STEP, ODD), ("run 1", "force", "N", STEP, FORCE.astype("f4")), ("run 2/deep", "x[1]", "", STEP, FORCE),
                                 ("run 2/deep", "x[2]", "", STEP, ODD), ("run 2/deep", "h", "", STEP, FRF), ("run 2/deep", "flags", "", STEP, (I % 2 == 0).astype(float)),
                                 ("", "own", "V", 0.5, FORCE * 16), ("", "link", "V", 0.5, FORCE * 16), ("", "empty", "", None, []),
                                 ("records", "a", "", None, [0.0] * 3), ("records", "b", "", None, [0.0] * 3), ("records", "c", "", None, [0.0] * 3)])
    with h5py.File(OUT / "latest.h5", "w", libver="latest") as file:
        file.create_dataset("a", data=ODD, chunks=(5,), maxshape=(None,)).attrs["unit"] = "g"
        file.create_dataset("b", data=np.arange(6.0).reshape(2, 3))
        file.attrs["fs"] = 1000
    expect("latest.h5", "hdf5", [("", "a", "g", STEP, ODD), ("", "b[1]", "", STEP, [0.0, 1.0, 2.0]), ("", "b[2]", "", STEP, [3.0, 4.0, 5.0])])


def tdms():
    wf = {"wf_increment": STEP, "wf_samples": 1, "wf_start_offset": 0.0}
    with TdmsWriter(OUT / "plain.tdms") as writer:
        root, group = RootObject({"author": "X"}), GroupObject("Run 1", {"operator": "Y"})
        force = ChannelObject("Run 1", "force", FORCE, {**wf, "unit_string": "N"})
        acc = ChannelObject("Run 1", "it's /acc/", ODD, {**wf, "unit_string": "m/s^2"})
        writer.write_segment([root, group, force, acc])
        writer.write_segment([ChannelObject("Run 1", "force", FORCE[:10]), ChannelObject("Run 1", "it's /acc/", ODD[:10])])
        writer.write_segment([ChannelObject("Run 2", "i16", (FORCE * 16).astype(np.int16)), ChannelObject("Run 2", "c", FRF),
                              ChannelObject("Run 2", "words", ["a", "b"]), ChannelObject("Run 2", "none", np.zeros(0))])
    expect("plain.tdms", "tdms", [("Run 1", "force", "N", STEP, np.concatenate([FORCE, FORCE[:10]])),
                                  ("Run 1", "it's /acc/", "m/s^2", STEP, np.concatenate([ODD, ODD[:10]])),
                                  ("Run 2", "i16", "", None, FORCE * 16), ("Run 2", "c", "", None, FRF), ("Run 2", "none", "", None, [])])
    scale = {"NI_Number_Of_Scales": 1, "NI_Scaling_Status": "unscaled", "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 0.25,
             "NI_Scale[0]_Linear_Y_Intercept": 1.5, "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF, **wf, "NI_UnitDescription": "g"}
    raw = (FORCE * 16).astype(np.int32)
    with TdmsWriter(OUT / "scaled.tdms") as writer:
        writer.write_segment([ChannelObject("g", "acc", raw, scale)])
    with TdmsFile.open(OUT / "scaled.tdms") as file:
        expect("scaled.tdms", "tdms", [("g", "acc", "g", STEP, file["g"]["acc"][:])])
    # Interleaved, and a segment that repeats the objects of the one before: no writer of npTDMS makes them.
    def s(t):
        t = t.encode()
        return struct.pack("<I", len(t)) + t
    def obj(path, index):
        return s(path) + index + struct.pack("<I", 0)
    f64 = struct.pack("<IIIQ", 20, 10, 1, N)
    meta = struct.pack("<I", 3) + obj("/'g'", struct.pack("<I", 0xFFFFFFFF)) + obj("/'g'/'a'", f64) + obj("/'g'/'b'", f64)
    data = np.stack([FORCE, ODD], axis=1).astype("<f8").tobytes()
    lead = lambda toc, meta, data: b"TDSm" + struct.pack("<IIQQ", toc, 4713, len(meta) + len(data), len(meta))
    whole = lead(2 | 4 | 8 | 32, meta, data) + meta + data + lead(8 | 32, b"", data) + data
    (OUT / "interleaved.tdms").write_bytes(whole)
    expect("interleaved.tdms", "tdms", [("g", "a", "", None, np.concatenate([FORCE, FORCE])), ("g", "b", "", None, np.concatenate([ODD, ODD]))])
    # DAQmx: two channels of 16 bits in one buffer, big scale by a polynomial.
    def daqmx(path, offset, props):
        index = struct.pack("<IIIQ", 0x1269, 0xFFFFFFFF, 1, N) + struct.pack("<I", 1) + struct.pack("<IIIII", 3, 0, offset, 0, 0) + struct.pack("<II", 1, 4)
        out = s(path) + index + struct.pack("<I", len(props))
        for name, value in props.items():
            out += s(name) + (struct.pack("<I", 0x20) + s(value) if isinstance(value, str) else struct.pack("<Id", 10, value) if isinstance(value, float) else struct.pack("<II", 7, value))
        return out
    props = {"NI_Number_Of_Scales": 2, "NI_Scaling_Status": "unscaled", "NI_Scale[1]_Scale_Type": "Polynomial", "NI_Scale[1]_Polynomial_Coefficients_Size": 2,
             "NI_Scale[1]_Polynomial_Coefficients[0]": 0.5, "NI_Scale[1]_Polynomial_Coefficients[1]": 0.125, "NI_Scale[1]_Polynomial_Input_Source": 0, "wf_increment": STEP}
    a, b = (FORCE * 16).astype(np.int16), (ACC * 1024).astype(np.int16)
    meta = struct.pack("<I", 2) + daqmx("/'d'/'a'", 0, props) + daqmx("/'d'/'b'", 2, props)
    data = np.stack([a, b], axis=1).astype("<i2").tobytes()
    (OUT / "daqmx.tdms").write_bytes(lead(2 | 4 | 8 | 128, meta, data) + meta + data)
    with TdmsFile.open(OUT / "daqmx.tdms") as file:
        expect("daqmx.tdms", "tdms", [("d", "a", "", STEP, file["d"]["a"][:]), ("d", "b", "", STEP, file["d"]["b"][:])])
    broken = (OUT / "plain.tdms").read_bytes()
    first = struct.unpack_from("<Q", broken, 12)[0] + 28
    (OUT / "broken-off.tdms").write_bytes(broken[: first - 40])
    expect("broken-off.tdms", "tdms", [("Run 1", "force", "N", STEP, FORCE), ("Run 1", "it's /acc/", "m/s^2", STEP, ODD[: N - 5])])


def wavs():
    with wave.open(str(OUT / "pcm16.wav"), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(1000)
        file.writeframes(np.stack([(FORCE * 1024).astype("<i2"), (ACC * 1024).astype("<i2")], axis=1).tobytes())
    expect("pcm16.wav", "wav", [("", "channel 1", "", STEP, FORCE * 1024 / 32768), ("", "channel 2", "", STEP, ACC * 1024 / 32768)])
    scipy.io.wavfile.write(OUT / "float.wav", 1000, ODD.astype(np.float32))
    expect("float.wav", "wav", [("", "channel 1", "", STEP, ODD.astype(np.float32))])


def numpys():
    np.save(OUT / "two.npy", np.stack([FORCE, ODD], axis=1))
    expect("two.npy", "npy", [("", "two[1]", "", None, FORCE), ("", "two[2]", "", None, ODD)])
    np.save(OUT / "fortran.npy", np.asfortranarray(np.stack([FRF, FRF * 2], axis=1)))
    expect("fortran.npy", "npy", [("", "fortran[1]", "", None, FRF), ("", "fortran[2]", "", None, FRF * 2)])
    np.save(OUT / "big-endian.npy", ODD.astype(">f4"))
    expect("big-endian.npy", "npy", [("", "big-endian", "", None, ODD.astype(np.float32))])
    np.savez(OUT / "plain.npz", t=TIME, force=FORCE, acc=ODD)
    expect("plain.npz", "npz", [("", "force", "", STEP, FORCE), ("", "acc", "", STEP, ODD)])
    np.savez_compressed(OUT / "packed.npz", x=np.stack([FORCE, ODD]), fs=1000.0, names=np.array(["Acc 7", "Acc 9"]))
    expect("packed.npz", "npz", [("", "Acc 7", "", STEP, FORCE), ("", "Acc 9", "", STEP, ODD)])


def uffs():
    import pyuff
    frf = {"type": 58, "func_type": 4, "rsp_node": 12, "rsp_dir": 3, "ref_node": 1, "ref_dir": -3, "rsp_ent_name": "", "ref_ent_name": "", "data": FRF, "x": I * 0.5,
           "id1": "hammer", "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 13,
           "ordinate_axis_units_lab": "m/s^2", "orddenom_axis_units_lab": "N", "abscissa_axis_units_lab": "Hz", "orddenom_axis_lab": "Force"}
    time = {"type": 58, "func_type": 1, "rsp_node": 7, "rsp_dir": 1, "ref_node": 0, "ref_dir": 0, "data": ODD, "x": I * 0.5, "id1": "shaker",
            "abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12, "ordinate_axis_units_lab": "g", "abscissa_axis_units_lab": "s", "orddenom_spec_data_type": 0}
    for name, binary in [("ascii.uff", 0), ("binary.uff", 1)]:
        path = OUT / name
        path.unlink(missing_ok=True)
        for data in [frf, time]:
            pyuff.UFF(str(path)).write_sets({**data, "binary": binary}, "add")
        b = "b" if binary else ""
        read = pyuff.UFF(str(path)).read_sets()
        expect(name, "uff", [(f"1 (58{b}) frequency response", "12:+Z/1:-Z", "m/s^2/N", 0.5, read[0]["data"]),
                             (f"2 (58{b}) time response", "7:+X", "g", 0.5, read[1]["data"])])


def times_and_names():
    """Times among the channels, names and units beside the arrays, parts of complex numbers."""
    from nptdms import ChannelObject as Ch
    with TdmsWriter(OUT / "time-channel.tdms") as writer:
        writer.write_segment([Ch("Log", "time", TIME, {"unit_string": "s"}), Ch("Log", "force", FORCE, {"unit_string": "N"}), Ch("Log", "acc", ODD, {"unit_string": "m/s^2"})])
    expect("time-channel.tdms", "tdms", [("Log", "force", "N", STEP, FORCE), ("Log", "acc", "m/s^2", STEP, ODD)])
    cell = lambda *words: np.array(words, dtype=object)
    scipy.io.savemat(OUT / "timetable.mat", {"data": {"time": TIME, "Variables": np.column_stack([FORCE, ODD]), "Properties": {
        "VariableNames": cell("force", "acc"), "VariableUnits": cell("N", "g")}}})
    expect("timetable.mat", "mat", [("data", "force", "N", STEP, FORCE), ("data", "acc", "g", STEP, ODD)])
    scipy.io.savemat(OUT / "iddata.mat", {"z": {"y": ODD[:, None], "u": FORCE[:, None], "Ts": STEP, "OutputName": "acc", "InputName": "force", "OutputUnit": "g", "InputUnit": "N"}})
    expect("iddata.mat", "mat", [("z", "acc", "g", STEP, ODD), ("z", "force", "N", STEP, FORCE)])
    scipy.io.savemat(OUT / "signals.mat", {"out": {"time": TIME, "signals": {"values": np.column_stack([FORCE, ODD]), "label": cell("force", "acc")}}})
    expect("signals.mat", "mat", [("out/signals", "force", "", STEP, FORCE), ("out/signals", "acc", "", STEP, ODD)])
    scipy.io.savemat(OUT / "pairs.mat", {"Acc_1": np.column_stack([TIME, ODD])})
    expect("pairs.mat", "mat", [("", "time of Acc_1", "", None, TIME), ("", "Acc_1", "", STEP, ODD)])
    scipy.io.savemat(OUT / "parts.mat", {"f": I * 0.5, "H_re": FRF.real, "H_im": FRF.imag})
    expect("parts.mat", "mat", [("", "f", "", None, I * 0.5), ("", "H", "", 0.5, FRF)])
    with h5py.File(OUT / "columns.h5", "w") as f:
        data = f.create_dataset("data", data=np.column_stack([TIME, FORCE, ODD]))
        data.attrs["columns"], data.attrs["units"] = ["time", "force", "acc"], ["s", "N", "g"]
    expect("columns.h5", "hdf5", [("", "force", "N", STEP, FORCE), ("", "acc", "g", STEP, ODD)])


def described():
    """Names, units and rates in structs beside the arrays; frequencies and units in a group above; names below the parts."""
    head = lambda name, unit: {"SignalName": name, "Unit": unit, "SampleFrequency": 1 / STEP}
    scipy.io.savemat(OUT / "catman.mat", {"Channel_1_Data": FORCE[:, None], "Channel_1_Header": head("Kraft", "N"),
                                          "Channel_2_Data": ODD[:, None], "Channel_2_Header": head("Beschl", "m/s^2")})
    expect("catman.mat", "mat", [("", "Kraft", "N", STEP, FORCE), ("", "Beschl", "m/s^2", STEP, ODD)])
    with h5py.File(OUT / "axis-above.h5", "w") as f:
        f["frequencies"] = I * 0.5
        f["frf/real"], f["frf/imag"] = FRF.real, FRF.imag
        f["frf"].attrs["unit"] = "m/N"
    expect("axis-above.h5", "hdf5", [("", "frequencies", "", None, I * 0.5), ("frf", "FRF", "m/N", 0.5, FRF)])
    lines = ["Hz\t(m/s^2)/N\t(m/s^2)/N", "Linear\tReal\tImaginary", "Frequency\tFRF plate:1:+Z/rig:1:+Z\tFRF plate:1:+Z/rig:1:+Z"]
    lines += ["\t".join(repr(float(v)) for v in row) for row in zip(I * 0.5, FRF.real, FRF.imag)]
    text("names-below-parts.txt", "\n".join(lines) + "\n", "csv", [("", "FRF plate:1:+Z/rig:1:+Z", "(m/s^2)/N", 0.5, FRF)])


def one_channel_each():
    """Records of which every channel is a struct or a group of its own, and groups of one channel that are runs."""
    both = [("rec", "Hammer", "N", STEP, FORCE), ("rec", "Acc 7", "g", STEP, ODD)]
    fields = [("name", object), ("units", object), ("node", object), ("fs", object), ("data", object)]
    record = np.empty(2, dtype=fields)
    record[0], record[1] = ("Hammer", "N", 3.0, 1 / STEP, FORCE[:, None]), ("Acc 7", "g", 7.0, 1 / STEP, ODD[:, None])
    scipy.io.savemat(OUT / "struct-a-channel.mat", {"rec": record})
    expect("struct-a-channel.mat", "mat", both)
    with h5py.File(OUT / "v73-struct-a-channel.mat", "w", userblock_size=512) as file:
        refs, top = file.create_group("#refs#"), file.create_group("rec")
        top.attrs["MATLAB_class"] = np.bytes_("struct")
        for field, kind in fields:
            made = []
            for i, value in enumerate(record[field]):
                letters = isinstance(value, str)
                data = refs.create_dataset(f"{field}{i}", data=np.array([[ord(c)] for c in value], dtype="u2") if letters else np.atleast_2d(value).T)
                data.attrs["MATLAB_class"] = np.bytes_("char" if letters else "double")
                made.append(data.ref)
            top.create_dataset(field, data=np.array([made], dtype=h5py.ref_dtype).T, dtype=h5py.ref_dtype)
    with open(OUT / "v73-struct-a-channel.mat", "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: PCWIN64 HDF5 schema 1.00 .".ljust(116) + b" " * 8 + struct.pack("<H", 0x0200) + b"IM")
    expect("v73-struct-a-channel.mat", "mat", both)
    with h5py.File(OUT / "group-a-channel.h5", "w") as file:
        for name, unit, values in [("Hammer", "N", FORCE), ("Acc 7", "g", ODD)]:
            group = file.create_group(f"rec/{name}")
            group.attrs["fs"], group.attrs["unit"] = 1 / STEP, unit
            group.create_dataset("data", data=values)
        for name, values in [("decay 1", FORCE), ("decay 2", ODD)]:
            file.create_group(f"runs/{name}").create_dataset("acc", data=values).attrs["dt"] = STEP
    expect("group-a-channel.h5", "hdf5", both + [("runs/decay 1", "acc", "", STEP, FORCE), ("runs/decay 2", "acc", "", STEP, ODD)])
    wf = {"wf_increment": STEP, "wf_samples": 1, "wf_start_offset": 0.0}
    with TdmsWriter(OUT / "group-a-channel.tdms") as writer:
        writer.write_segment([ChannelObject(name, "Untitled", values, {**wf, "unit_string": unit}) for name, unit, values in [("Hammer", "N", FORCE), ("Acc 7", "g", ODD)]])
    expect("group-a-channel.tdms", "tdms", [("", *channel[1:]) for channel in both])


def clocks_and_parts():
    """A clock that passes midnight; a table of ME'scope; levels over the reference of ISO 1683."""
    clock = [f"{t // 3600 % 24:02.0f}:{t // 60 % 60:02.0f}:{t % 60:06.3f}" for t in (86399990 + np.arange(N)) / 1000]
    comma = lambda v: repr(float(v)).replace(".", ",")
    lines = ["Zeit;Kraft;Acc", "hh:mm:ss.fff;N;g"] + [f"{t};{comma(a)};{comma(b)}" for t, a, b in zip(clock, FORCE, ODD)]
    text("midnight.csv", "\n".join(lines) + "\n", "csv", [("", "Kraft", "N", STEP, FORCE), ("", "Acc", "g", STEP, ODD)])
    lines = ["M#s\t1\t1\t2\t2", "DOFs\t2Z:8Z\t2Z:8Z\t4Z:8Z\t4Z:8Z", "Units\tg/lbf\tg/lbf\tg/lbf\tg/lbf", "Hz\tReal\tImag\tReal\tImag"]
    lines += ["\t".join(repr(float(v)) for v in row) for row in zip(I * 0.5, FRF.real, FRF.imag, ODD, ACC)]
    text("mescope.txt", "\n".join(lines) + "\n", "csv", [("", "1 2Z:8Z", "g/lbf", 0.5, FRF), ("", "2 4Z:8Z", "g/lbf", 0.5, ODD + 1j * ACC)])


def rarer_programs():
    """Times in a part of their own, lists of names beside arrays, cells of names and arrays, frames of pandas, blocks of one channel each."""
    record = lambda kind, rows: np.array([rows], dtype=[(name, object) for name in kind])  # noqa: E731
    x = record(["Name", "Unit", "Data"], [("Time", "s", TIME[None, :])])
    y = record(["Name", "Unit", "Data"], [("Force", "N", FORCE[None, :]), ("Acc 1", "g", ODD[None, :])])
    scipy.io.savemat(OUT / "times-apart.mat", {"rec": {"X": x, "Y": y}})
    expect("times-apart.mat", "mat", [("rec/Y", "Force", "N", STEP, FORCE), ("rec/Y", "Acc 1", "g", STEP, ODD)])
    cells = np.empty((3, 2), dtype=object)
    for k, column in enumerate([("Force", "N", FORCE[:, None]), ("Acc", "g", ODD[:, None])]):
        for row, value in enumerate(column):
            cells[row, k] = value
    scipy.io.savemat(OUT / "named-cells.mat", {"fs": 1 / STEP, "held": cells})
    expect("named-cells.mat", "mat", [("held", "Force", "N", STEP, FORCE), ("held", "Acc", "g", STEP, ODD)])
    scipy.io.savemat(OUT / "list-of-one.mat", {"dt": STEP, "x": np.vstack([FORCE, ODD]), "xLabels": np.array(["Force (N)", "Acc (g)"], dtype=object)})
    expect("list-of-one.mat", "mat", [("", "Force (N)", "N", STEP, FORCE), ("", "Acc (g)", "g", STEP, ODD)])
    with h5py.File(OUT / "frame.h5", "w") as file:
        group = file.create_group("df")
        group["axis1"], group["block0_items"] = TIME, np.array([b"force [N]", b"acc [g]"])
        group["block0_values"] = np.column_stack([FORCE, ODD])
    expect("frame.h5", "hdf5", [("df", "axis1", "", None, TIME), ("df", "force [N]", "N", STEP, FORCE), ("df", "acc [g]", "g", STEP, ODD)])
    with h5py.File(OUT / "lists-above.h5", "w") as file:
        file.attrs["fs"], file.attrs["channel_names"], file.attrs["channel_units"] = 1 / STEP, ["force", "acc"], ["N", "g"]
        file.create_group("run 1")["samples"] = np.column_stack([FORCE, ODD])
    expect("lists-above.h5", "hdf5", [("run 1", "force", "N", STEP, FORCE), ("run 1", "acc", "g", STEP, ODD)])
    blocks = [["Channel name\t" + name, "X unit\ts", "Y unit\t" + unit, "s\t" + unit] + [f"{float(t)!r}\t{float(v)!r}" for t, v in zip(TIME, values)] + [""]
              for name, unit, values in [("Force:1:+Z", "N", FORCE), ("Beam:1:+Z", "g", ODD)]]
    text("blocks.txt", "\n".join(blocks[0] + blocks[1]), "csv", [("", "Force:1:+Z", "N", STEP, FORCE), ("", "Beam:1:+Z", "g", STEP, ODD)])
    rows = [f"{float(t)!r} sec,ok,{float(a)!r},{float(b)!r}" for t, a, b in zip(TIME, FORCE, ODD)]
    text("spans-and-states.csv", "\n".join(['"Time","State","Force', '[N]","Acc', '[g]"'] + rows) + "\n", "csv", [("", "Force", "N", STEP, FORCE), ("", "Acc", "g", STEP, ODD)])


import scipy.io.wavfile  # noqa: E402
import scipy.sparse  # noqa: E402

for make in [tables, lvms, sheets, mats, hdf5s, tdms, wavs, numpys, uffs, times_and_names, described, one_channel_each, clocks_and_parts, rarer_programs]:
    make()
(OUT / "expected.json").write_text(json.dumps(EXPECTED, indent=0) + "\n")
print(f"{len(EXPECTED)} files in {OUT}")
