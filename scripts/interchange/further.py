"""Still other files of laboratories, tried as try_import.py does: structs of acquisition programs, xarray, one sheet a channel, odd headers.

    pip install numpy scipy h5py hdf5storage npTDMS openpyxl pyuff
    python scripts/interchange/further.py target/release/dashpot /tmp/trial

A development tool: no test needs it.
"""

import io
import json
import pickle
import wave
import zipfile

import h5py
import hdf5storage
import numpy as np
import openpyxl
import scipy.io
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

import try_import
from try_import import ACC, ACCELERANCE, DISP, FORCE, FREQ, FS, G, LINE, MOBILITY, N, OMEGA, RECEPTANCE, T, VEL, case, number, table, text

try_import.CASES.clear()
from dialects import set58, frf, binary58  # noqa: E402

try_import.CASES.clear()


# MAT: structs of acquisition programs.


@case("catman-export.mat")
def _(p):
    head = lambda name, unit: {"SignalName": name, "Unit": unit, "SampleFrequency": FS, "NoOfItems": float(N)}  # noqa: E731
    scipy.io.savemat(p, {"File_Header": {"NumberOfChannels": "3", "SampleFrequency": f"{FS:.0f}"},
                         "Channel_1_Data": T[:, None], "Channel_1_Header": head("Zeit", "s"),
                         "Channel_2_Data": FORCE[:, None], "Channel_2_Header": head("Kraft", "N"),
                         "Channel_3_Data": ACC[:, None], "Channel_3_Header": head("Beschleunigung", "m/s²")})


@case("data-and-units.mat")
def _(p):
    scipy.io.savemat(p, {"data": np.column_stack([FORCE, ACC / G]), "units": np.array(["N", "g"], dtype=object), "names": np.array(["Force", "Acc"], dtype=object), "Fs": FS})


@case("char-matrix-names.mat")
def _(p):
    scipy.io.savemat(p, {"data": np.column_stack([T, FORCE, ACC]), "channelNames": np.array(["time [s]   ", "force [N]  ", "acc [m/s2] "])})


@case("runs-as-struct-array.mat")
def _(p):
    runs = np.zeros((2,), dtype=[("t", object), ("force_N", object), ("acc_m_s2", object), ("f0", object)])
    for i in range(2):
        runs[i] = (T[:, None], (1 + i) * FORCE[:, None], (1 + i) * ACC[:, None], 20.0)
    scipy.io.savemat(p, {"runs": runs})


@case("runs-as-cells.mat")
def _(p):
    cells = np.empty((1, 2), dtype=object)
    for i in range(2):
        cells[0, i] = {"time": T[:, None], "force": (1 + i) * FORCE[:, None], "acceleration": (1 + i) * ACC[:, None]}
    scipy.io.savemat(p, {"test": {"runs": cells, "operator": "MM"}})


@case("single-precision.mat")
def _(p):
    scipy.io.savemat(p, {"t": np.float32(T), "F": np.float32(FORCE), "a": np.float32(ACC)}, do_compression=True)


@case("column-index-comment.mat")
def _(p):
    scipy.io.savemat(p, {"ans": 3.0, "comment": "driven at 20 Hz", "time": T, "u": FORCE, "force_unit": "N", "Force": FORCE, "Acc": ACC, "Acc_unit": "m/s^2"})


@case("frf-matrix-and-coherence.mat", ["--form", "accelerance"])
def _(p):
    scipy.io.savemat(p, {"Freq": FREQ[None, :], "FRF": ACCELERANCE[:, None], "Coh": np.full((len(FREQ), 1), 0.9999)})


@case("frf-struct-dofs.mat")
def _(p):
    scipy.io.savemat(p, {"frf": {"f": FREQ, "H": ACCELERANCE[:, None], "unit": "m/s^2/N", "respDOF": "1z", "refDOF": "1z"}})


@case("frf-abs-phase.mat", ["--form", "receptance"])
def _(p):
    scipy.io.savemat(p, {"f": FREQ, "H_abs": np.abs(RECEPTANCE), "H_phase": np.angle(RECEPTANCE)})


@case("strings-of-v73.mat")
def _(p):
    hdf5storage.savemat(str(p), {"t": T, "Force": FORCE, "Acc": ACC, "unit": {"Force": "N", "Acc": "m/s^2"}}, format="7.3", oned_as="column")


# HDF5.


@case("xarray.nc")
def _(p):
    with h5py.File(p, "w") as f:
        time = f.create_dataset("time", data=T)
        time.attrs["units"] = "s"
        time.make_scale("time")
        for name, y, unit in [("force", FORCE, "N"), ("acceleration", ACC, "m/s**2")]:
            d = f.create_dataset(name, data=y)
            d.attrs["units"] = unit
            d.attrs["_FillValue"] = np.nan
            d.dims[0].attach_scale(time)


@case("h5-sample-rate-and-array.h5")
def _(p):
    with h5py.File(p, "w") as f:
        d = f.create_dataset("measurement/data", data=np.column_stack([FORCE, ACC]), chunks=(100, 2), compression="gzip", shuffle=True)
        d.attrs["channels"] = ["Force [N]", "Acc [m/s^2]"]
        d.attrs["fs"] = FS


@case("h5-structured-attrs-bytes.h5")
def _(p):
    with h5py.File(p, "w") as f:
        g = f.create_group("Run_001")
        g.attrs["SampleRate"] = np.int32(FS)
        for name, y, unit in [("F", FORCE, b"N"), ("A", ACC, b"m/s^2")]:
            g.create_dataset(name, data=y.astype("f4")).attrs["Unit"] = np.bytes_(unit)


@case("h5-t0-dt.h5")
def _(p):
    with h5py.File(p, "w") as f:
        for name, y, unit in [("Force", FORCE, "N"), ("Disp", DISP * 1e6, "um")]:
            d = f.create_dataset(name, data=y)
            d.attrs.update({"unit": unit, "t0": "2024-03-01T12:00:00", "dt": 1 / FS})


@case("h5-frf-real-imag.h5")
def _(p):
    with h5py.File(p, "w") as f:
        f["frequencies"] = FREQ
        f["frf/real"] = RECEPTANCE.real
        f["frf/imag"] = RECEPTANCE.imag
        f["frf"].attrs["unit"] = "m/N"


# Text.


@case("one-header-with-units-line-2-and-dof.csv")
def _(p):
    text(p, ["Time,Exc:1:+Z,Resp:1:+Z", "s,N,g"] + table([T, FORCE, ACC / G], ","))


@case("abaqus-like-names.csv")
def _(p):
    text(p, ["t [s],F_1z [N],a_1z [m/s^2]"] + table([T, FORCE, ACC], ","))


@case("numpy-savetxt.txt")
def _(p):
    np.savetxt(p, np.column_stack([T, FORCE, ACC]), header="time[s] force[N] acc[m/s^2]")


@case("numpy-savetxt-delimiter.csv")
def _(p):
    np.savetxt(p, np.column_stack([T, FORCE, ACC]), header="t (s), F (N), x'' (m/s^2)", delimiter=", ", comments="# ")


@case("units-in-third-row.csv")
def _(p):
    text(p, ["Channel;1;2;3", "Name;Zeit;Kraft;Beschleunigung", "Einheit;s;N;m/s²"] + [";" + row for row in table([T, FORCE, ACC], ";", True)])


@case("daqexpress.csv")
def _(p):
    text(p, ["Time,cDAQ1Mod1/ai0 (N),cDAQ1Mod1/ai1 (m/s^2)"] + table([T, FORCE, ACC], ","))


@case("siemens-scadas.txt")
def _(p):
    text(p, ["Project:\tPlate", "Section:\tSection1", "Run:\tRun 1", "", "Time\tForce:1:+Z\tAcc:1:+Z", "s\tN\tm/s^2", "Real\tReal\tReal"] + table([T, FORCE, ACC], "\t"))


@case("famos.csv")
def _(p):
    text(p, ["imc FAMOS ASCII", "Name: Messung", "t[s];Kraft[N];Weg[µm]"] + table([T, FORCE, DISP * 1e6], ";", True), "cp1252", "\r\n")


@case("french-header.csv")
def _(p):
    text(p, ["Temps (s);Effort (N);Accélération (m/s²)"] + table([T, FORCE, ACC], ";", True), "cp1252", "\r\n")


@case("spanish.csv")
def _(p):
    text(p, ["Tiempo [s];Fuerza [N];Aceleración [m/s2]"] + table([T, FORCE, ACC], ";", True), "utf-8")


@case("hours-minutes.csv")
def _(p):
    stamp = [f"00:00:{int(t):02d},{round((t % 1) * 1e6):06d}" for t in T]
    text(p, ["Zeit;Kraft [N];Beschleunigung [m/s^2]"] + table([stamp, FORCE, ACC], ";", True))


@case("tab-and-blank-mix.asc")
def _(p):
    text(p, ["Time\tForce\tAccel", "[s]\t[N]\t[g]"] + [f" {a:>14.8e}\t {b:>14.8e}\t {c:>14.8e} " for a, b, c in zip(T, FORCE, ACC / G)])


@case("wide-runs.csv", (), "opens")
def _(p):
    text(p, ["time [s],force@1 [N],acc@1 [m/s^2],force@2 [N],acc@2 [m/s^2]"] + table([T, FORCE, ACC, 0 * FORCE, ACC], ","))


@case("frf-csv-with-coherence.csv")
def _(p):
    size, phase = np.abs(ACCELERANCE), np.degrees(np.angle(ACCELERANCE))
    text(p, ["Frequency (Hz),Magnitude ((m/s^2)/N),Phase (deg),Coherence"] + table([FREQ, size, phase, 0.999 + 0 * FREQ], ","))


@case("frf-unwrapped-phase.txt")
def _(p):
    size, phase = np.abs(ACCELERANCE), np.degrees(np.unwrap(np.angle(ACCELERANCE))) - 720
    text(p, ["Freq [Hz]\tMag [g/N]\tPhase [°]"] + table([FREQ, size / G, phase], "\t"))


@case("frf-matlab-complex.csv", ["--form", "mobility"])
def _(p):
    text(p, ["f,H11"] + [f"{f:g},{h.real:.9e}{h.imag:+.9e}i" for f, h in zip(FREQ, MOBILITY)])


@case("frf-python-complex.csv", ["--form", "receptance"])
def _(p):
    text(p, ["freq,H"] + [f"{f:g},({h.real:.9e}{h.imag:+.9e}j)" for f, h in zip(FREQ, RECEPTANCE)])


@case("frf-dynamic-stiffness.csv")
def _(p):
    z = 1 / RECEPTANCE
    text(p, ["Frequency [Hz],Re(Z11) [N/m],Im(Z11) [N/m]"] + table([FREQ, z.real, z.imag], ","))


@case("frf-apparent-mass.csv")
def _(p):
    z = 1 / ACCELERANCE
    text(p, ["Frequency [Hz],Apparent mass real [kg],Apparent mass imag [kg]"] + table([FREQ, z.real, z.imag], ","))


@case("frf-siemens-text.txt")
def _(p):
    text(p, ["Hz\t(m/s^2)/N\t(m/s^2)/N", "Linear\tReal\tImaginary", "Frequency\tFRF plate:1:+Z/shaker:1:+Z\tFRF plate:1:+Z/shaker:1:+Z"] + table([FREQ, ACCELERANCE.real, ACCELERANCE.imag], "\t"))


@case("json.json", (), LINE)
def _(p):
    p.write_text(json.dumps({"time": list(T[:5]), "force": list(FORCE[:5])}))


@case("pickle.pkl", (), LINE)
def _(p):
    p.write_bytes(pickle.dumps({"t": T, "F": FORCE}))


@case("parquet.parquet", (), LINE)
def _(p):
    p.write_bytes(b"PAR1" + bytes(range(200)) + b"PAR1")


@case("archive.zip", (), LINE)
def _(p):
    with zipfile.ZipFile(p, "w") as z:
        z.writestr("run.csv", "time,force\n0,1\n")


@case("page.html", (), LINE)
def _(p):
    p.write_text("<!DOCTYPE html><html><body>Not a file: 404</body></html>")


# Spreadsheets.


@case("units-row-and-merged-title.xlsx")
def _(p):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.merge_cells("A1:C1")
    sheet["A1"] = "Rig test 12, operator MM"
    sheet.append(["Time", "Force", "Acceleration"])
    sheet.append(["(s)", "(N)", "(g)"])
    for row in zip(T, FORCE, ACC / G):
        sheet.append([float(v) for v in row])
    book.save(p)


@case("formulas-and-charts.xlsx")
def _(p):
    book = openpyxl.Workbook()
    notes = book.active
    notes.title = "Notes"
    notes.append(["All runs at 20 Hz", None, 3])
    sheet = book.create_sheet("Data")
    sheet.append([None, "t [s]", "F [N]", "v [mm/s]"])
    for i, row in enumerate(zip(T, FORCE, VEL * 1e3)):
        sheet.append([i + 1] + [float(v) for v in row])
    book.save(p)


# TDMS, WAV, NumPy.


@case("labview-group-rate.tdms")
def _(p):
    with TdmsWriter(str(p)) as w:
        w.write_segment([RootObject({"Title": "run"}), GroupObject("Untitled", {"SamplingFrequency": FS}),
                         ChannelObject("Untitled", "Force", FORCE, {"unit_string": "Newtons"}), ChannelObject("Untitled", "Acceleration", ACC / G, {"unit_string": "g"})])


@case("int16-tdms-slope.tdms")
def _(p):
    lsb = 1e-3
    props = {"NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": 1, "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": lsb,
             "NI_Scale[0]_Linear_Y_Intercept": 0.0, "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF, "wf_increment": 1 / FS}
    with TdmsWriter(str(p)) as w:
        w.write_segment([ChannelObject("log", "Force", np.round(FORCE / lsb).astype("i2"), dict(props, unit_string="N")), ChannelObject("log", "Vel", np.round(VEL * 1e3 / lsb).astype("i4"), dict(props, unit_string="mm/s"))])


@case("structured-named.npz")
def _(p):
    np.savez(p, fs=FS, force=FORCE, acc=ACC, units=np.array(["N", "m/s^2"]))


@case("t-and-y.npz", (), "opens")
def _(p):
    np.savez(p, t=T, y=np.column_stack([FORCE, ACC]), labels=np.array(["force@1 [N]", "acc@1 [m/s^2]"]))


# Universal Files.


@case("response-in-text-lines.uff")
def _(p):
    text(p, set58(1, FORCE, T, response=(1, 3), reference=(0, 0), ids=["Force Shaker 1", "NONE", "24-Nov-26 10:00:00", "Run 1", "NONE"], ordinate=(13, "N"), denominator=(0, ""), abscissa=(17, "s"))
         + set58(1, ACC / G, T, response=(1, 3), reference=(0, 0), ids=["Acc 1", "NONE", "24-Nov-26 10:00:00", "Run 1", "NONE"], ordinate=(12, "g"), denominator=(0, ""), abscissa=(17, "s")))


@case("names-only-no-dof.uff")
def _(p):
    text(p, set58(1, FORCE, T, response=(0, 0), reference=(0, 0), ids=["Force", "NONE", "NONE", "NONE", "NONE"], ordinate=(13, "N"), denominator=(0, ""), abscissa=(17, "s"))
         + set58(1, ACC, T, response=(0, 0), reference=(0, 0), ids=["Acceleration", "NONE", "NONE", "NONE", "NONE"], ordinate=(12, "m/s^2"), denominator=(0, ""), abscissa=(17, "s")), "latin-1", "\r\n")


if __name__ == "__main__":
    try_import.main()
