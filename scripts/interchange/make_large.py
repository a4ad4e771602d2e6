"""Files of 2 GB, to see that their trees open at once and that single channels are read alone.

    pip install numpy h5py npTDMS
    python scripts/interchange/make_large.py /tmp/large
    time target/release/dashpot contents /tmp/large/large.tdms
    time target/release/dashpot contents /tmp/large/large.h5

A development tool: no test needs it. Delete the files afterwards.
"""

import pathlib
import sys

import h5py
import numpy as np
from nptdms import ChannelObject, RootObject, TdmsWriter

CHANNELS, SEGMENTS, EACH, FS = 16, 64, 262_144, 51_200.0


def wave(channel, segment):
    t = (np.arange(EACH) + segment * EACH) / FS
    return np.sin(2 * np.pi * (20 + channel) * t)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with TdmsWriter(str(folder / "large.tdms")) as writer:
        for segment in range(SEGMENTS):
            properties = {"wf_increment": 1 / FS, "unit_string": "m/s^2"}
            writer.write_segment([RootObject({})] + [ChannelObject("Log", f"Acc {c + 1}", wave(c, segment), properties) for c in range(CHANNELS)])
    with h5py.File(folder / "large.h5", "w") as f:
        for c in range(CHANNELS):
            data = f.create_dataset(f"daq/acc {c + 1}", (SEGMENTS * EACH,), "f8", chunks=(EACH,) if c % 2 else None)
            data.attrs["unit"], data.attrs["sampling_rate"] = "m/s^2", FS
            for segment in range(SEGMENTS):
                data[segment * EACH:(segment + 1) * EACH] = wave(c, segment)


if __name__ == "__main__":
    main()
