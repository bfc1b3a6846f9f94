# SPDX-License-Identifier: Apache-2.0
"""S2's result: the largest stable stiffness with and without smoothing of the force, as a map.

S2 prints 0.7 N/mm without smoothing and 1.6 N/mm with it; the bounds of that smoothing are not printed. Device
and patient were fitted on these two numbers (docs/stability.md). With 3 seeds the map took
31 s on two cores.
"""
import numpy as np
import phalanx
from matplotlib.patheffects import withStroke

from figure import ORANGE, arguments, plt, save

BOUNDS_N = (None, 0.4, 0.2, 0.1, 0.05, 0.025)  # of the force's change a step; None: no smoothing
STIFFNESS_N_PER_MM = np.arange(1, 25) / 10


def compute(seeds=10, bounds=BOUNDS_N, stiffness=STIFFNESS_N_PER_MM):
    """Returns the share of stable trials, (stiffness, bounds)."""
    shares = np.zeros((len(stiffness), len(bounds)))
    for column, bound in enumerate(bounds):
        keys = {"stabiliser.method": "none"}
        if bound is not None:
            keys = {"smoothing.min_n": -bound, "smoothing.max_n": bound}
        loop = phalanx.ClosedLoop(phalanx.Scene("stability_press", set=keys))
        for row, k in enumerate(stiffness):
            trials = loop.run_seeds(range(1, seeds + 1), stiffness_n_per_m=1000 * k)
            shares[row, column] = np.mean([trial.stable and trial.valid for trial in trials])
    return shares


def limits(shares, stiffness=STIFFNESS_N_PER_MM):
    """Returns the largest stiffness of each bound below which every trial is stable [N/mm]; 0: none."""
    stable = np.logical_and.accumulate(shares == 1.0, axis=0).sum(axis=0)
    return np.array([stiffness[count - 1] if count else 0.0 for count in stable])


def draw(shares, bounds=BOUNDS_N, stiffness=STIFFNESS_N_PER_MM):
    """Draws the map, its boundary and the two numbers that S2 prints."""
    figure, axes = plt.subplots(figsize=(8, 6), layout="constrained")
    half = (stiffness[1] - stiffness[0]) / 2
    columns = np.arange(len(bounds) + 1) - 0.5
    picture = axes.pcolormesh(columns, np.append(stiffness - half, stiffness[-1] + half), shares, vmin=0, vmax=1,
                              cmap="cividis")
    axes.grid(False)
    boundary = limits(shares, stiffness) + half
    axes.stairs(boundary, columns, baseline=None, color=ORANGE, lw=2.5, label="limit: all trials below are stable; at the top: not reached")
    for printed, text, style in ((0.7, "S2 without smoothing: 0.7 N/mm", ":"), (1.6, "S2 with smoothing: 1.6 N/mm", "--")):
        axes.axhline(printed, color="black", ls=style, lw=1.5, path_effects=[withStroke(linewidth=3, foreground="white")])
        axes.annotate(text, (columns[0], printed), xytext=(6, 5), textcoords="offset points", fontsize=9,
                      bbox={"fc": "white", "ec": "none", "pad": 2})
    axes.set_xticks(range(len(bounds)), ["none" if bound is None else f"±{bound:g}" for bound in bounds])
    axes.set_xlabel("smoothing: bound of the force's change [N a step]")
    axes.set_ylabel("stiffness of the wall [N/mm]")
    axes.set_ylim(stiffness[0] - half, stiffness[-1] + half)
    axes.legend(loc="upper left", framealpha=1)
    figure.colorbar(picture, ax=axes, label="share of stable trials")
    axes.set_title("S2: which walls are stable? Index finger on a teapot, 200 Hz")
    return figure


if __name__ == "__main__":
    options = arguments(__doc__, seeds=(10, "trials of each cell"))
    save(draw(compute(options.seeds)), options.out)
