"""Further dialects of laboratories, tried as try_import.py does: rarer forms of Universal Files, MAT, HDF5, TDMS, LVM and text.

    pip install numpy scipy h5py npTDMS openpyxl hdf5storage pyuff
    python scripts/interchange/dialects.py target/debug/dashpot /tmp/trial

A development tool: no test needs it.
"""

import struct

import h5py
import numpy as np
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

import try_import
from try_import import ACC, ACCELERANCE, DISP, FORCE, FREQ, FS, G, LINE, N, RECEPTANCE, T, case, number, table, text

try_import.CASES.clear()

# Universal Files, written by hand.

UNITS_SI = ["    -1", "   164", "         1SI: Meter (newton)          2",
            "  1.0000000000000000D+00  1.0000000000000000D+00  1.0000000000000000D+00", "  2.7314999999999998D+02", "    -1"]
UNITS_MM = ["    -1", "   164", "         5MM: mm (newton)             2",
            "  1.0000000000000000D+03  1.0000000000000000D+00  1.0000000000000000D+00", "  2.7314999999999998D+02", "    -1"]
HEADER = ["    -1", "   151", "Beam test", "NONE", "LMS Test.Lab Rev 17", "21-Mar-24  10:11:12", "21-Mar-24  10:11:12", "LMS Test.Lab Rev 17",
          "21-Mar-24  10:11:12", "    -1"]


def axis(code, exponents, label, unit):
    return f"{code:10d}{exponents[0]:5d}{exponents[1]:5d}{exponents[2]:5d} {label:20s} {unit:20s}".rstrip()


def set58(kind, values, x, response=(1, 3), reference=(1, 3), ids=None, ordinate=(12, "m/s^2"), denominator=(13, "N"), abscissa=(18, "Hz"), even=True,
          double=True, fmt=None, names=("NONE", "NONE")):
    """Lines of a function in ascii; `kind` 1 time, 2 autospectrum, 4 FRF, 6 coherence."""
    values = np.asarray(values)
    complex_ = np.iscomplexobj(values)
    code = {(False, False): 2, (False, True): 4, (True, False): 5, (True, True): 6}[(complex_, double)]
    ids = ids or ["Record    1", "NONE", "21-Mar-24  10:11:12", "NONE", "NONE"]
    lines = ["    -1", "    58"] + list(ids)
    lines.append(f"{kind:5d}{1:10d}{1:5d}{0:10d} {names[0]:10s}{response[0]:10d}{response[1]:4d} {names[1]:10s}{reference[0]:10d}{reference[1]:4d}")
    step = (x[1] - x[0]) if even else 0.0
    lines.append(f"{code:10d}{len(values):10d}{1 if even else 0:10d}{x[0]:13.5E}{step:13.5E}{0:13.5E}")
    lines.append(axis(abscissa[0], (0, 0, 0), "Frequency" if abscissa[0] == 18 else "Time", abscissa[1]))
    lines.append(axis(ordinate[0], (0, 0, 0), "Acceleration" if ordinate[0] == 12 else "Force", ordinate[1]))
    lines.append(axis(denominator[0], (0, 0, 0), "NONE", denominator[1]))
    lines.append(axis(0, (0, 0, 0), "NONE", "NONE"))
    flat = []
    for i, value in enumerate(values):
        if not even:
            flat.append(x[i])
        flat += [value.real, value.imag] if complex_ else [value]
    per, form = (4, "{:20.12E}") if double else (6, "{:13.5E}")
    if fmt:
        per, form = fmt
    if not even and double:
        # Abscissa E13.5, ordinate E20.12: three or two to a line.
        rows, width = [], 3 if complex_ else 2
        for i in range(0, len(flat), width * (1 if complex_ else 2)):
            rows.append("".join(("{:13.5E}" if k % (3 if complex_ else 2) == 0 else "{:20.12E}").format(v) for k, v in enumerate(flat[i:i + width * (1 if complex_ else 2)])))
        lines += rows
    else:
        lines += ["".join(form.format(v) for v in flat[i:i + per]) for i in range(0, len(flat), per)]
    return lines + ["    -1"]


def frf(**more):
    return set58(4, ACCELERANCE, FREQ, **more)


@case("testlab-mixed.uff")
def _(p):
    force = set58(1, FORCE, T, ordinate=(13, "N"), denominator=(0, "NONE"), abscissa=(17, "s"))
    power = set58(2, np.abs(ACCELERANCE) ** 2, FREQ, ordinate=(12, "(m/s^2)^2"), denominator=(0, "NONE"))
    coherence = set58(6, np.ones(len(FREQ)), FREQ, ordinate=(0, "/"), denominator=(0, "NONE"))
    text(p, HEADER + UNITS_SI + force + power + frf(names=("Plate", "Plate")) + coherence, end="\r\n")


@case("empty-id-lines.uff")
def _(p):
    text(p, frf(ids=["", "", "", "", ""]))


@case("millimetres-164.uff")
def _(p):
    text(p, UNITS_MM + set58(4, ACCELERANCE * 1e3, FREQ, ordinate=(12, ""), denominator=(13, "")))


@case("millimetres-label.uff")
def _(p):
    text(p, UNITS_MM + set58(4, ACCELERANCE * 1e3, FREQ, ordinate=(12, "mm/s^2"), denominator=(13, "N")))


@case("receptance-mm.uff")
def _(p):
    text(p, set58(4, RECEPTANCE * 1e3, FREQ, ordinate=(8, "mm"), denominator=(13, "N")))


@case("reversed.uff")
def _(p):
    text(p, set58(4, -ACCELERANCE, FREQ, response=(1, -3), reference=(1, 3)))


@case("g-per-newton.uff")
def _(p):
    text(p, set58(4, ACCELERANCE / G, FREQ, ordinate=(12, "g"), denominator=(13, "N")))


@case("single-precision.uff")
def _(p):
    text(p, frf(double=False))


@case("touching-numbers.uff")
def _(p):
    text(p, frf(fmt=(4, "{:20.13E}")))


@case("d-exponents.uff")
def _(p):
    text(p, [line.replace("E", "D") if line[:20].strip() and "." in line and i > 20 else line for i, line in enumerate(frf())])


@case("uneven.uff")
def _(p):
    keep = np.arange(len(FREQ)) % 7 != 3
    text(p, set58(4, ACCELERANCE[keep], FREQ[keep], even=False))


@case("no-last-delimiter.uff")
def _(p):
    text(p, frf()[:-1])


@case("trailing-garbage.uff")
def _(p):
    text(p, frf())
    with open(p, "ab") as f:
        f.write(b"\x1a\x00\x00\x00\r\nEND OF EXPORT\r\n")


@case("words-before.uff")
def _(p):
    text(p, ["Exported by measuring system", ""] + frf())


@case("narrow-delimiters.uff")
def _(p):
    text(p, [line.strip() if line.strip() in ("-1", "58") else line for line in frf()], end="\r\n")


@case("trailing-blanks.uff")
def _(p):
    text(p, [line.ljust(80) for line in HEADER + frf()], end="\r\n")


@case("unv-double-newlines.unv")
def _(p):
    text(p, frf(), end="\r\r\n")


def binary58(p, values, x, big, double, before=()):
    """58b of either byte order."""
    order = ">" if big else "<"
    lines = frf(double=double)
    ascii_ = lines[2:13]
    raw = np.column_stack([values.real, values.imag]).ravel().astype(order + ("f8" if double else "f4")).tobytes()
    head = f"{58:6d}b{1 if not big else 2:6d}{2:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    with open(p, "wb") as f:
        for line in before:
            f.write(line.encode() + b"\r\n")
        f.write(b"    -1\r\n" + head.encode() + b"\r\n")
        for line in ascii_:
            f.write(line.ljust(80).encode() + b"\r\n")
        f.write(raw)
        f.write(b"\r\n    -1\r\n")


@case("binary-little-single.uff")
def _(p):
    binary58(p, ACCELERANCE, FREQ, False, False, HEADER + UNITS_SI)


@case("binary-big-double.uff")
def _(p):
    binary58(p, ACCELERANCE, FREQ, True, True)


@case("time-records.uff")
def _(p):
    f = set58(1, FORCE, T, ordinate=(13, "N"), denominator=(0, "NONE"), abscissa=(17, "s"))
    a = set58(1, ACC, T, ordinate=(12, "m/s^2"), denominator=(0, "NONE"), abscissa=(17, "s"))
    text(p, HEADER + UNITS_SI + f + a)


@case("time-two-runs.uff")
def _(p):
    f = set58(1, FORCE, T, ordinate=(13, "N"), denominator=(0, "NONE"), abscissa=(17, "s"))
    a = set58(1, ACC, T, ordinate=(12, "m/s^2"), denominator=(0, "NONE"), abscissa=(17, "s"))
    text(p, HEADER + UNITS_SI + f + a + f + a)


@case("time-mm-164.uff")
def _(p):
    f = set58(1, FORCE, T, ordinate=(13, "NONE"), denominator=(0, "NONE"), abscissa=(17, "NONE"))
    a = set58(1, ACC * 1e3, T, ordinate=(12, "NONE"), denominator=(0, "NONE"), abscissa=(17, "NONE"))
    text(p, UNITS_MM + f + a)


@case("general-type-0.uff")
def _(p):
    text(p, set58(0, ACCELERANCE, FREQ))


@case("psd-complex.uff", (), LINE)
def _(p):
    text(p, set58(9, np.abs(ACCELERANCE) ** 2 + 0j, FREQ, ordinate=(12, "g^2/Hz"), denominator=(0, "NONE")))


@case("power-only.uff", (), LINE)
def _(p):
    text(p, set58(2, np.abs(ACCELERANCE) ** 2, FREQ, ordinate=(12, "(m/s^2)^2"), denominator=(0, "NONE")))


# MAT.


def siemens(values, unit, name):
    return {"x_values": {"start_value": FREQ[0], "increment": 0.25, "number_of_values": float(len(FREQ)), "quantity": {"label": "Hz"}},
            "y_values": {"values": values[:, None], "quantity": {"label": unit, "info": ""}}, "function_record": {"name": name, "type": "FrequencyResponse"}}


@case("siemens-frf.mat")
def _(p):
    scipy.io.savemat(p, {"FRF": siemens(ACCELERANCE, "m/s^2/N", "Plate:1:+Z/Plate:1:+Z")})


@case("siemens-frf-g.mat")
def _(p):
    scipy.io.savemat(p, {"FRF": siemens(ACCELERANCE / G, "g/N", "FRF Plate:1:+Z/Plate:1:+Z")})


@case("siemens-channels.mat")
def _(p):
    one = siemens(ACCELERANCE, "m/s^2/N", "FrequencyResponse")
    one["function_record"]["primary_channel"] = {"point": "Plate:1", "direction": "+Z", "name": "Plate:1:+Z"}
    one["function_record"]["secondary_channel"] = {"point": "Plate:1", "direction": "+Z", "name": "Plate:1:+Z"}
    scipy.io.savemat(p, {"FrequencyResponse": one})


@case("idfrd.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"sys": {"Frequency": FREQ, "FrequencyUnit": "Hz", "ResponseData": RECEPTANCE.reshape(1, 1, -1), "InputName": np.array(["force@1"], dtype=object),
                                 "OutputName": np.array(["disp@1"], dtype=object)}}, oned_as="column")


@case("h-cube.mat", ["--form", "accelerance"])
def _(p):
    scipy.io.savemat(p, {"H": ACCELERANCE.reshape(-1, 1, 1), "f": FREQ}, oned_as="column")


@case("h-rad.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"H": RECEPTANCE, "omega": 2 * np.pi * FREQ}, oned_as="column")


@case("cells.mat")
def _(p):
    cells = np.empty((1, 2), dtype=object)
    cells[0, 0], cells[0, 1] = FORCE[:, None], ACC[:, None]
    scipy.io.savemat(p, {"data": cells, "names": np.array(["Force", "Acc 1"], dtype=object), "units": np.array(["N", "m/s^2"], dtype=object), "fs": FS})


@case("nested.mat")
def _(p):
    scipy.io.savemat(p, {"meas": {"run1": {"time": T, "channels": {"force": {"data": FORCE, "unit": "N"}, "acc_1": {"data": ACC, "unit": "m/s^2"}}}}})


@case("dt-struct.mat")
def _(p):
    scipy.io.savemat(p, {"rec": {"dt": 1 / FS, "force": FORCE, "acc": ACC, "info": "beam", "date": "2024-03-21"}})


def v73(p, fill):
    with h5py.File(p, "w", userblock_size=512) as f:
        fill(f)
    with open(p, "r+b") as f:
        f.write(b"MATLAB 7.3 MAT-file, Platform: PCWIN64, Created on: Thu Mar 21 10:00:00 2024 HDF5 schema 1.00 .".ljust(116) + b" " * 8 + struct.pack("<H", 0x0200) + b"IM")


def matlab(group, name, values, kind="double"):
    values = np.asarray(values)
    if np.iscomplexobj(values):
        raw = np.empty(values.shape, dtype=[("real", "f8"), ("imag", "f8")])
        raw["real"], raw["imag"] = values.real, values.imag
        values = raw
    data = group.create_dataset(name, data=values)
    data.attrs["MATLAB_class"] = np.bytes_(kind)
    return data


@case("v73-frf.mat", ["--form", "accelerance"])
def _(p):
    v73(p, lambda f: (matlab(f, "f", FREQ[None, :]), matlab(f, "H", ACCELERANCE[None, :])))


@case("v73-siemens.mat")
def _(p):
    def fill(f):
        top = f.create_group("FRF")
        x, y = top.create_group("x_values"), top.create_group("y_values")
        matlab(x, "start_value", [[FREQ[0]]]), matlab(x, "increment", [[0.25]]), matlab(x, "number_of_values", [[float(len(FREQ))]])
        matlab(y, "values", ACCELERANCE[None, :])
        q = y.create_group("quantity")
        matlab(q, "label", np.array([[ord(c)] for c in "m/s^2/N"], dtype="u2"), "char")
        r = top.create_group("function_record")
        matlab(r, "name", np.array([[ord(c)] for c in "Plate:1:+Z/Plate:1:+Z"], dtype="u2"), "char")
    v73(p, fill)


@case("v73-timetable.mat", (), LINE)
def _(p):
    def fill(f):
        refs = f.create_group("#refs#")
        matlab(refs, "a", FORCE[None, :])
        data = f.create_dataset("TT", data=np.array([[0xDD000000, 2, 1, 1, 1, 1]], dtype="u4"))
        data.attrs["MATLAB_class"] = np.bytes_("timetable")
        data.attrs["MATLAB_object_decode"] = np.int32(3)
    v73(p, fill)


# HDF5.


@case("frf-cube.h5", ["--form", "receptance"])
def _(p):
    with h5py.File(p, "w") as f:
        f["freq"] = FREQ
        f["H"] = RECEPTANCE.reshape(1, 1, -1)


@case("frf-complex-columns.h5")
def _(p):
    with h5py.File(p, "w") as f:
        f["frequency"] = FREQ
        f["frequency"].attrs["unit"] = "Hz"
        f["1z_1z"] = ACCELERANCE
        f["1z_1z"].attrs["unit"] = "(m/s^2)/N"


@case("int16-scale.h5")
def _(p):
    with h5py.File(p, "w") as f:
        for name, values, unit in [("force", FORCE, "N"), ("acc 1", ACC, "m/s^2")]:
            scale = np.abs(values).max() / 30000
            data = f.create_dataset(f"daq/{name}", data=np.round(values / scale).astype("i2"), compression="gzip", chunks=(100,))
            data.attrs["unit"], data.attrs["scale"], data.attrs["sampling_rate"] = unit, scale, FS


@case("rows.h5")
def _(p):
    with h5py.File(p, "w") as f:
        data = f.create_dataset("measurement", data=np.vstack([FORCE, ACC]).astype(">f4"), compression="gzip", shuffle=True)
        data.attrs["channel_names"], data.attrs["units"], data.attrs["fs"] = ["Force", "Acc 1"], ["N", "m/s^2"], FS


@case("runs.h5")
def _(p):
    with h5py.File(p, "w") as f:
        for k in range(3):
            group = f.create_group(f"run {k + 1}")
            group.attrs["sampling_rate"] = FS
            group["force"], group["acc"] = FORCE, ACC
            group["force"].attrs["unit"], group["acc"].attrs["unit"] = "N", "m/s^2"


@case("compound-table.h5")
def _(p):
    with h5py.File(p, "w") as f:
        raw = np.zeros(N, dtype=[("time", "f8"), ("force", "f4"), ("acc", "f8")])
        raw["time"], raw["force"], raw["acc"] = T, FORCE, ACC
        f["table"] = raw


# TDMS.


def tdms(p, groups):
    with TdmsWriter(str(p)) as w:
        objects = [RootObject({"Author": "x", "Sample Rate": FS})]
        for group, channels in groups:
            objects.append(GroupObject(group))
            objects += [ChannelObject(group, name, values, properties) for name, values, properties in channels]
        w.write_segment(objects)


def wave(unit, offset=0.0):
    return {"wf_increment": 1 / FS, "wf_start_offset": offset, "wf_samples": N, "NI_UnitDescription": unit, "NI_ChannelName": "x"}


@case("ni-unit-description.tdms")
def _(p):
    tdms(p, [("Log", [("cDAQ1Mod1/ai0 Force", FORCE, wave("N")), ("cDAQ1Mod1/ai1 Acc", ACC / G, wave("g"))])])


@case("groups-are-runs.tdms")
def _(p):
    tdms(p, [(f"Run {k}", [("Force", FORCE, {**wave("N"), "unit_string": "N"}), ("Acc 1", ACC, {**wave("m/s^2"), "unit_string": "m/s^2"})]) for k in (1, 2, 3)])


@case("sample-rate-property.tdms")
def _(p):
    tdms(p, [("Data", [("Force", FORCE, {"unit_string": "N"}), ("Acc 1", ACC, {"unit_string": "m/s^2"})])])


@case("with-comments.tdms")
def _(p):
    tdms(p, [("Data", [("Force", FORCE, wave("N")), ("Acc 1", ACC, wave("m/s^2")), ("Comment", ["start", "stop"], {})])])


# LVM.

LVM = ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\t{sep}", "Decimal_Separator\t{dec}", "Multi_Headings\t{multi}",
       "X_Columns\t{x}", "Time_Pref\t{pref}", "Operator\tlab", "Date\t2024/03/01", "Time\t12:00:00.1234567890123456789", "***End_of_Header***\t"]


def lvm(p, x, blocks=1, multi="Yes", comma=False, special=False, pref="Relative", end="\r\n", sep="\t"):
    head = [line.format(sep="Tab" if sep == "\t" else "Comma", dec="," if comma else ".", multi=multi, x=x, pref=pref) for line in LVM]
    head = [line.replace("\t", sep) for line in head]
    lines = head + [sep]
    if special:
        lines += ["***Start_Special***", sep.join(["Waveform", "extra"]), "1" + sep + "2", "***End_Special***", ""]
    n = N // blocks
    for block in range(blocks):
        rows = slice(block * n, (block + 1) * n)
        if block == 0 or multi == "Yes":
            twice = x == "Multi"
            def both(word, a, b):
                return sep.join([word, a, "", b, ""] if twice else [word, a, b, ""])
            x0 = number(T[rows][0], comma)
            lines += [sep.join(["Channels", "2", "", ""]), both("Samples", str(n), str(n)), both("Date", "2024/03/01", "2024/03/01"), both("Time", "12:00:00.1", "12:00:00.1"),
                      both("Y_Unit_Label", "N", "m/s^2"), both("X_Dimension", "Time", "Time"), both("X0", x0, x0), both("Delta_X", number(1 / FS, comma), number(1 / FS, comma)),
                      sep.join(["***End_of_Header***", "", "", ""])]
            names = ["X_Value", "Force", "X_Value", "Acc 1", "Comment"] if twice else ["X_Value", "Force", "Acc 1", "Comment"]
            lines.append(sep.join(names))
        columns = {"One": [T[rows], FORCE[rows], ACC[rows]], "Multi": [T[rows], FORCE[rows], T[rows], ACC[rows]], "No": [FORCE[rows], ACC[rows]]}[x]
        body = table(columns, sep, comma)
        if x == "No":
            body = [sep + row for row in body]
        body[0] += sep + "beginning of block"
        lines += body + ([""] if multi == "Yes" else [])
    text(p, lines, end=end)


@case("no-x.lvm")
def _(p):
    lvm(p, "No")


@case("no-x-comma-blocks.lvm")
def _(p):
    lvm(p, "No", blocks=5, comma=True)


@case("one-x-special.lvm")
def _(p):
    lvm(p, "One", blocks=2, special=True)


@case("multi-x-blocks.lvm")
def _(p):
    lvm(p, "Multi", blocks=7)


@case("absolute.lvm")
def _(p):
    lvm(p, "One", pref="Absolute")


@case("comma-separated.lvm")
def _(p):
    lvm(p, "One", sep=",")


@case("single-heading-blocks.lvm")
def _(p):
    lvm(p, "One", blocks=3, multi="No")


# Text.


@case("picoscope.csv")
def _(p):
    text(p, ["Time,Channel A,Channel B", "(ms),(N),(m/s²)", ""] + table([T * 1e3, FORCE, ACC], ","))


@case("sep-line.csv")
def _(p):
    text(p, ["sep=;", "Time [s];Force [N];Acc [m/s^2]"] + table([T, FORCE, ACC], ";"), "utf-8-sig")


@case("quoted-decimal-comma.csv")
def _(p):
    rows = [",".join(f'"{number(v, True)}"' for v in row) for row in zip(T, FORCE, ACC)]
    text(p, ['"Zeit [s]","Kraft [N]","Beschleunigung [m/s²]"'] + rows)


@case("old-mac.csv")
def _(p):
    text(p, ["Time [s],Force [N],Acc [m/s^2]"] + table([T, FORCE, ACC], ","), end="\r")


@case("unicode-minus.csv")
def _(p):
    text(p, ["Time [s];Force [N];Acc [m/s^2]"] + [row.replace("-", "−") for row in table([T, FORCE, ACC], ";")])


@case("swiss-thousands.csv")
def _(p):
    rows = [f"{number(t)};{f:,.5f};{a:,.5f}".replace(",", "'") for t, f, a in zip(T, FORCE * 1e3, ACC * 1e3)]
    text(p, ["Zeit [s];Kraft [mN];Beschleunigung [mm/s²]"] + rows)


@case("iso-zulu.csv")
def _(p):
    stamps = np.datetime64("2024-03-21T10:11:12") + (T * 1e6).astype("timedelta64[us]")
    text(p, ["Timestamp,Force (N),Acc (m/s2)"] + [f"{s}Z,{f:.9g},{a:.9g}" for s, f, a in zip(stamps, FORCE, ACC)])


@case("iso-offset.csv")
def _(p):
    stamps = np.datetime64("2024-03-21T10:11:12") + (T * 1e6).astype("timedelta64[us]")
    text(p, ["Timestamp,Force (N),Acc (m/s2)"] + [f"{s}+01:00,{f:.9g},{a:.9g}" for s, f, a in zip(stamps, FORCE, ACC)])


@case("flexlogger.csv")
def _(p):
    head = ["Name,Beam test", "Start time,3/21/2024 10:11:12.000 AM", "Sample rate,1000 Hz", "", "Time,Force,Acc 1", ",N,m/s²"]
    text(p, head + table([T, FORCE, ACC], ","), "utf-8-sig")


@case("units-after-comma.txt")
def _(p):
    text(p, ["Time, s\tForce, N\tAcceleration, m/s^2"] + table([T, FORCE, ACC], "\t"))


@case("angle-brackets.csv")
def _(p):
    text(p, ["Time <s>;Force <N>;Acc <m/s^2>"] + table([T, FORCE, ACC], ";"))


@case("double-slash-comments.txt")
def _(p):
    text(p, ["// rig 3", "! hammer 2", "Time[s] Force[N] Acc[m/s^2]"] + table([T, FORCE, ACC], " "))


@case("trailing-tabs.txt")
def _(p):
    text(p, ["Time [s]\tForce [N]\tAcc [m/s^2]\t"] + [row + "\t" for row in table([T, FORCE, ACC], "\t")] + ["", "\x1a"])


@case("nul-bytes-at-end.csv")
def _(p):
    text(p, ["Time [s],Force [N],Acc [m/s^2]"] + table([T, FORCE, ACC], ","))
    with open(p, "ab") as f:
        f.write(b"\0" * 512)


@case("hms-column.csv")
def _(p):
    stamps = [f"00:00:{t:06.3f}" for t in T]
    text(p, ["Time (HH:mm:ss.fff);Force (N);Acc (m/s²)"] + [f"{s};{f:.9g};{a:.9g}" for s, f, a in zip(stamps, FORCE, ACC)], "latin-1")


@case("per-cent-and-units-row.dat")
def _(p):
    text(p, ["% Beam", "% time force acc", "% s N m/s^2"] + table([T, FORCE, ACC], "\t"))


@case("meta-colon.txt")
def _(p):
    head = ["File: test 3", "Channels: 2", "SampleRate: 1000", "X-Unit: s", "", "Force [N]\tAcc [m/s^2]"]
    text(p, head + table([FORCE, ACC], "\t"))


@case("two-blocks.csv")
def _(p):
    a, b = slice(0, N // 2), slice(N // 2, N)
    head = "Time [s],Force [N],Acc [m/s^2]"
    text(p, ["Block 1", head] + table([T[a], FORCE[a], ACC[a]], ",") + ["", "Block 2", head] + table([T[b], FORCE[b], ACC[b]], ","))


@case("frf-real-imag-unit-row.csv")
def _(p):
    text(p, ["Frequency;H(1,1) Real;H(1,1) Imag", "Hz;(m/s²)/N;(m/s²)/N"] + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], ";", True))


@case("frf-db-g.csv")
def _(p):
    text(p, ["Frequency (Hz),Magnitude (dB re 1 g/N),Phase (deg)"] + table([FREQ, 20 * np.log10(np.abs(ACCELERANCE) / G), np.degrees(np.angle(ACCELERANCE))], ","))


@case("displacement-um-ms.txt")
def _(p):
    text(p, ["Zeit [ms]\tKraft [N]\tAuslenkung [µm]"] + table([T * 1e3, FORCE, DISP * 1e6], "\t", True), "cp1252")


if __name__ == "__main__":
    try_import.main()
