#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `phalanx session export` wrote, with programs of others, and compares it with the CSV tables.

read_exports.py CSV_FOLDER HDF5_FILE MATLAB_FILE BIDS_FOLDER: prints what it compared; says what differs, and exits 1.
"""

import csv
import json
import pathlib
import re
import sys

import h5py
import numpy as np
import scipy.io

UNITS = {"s": "s", "us": "us", "rad": "rad", "Nm": "nm", "N": "n", "m": "m", "N/m": "n_per_m", "counts": "counts"}
KEYS = {"dataset_description.json", "README", "participants.tsv"}


def require(so, what):
    if not so:
        sys.exit(f"{what}")


def csv_table(file):
    with open(file, newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    return rows[0], rows[1:]


def numbers(rows, column):
    return np.array([float(row[column]) if row[column] else np.nan for row in rows])


def names_of(name, unit, labels):
    stem = name + (f"_{UNITS[unit]}" if unit else "")
    return [f"{stem}_{label}" for label in labels] if labels is not None else [stem]


def compare(table, head, rows, name, unit, labels, values):
    """Compares a column, or a block of columns, to the last bit."""
    for i, full in enumerate(names_of(name, unit, labels)):
        require(full in head, f"{table}: the CSV file has no column {full}")
        at = head.index(full)
        if values.dtype == object:
            require([row[at] for row in rows] == list(values), f"{table}: the texts of {full} differ")
            continue
        mine = values[:, i] if labels is not None else values
        require(np.array_equal(numbers(rows, at), mine, equal_nan=True), f"{table}: the numbers of {full} differ")
    return len(names_of(name, unit, labels))


def read_hdf5(folder, file):
    compared = 0
    with h5py.File(file) as hdf5:
        require(hdf5.attrs["recording"].endswith(".mcap"), "HDF5: the recording is not named")
        for table in hdf5:
            head, rows = csv_table(folder / f"{table}.csv")
            columns = 0
            for name, data in hdf5[table].items():
                values = data.asstr()[:] if data.dtype == object else data[:]
                labels = data.attrs.get("columns")
                columns += compare(table, head, rows, name, data.attrs.get("unit"), labels, values)
            require(columns == len(head), f"HDF5: {table} has {columns} columns, the CSV file {len(head)}")
            compared += columns
        require({f"{table}.csv" for table in hdf5} == {path.name for path in folder.iterdir()}, "HDF5: other tables")
    return compared


def read_matlab(folder, file):
    compared = 0
    mat = scipy.io.loadmat(file, squeeze_me=False, struct_as_record=True)
    require(file.read_bytes()[124:126] == b"\x00\x01", "MATLAB: no file of version 7 (level 5, compressed)")
    tables = [name for name in mat if not name.startswith("__") and name != "recording"]
    require({f"{table}.csv" for table in tables} == {path.name for path in folder.iterdir()}, "MATLAB: other tables")
    for table in tables:
        head, rows = csv_table(folder / f"{table}.csv")
        struct = mat[table][0, 0]
        units, labels_of = struct["units"], struct["columns"]
        columns = 0
        for name in struct.dtype.names:
            if name in ("units", "columns"):
                continue
            unit = str(units[0, 0][name][0]) if name in (units.dtype.names or ()) else None
            labelled = name in (labels_of.dtype.names or ())
            labels = [str(cell[0][0]) for cell in labels_of[0, 0][name]] if labelled else None
            values = struct[name]
            if values.dtype == object:
                # Characters of two UTF-16 units are replaced, since readers disagree on them.
                rows = [[re.sub("[\U00010000-\U0010FFFF]", "\uFFFD", text) for text in row] for row in rows]
                values = np.array([str(cell[0][0]) if cell[0].size else "" for cell in values], dtype=object)
            elif labels is None:
                values = values[:, 0]
            columns += compare(table, head, rows, name, unit, labels, values)
        require(columns == len(head), f"MATLAB: {table} has {columns} columns, the CSV file {len(head)}")
        compared += columns
    return compared


def read_bids(folder, bids):
    """The rules of the specification that concern one recording of motion."""
    require(KEYS <= {path.name for path in bids.iterdir()}, "BIDS: a file at the top is missing")
    require(json.loads((bids / "dataset_description.json").read_text())["BIDSVersion"] == "1.9.0", "BIDS: version")
    for system, table, column in (("exoskeleton", "angles", "angle_rad"), ("shown", "hand", "angle_shown_rad")):
        (motion,) = bids.glob(f"sub-*/motion/*_tracksys-{system}_motion.tsv")
        values = np.loadtxt(motion, delimiter="\t", ndmin=2)
        with open(str(motion).replace("_motion.tsv", "_channels.tsv"), newline="") as lines:
            channels = list(csv.DictReader(lines, delimiter="\t"))
        require(list(channels[0])[:5] == ["name", "component", "type", "tracked_point", "units"], f"{motion}: channels")
        about = json.loads(motion.with_suffix(".json").read_text())
        require(values.shape[1] == len(channels) == about["MotionChannelCount"], f"{motion}: number of channels")
        require(np.all(np.diff(values[:, 0]) > 0), f"{motion}: the latency does not rise")
        head, rows = csv_table(folder / f"{table}.csv")
        require(len(rows) == len(values), f"{motion}: number of rows")
        for i, channel in enumerate(channels):
            if channel["type"] == "JNTANG":
                degrees = np.degrees(numbers(rows, head.index(f"{column}_{channel['name']}")))
                require(channel["units"] == "deg", f"{motion}: unit of {channel['name']}")
                require(np.max(np.abs(degrees - values[:, i])) < 1e-6, f"{motion}: {channel['name']} differs")
            if channel["type"] == "MISC":
                force = numbers(rows, head.index(f"force_n_{channel['tracked_point']}"))
                require(np.max(np.abs(force - values[:, i])) < 1e-6, f"{motion}: {channel['name']} differs")
        rate = (len(values) - 1) / (values[-1, 0] - values[0, 0])
        require(abs(about["SamplingFrequencyEffective"] / rate - 1) < 1e-4, f"{motion}: {rate} samples a second")
        scans = (bids / "sub-01" / "sub-01_scans.tsv").read_text()
        require(f"motion/{motion.name}\t" in scans, "BIDS: scans.tsv does not name the recording")
    (events,) = bids.glob("sub-*/motion/*_events.tsv")
    require(events.read_text().startswith("onset\tduration\t"), f"{events}: columns")


if __name__ == "__main__":
    csv_folder, hdf5_file, matlab_file, bids_folder = (pathlib.Path(name) for name in sys.argv[1:])
    print(f"compared {read_hdf5(csv_folder, hdf5_file)} columns of HDF5, {read_matlab(csv_folder, matlab_file)} of MATLAB")
    read_bids(csv_folder, bids_folder)
    print("BIDS is right")
