"""Writes crates/datafiles/tests/large: the start of a large HDF5 file, and a chunked one.

    pip install numpy h5py
    python scripts/interchange/make_heads.py crates/datafiles/tests/large

The test lengthens the first by a hole to the size that its headers state, so that no large file is kept: data/acc 1 to data/acc 4
of VECTOR numbers and data/rows of ROWS x 16, contiguous, one behind the other from the end of the head on.
"""

import pathlib
import sys

import h5py
import numpy as np

VECTOR, ROWS, CHUNKED = 1 << 22, 1 << 20, 600_000


def head(path):
    properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    properties.set_layout(h5py.h5d.CONTIGUOUS)
    properties.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    properties.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    offsets = []
    with h5py.File(path, "w", meta_block_size=16384) as file:
        group = file.create_group("data")
        for name, extents in [(f"acc {c + 1}", (VECTOR,)) for c in range(4)] + [("rows", (ROWS, 16))]:
            space = h5py.h5s.create_simple(extents)
            dataset = h5py.h5d.create(group.id, name.encode(), h5py.h5t.IEEE_F64LE, space, properties)
            offsets.append(dataset.get_offset())
            h5py.Dataset(dataset).attrs["sampling_rate"] = 51200.0
    assert [offset - offsets[0] for offset in offsets] == [8 * VECTOR * c for c in range(5)], offsets
    path.write_bytes(path.read_bytes()[: offsets[0]])


def chunked(path):
    with h5py.File(path, "w") as file:
        rows = np.column_stack([np.arange(CHUNKED) // 1000, np.arange(CHUNKED) // 700])
        file.create_dataset("rows", data=rows.astype("i2"), chunks=(65_536, 2), compression="gzip", shuffle=True)


if __name__ == "__main__":
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    head(out / "head.h5")
    chunked(out / "chunked.h5")
