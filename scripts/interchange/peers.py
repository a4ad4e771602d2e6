"""scipy, h5py, npTDMS, numpy and wave write, we read, and scipy reads what we write: every number to the last bit.

    pip install numpy scipy h5py hdf5storage npTDMS
    cargo build --release --no-default-features -p dashpot -p dashpot-datafiles --bin dashpot --example bits
    python scripts/interchange/peers.py target/release

Random numbers of every type that the formats have, in every layout that their libraries write. Universal Files have
crates/uff/tests/pyuff/interchange.py, NASTRAN has scripts/finite-elements/pynastran_check.py. A development tool: no test needs it.
"""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import wave

import h5py
import hdf5storage
import numpy as np
import scipy.io
from nptdms import ChannelObject, TdmsWriter

RANDOM = np.random.default_rng(15)
INTEGERS = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"]
N = 57


def values(kind, extents=(N,)):
    if kind[-2] in "iu":
        info = np.iinfo(kind)
        return RANDOM.integers(info.min, info.max, extents, dtype=np.dtype(kind).newbyteorder("="), endpoint=True).astype(kind)
    numbers = RANDOM.standard_normal(extents) * 10.0 ** RANDOM.integers(-4, 4, extents)
    return (numbers + 1j * RANDOM.standard_normal(extents) if "c" in kind else numbers).astype(kind)


def doubles(array):
    array = np.asarray(array)
    return array.astype("c16").view("f8") if np.iscomplexobj(array) else array.astype("f8")


def scipys(folder):
    for name, arguments in (("v4", dict(format="4")), ("v5", {}), ("v7", dict(do_compression=True))):
        # Version 4 has no signed bytes and no unsigned words of four.
        kinds = ["f8", "f4", "i4", "i2", "u2", "u1", "c16"] if name == "v4" else ["f8", "f4", "c16", "c8", *INTEGERS]
        held = {f"x_{kind}": values(kind) for kind in kinds}
        scipy.io.savemat(folder / f"{name}.mat", {k: v.reshape(-1, 1) for k, v in held.items()}, **arguments)
        yield f"{name}.mat", held
        if name != "v4":
            nested = {f"y_{kind}": values(kind) for kind in kinds}
            scipy.io.savemat(folder / f"{name}-struct.mat", {"run": {k: v.reshape(-1, 1) for k, v in nested.items()}}, **arguments)
            yield f"{name}-struct.mat", nested
    table = values("f8", (N, 3))
    scipy.io.savemat(folder / "columns.mat", {"table": table})
    yield "columns.mat", {f"table[{c + 1}]": table[:, c] for c in range(3)}
    held = {f"x_{kind}": values(kind) for kind in ["f8", "f4", "c16", *INTEGERS]}
    hdf5storage.savemat(str(folder / "v73.mat"), {k: v.reshape(-1, 1) for k, v in held.items()}, format="7.3", store_python_metadata=False)
    yield "v73.mat", held


def h5pys(folder):
    kinds = ["<f8", ">f8", "<f4", ">f4", "<f2", "<c16", "<c8", *("<" + i for i in INTEGERS), *(">" + i for i in INTEGERS[2:])]
    layouts = {"contiguous": {}, "chunks": dict(chunks=(10,)), "gzip": dict(chunks=(16,), compression="gzip", shuffle=True),
               "lzf": dict(chunks=(25,), compression="lzf"), "check": dict(chunks=(N,), fletcher32=True)}
    for layout, arguments in layouts.items():
        for version in ("earliest", "latest"):
            name, held = f"{layout}-{version}.h5", {}
            with h5py.File(folder / name, "w", libver=version) as file:
                for kind in kinds:
                    order = "big" if kind[0] == ">" else "little"
                    held[f"x {order} {kind[1:]}"] = data = values(kind)
                    file.create_dataset(f"group/x {order} {kind[1:]}", data=data, **arguments)
                table = values("<f8", (N, 4))
                file.create_dataset("group/table", data=table, **({"chunks": (9, 3)} if layout != "contiguous" else {}))
                held |= {f"table[{c + 1}]": table[:, c] for c in range(4)}
            yield name, held


def tdms(folder):
    for name, segments in (("one.tdms", 1), ("several.tdms", 3)):
        held = {f"x {kind}": values(kind, (segments, N)) for kind in ["f8", "f4", "c16", "c8", *INTEGERS]}
        with TdmsWriter(str(folder / name)) as writer:
            for s in range(segments):
                writer.write_segment([ChannelObject("log", k, v[s]) for k, v in held.items()])
        yield name, {k: v.ravel() for k, v in held.items()}


def others(folder):
    kinds = ["<f8", ">f8", "<f4", "<f2", "<c16", ">c8", *("<" + i for i in INTEGERS)]
    for kind in kinds:
        data = values(kind)
        name = f"x_{'big' if kind[0] == '>' else 'little'}_{kind[1:]}"
        np.save(folder / f"{name}.npy", data)
        yield f"{name}.npy", {name: data}
    held = {f"x_{kind[1:]}": values(kind) for kind in kinds if kind[0] == "<"}
    np.savez(folder / "plain.npz", **held)
    yield "plain.npz", held
    np.savez_compressed(folder / "packed.npz", **held)
    yield "packed.npz", held
    for bits, kind in ((16, "<i2"), (32, "<i4")):
        data = values(kind, (N, 2))
        with wave.open(str(folder / f"pcm{bits}.wav"), "wb") as file:
            file.setnchannels(2)
            file.setsampwidth(bits // 8)
            file.setframerate(51200)
            file.writeframes(data.tobytes())
        yield f"pcm{bits}.wav", {f"channel {c + 1}": data[:, c] / 2.0 ** (bits - 1) for c in range(2)}


def read(program, path):
    """Channels by their names, as the program reads them."""
    ran = subprocess.run([program, path], capture_output=True, text=True, check=True)
    found, name = {}, None
    for line in ran.stdout.splitlines():
        word, _, rest = line.partition(" ")
        if word == "channel":
            name = rest.split("\t")[1]
        elif word == "values":
            found[name] = np.array([struct.unpack(">d", bytes.fromhex(bits))[0] for bits in rest.split()])
        elif word == "error":
            raise SystemExit(f"{path.name}: {rest}")
    return found


def they_write(program, folder):
    count = 0
    for write in (scipys, h5pys, tdms, others):
        for name, held in write(folder):
            found = read(program, folder / name)
            for channel, data in held.items():
                ours = found.get(channel)
                assert ours is not None, f"{name}: no channel {channel} among {list(found)}"
                assert np.array_equal(ours, doubles(data), equal_nan=True), f"{name}, {channel}: {ours[:3]} is not {doubles(data)[:3]}"
                count += 1
            print(f"{name:24} agrees, {len(held)} channels")
    return count


def we_write(program, folder):
    sample = pathlib.Path(__file__).parents[2] / "sample-data" / "five-masses" / "project.toml"
    for form in ("mat", "json"):
        subprocess.run([program, "export", sample, "--to", form, "--out", folder / f"ours.{form}"], check=True, capture_output=True)
    stated = json.loads((folder / "ours.json").read_text())
    held = scipy.io.loadmat(folder / "ours.mat", simplify_cells=True)
    each = lambda table, key: [row[key] for row in stated[table]]
    same = {
        "C": stated["matrix"]["viscous"], "C_equivalent": stated["matrix"]["equivalent"], "energy_percent": each("energy_percent", "percent"),
        "frequency_hz": each("modes", "frequency_hz"), "damping_ratio": each("modes", "damping_ratio"),
    }
    for name, numbers in same.items():
        assert np.array_equal(held[name], np.array(numbers)), f"{name} is {held[name]}, not {numbers}"
    for ours, theirs in zip(held["sources"], stated["sources"], strict=True):
        assert [ours["law"], ours["values"]] == [theirs["law"], *theirs["parameters"].values()], f"{ours} is not {theirs}"
    print("ours.mat                 agrees with ours.json in scipy")


def main():
    target = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        count = they_write(target / "examples" / "bits", folder)
        we_write(target / "dashpot", folder)
    print(f"all {count} channels agree to the last bit")


main()
