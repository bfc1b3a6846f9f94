# SPDX-License-Identifier: Apache-2.0
"""S2 fig. 5: a power grasp of the teapot at 1.4 N/mm, with the force of every touching phalanx.

S2 is Feng, Li, Zheng, ICVRV 2011. The device and the patient are simulated (docs/stability.md).
"""
import numpy as np
import phalanx

from figure import BLUE, GREEN, GREY, ORANGE, PURPLE, arguments, mark_trial, plt, save

COLOURS = (GREY, BLUE, ORANGE, GREEN, PURPLE)  # of the digits, from the thumb on


def compute(seed=1):
    """Returns the closed loop and one trial."""
    loop = phalanx.ClosedLoop(phalanx.Scene("stability_grasp"))
    return loop, loop.run(seed, columns=["time_s", "force_n", "contact"])


def name_of(segment):
    """Returns "index, distal" for a segment's number."""
    part = phalanx.SEGMENTS[segment].removeprefix("thumb-").split("-")[-1]
    return f"{phalanx.DIGITS[segment // 3]}, {part}"


def draw(loop, trial):
    """Draws the forces in one panel, each with its name at its end in the window."""
    run = trial.run
    figure, axes = plt.subplots(figsize=(10, 5), layout="constrained")
    touching = np.flatnonzero(run.force_n.max(axis=0) > 0)
    end = int(np.searchsorted(run.time_s, loop.window_s[1])) - 1
    for segment in touching:
        axes.plot(run.time_s, run.force_n[:, segment], color=COLOURS[segment // 3], lw=1.4,
                  ls="-" if segment % 3 == 2 else "--", label=name_of(segment))
    axes.legend(title="phalanx", loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    mark_trial(axes, loop)
    axes.set_xlim(0, loop.duration_s)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("force on the phalanx [N]")
    total = run.force_n[end].sum()
    axes.set_title("S2 fig. 5: a power grasp of a teapot at 1.4 N/mm, at most 0.1 N a step; "
                   f"{'stable' if trial.stable else 'oscillates'}, {total:.1f} N in all")
    return figure


if __name__ == "__main__":
    options = arguments(__doc__, seed=(1, "seed of the trial"))
    save(draw(*compute(options.seed)), options.out)
