# SPDX-License-Identifier: Apache-2.0
"""What the figures of this folder share: the command line, the style, and curves from a Run."""
import argparse
import pathlib

import matplotlib
import numpy as np

matplotlib.use("Agg")  # files only, no window
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito's colours, which people with a colour vision deficiency can tell apart.
BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"

plt.rcParams.update({
    "font.size": 10, "axes.titlesize": 11, "axes.titlelocation": "left", "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#e5e5e5", "axes.axisbelow": True,
    "figure.dpi": 100, "savefig.dpi": 150, "svg.hashsalt": "phalanx", "svg.fonttype": "none",
})


def arguments(description, **numbers):
    """Reads --out, and an integer option for each keyword: name = (default, help)."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file to write: .png or .svg")
    for name, (default, text) in numbers.items():
        parser.add_argument(f"--{name}", type=int, default=default, help=f"{text} [{default}]")
    return parser.parse_args()


def save(figure, out):
    """Writes a figure and says where."""
    metadata = {"Date": None} if out.suffix == ".svg" else None  # the same figure gives the same bytes
    figure.savefig(out, metadata=metadata)
    plt.close(figure)
    print(f"wrote {out}")


def mark_trial(axes, loop):
    """Shades the bump and the window in which stability is judged."""
    for (begin, end), text, colour in ((loop.bump_s, "bump", "#fbe3d0"), (loop.window_s, "window", "#e3edf5")):
        axes.axvspan(begin, end, color=colour, lw=0, zorder=0)
        axes.annotate(text, ((begin + end) / 2, 1), xycoords=("data", "axes fraction"), xytext=(0, -3),
                      textcoords="offset points", ha="center", va="top", fontsize=8, color=GREY)


def into_object(run, segment):
    """Returns how far the measured finger has gone into the object since its first contact [m].

    It is the way of the contact's material point along the normal; NaN before the contact.
    Needs the columns contact, point_m, normal, hcp_position_m, hcp_rotation, gdp_position_m, gdp_rotation.
    """
    way = np.full(len(run), np.nan)
    touched = np.flatnonzero(run.contact[:, segment])
    if touched.size == 0:
        return way
    first = touched[0]
    point, normal = run.point_m[first, segment], run.normal[first, segment]
    in_segment = run.gdp_rotation[first, segment].T @ (point - run.gdp_position_m[first, segment])
    measured = run.hcp_rotation[first:, segment] @ in_segment + run.hcp_position_m[first:, segment]
    way[first:] = -(measured - point) @ normal
    return way
