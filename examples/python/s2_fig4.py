# SPDX-License-Identifier: Apache-2.0
"""S2 fig. 4: the index finger presses the teapot at 0.9 N/mm, without and with smoothing of the force.

S2 is Feng, Li, Zheng, ICVRV 2011. The device and the patient are simulated (docs/stability.md).
"""
import phalanx

from figure import BLUE, ORANGE, arguments, into_object, mark_trial, plt, save

COLUMNS = ["time_s", "force_n", "contact", "point_m", "normal", "hcp_position_m", "hcp_rotation",
           "gdp_position_m", "gdp_rotation"]


def compute(seed=1):
    """Returns the closed loop, and a trial for each of the two cases by its title."""
    loops = {
        "without smoothing": phalanx.ClosedLoop(
            phalanx.Scene("stability_press", set={"stabiliser.method": "none"})),
        "at most 0.05 N a step": phalanx.ClosedLoop(phalanx.Scene("stability_press")),
    }
    loop = loops["without smoothing"]
    return loop, {title: each.run(seed, columns=COLUMNS) for title, each in loops.items()}


def draw(loop, trials):
    """Draws the forces above the ways of the finger, a column for each case."""
    figure, axes = plt.subplots(2, 2, figsize=(10, 6), sharex=True, sharey="row", layout="constrained")
    for column, ((title, trial), colour) in enumerate(zip(trials.items(), (ORANGE, BLUE))):
        pressed = int(trial.run.force_n.max(axis=0).argmax())
        verdict = "stable" if trial.stable else "oscillates"
        axes[0, column].plot(trial.run.time_s, trial.run.force_n[:, pressed], color=colour, lw=1.2)
        axes[0, column].set_title(f"{title}: {verdict}\n{trial.force_swing_n:.2f} N peak to peak in the window")
        axes[1, column].plot(trial.run.time_s, 1e3 * into_object(trial.run, pressed), color=colour, lw=1.2)
        axes[1, column].set_xlabel("time [s]")
        for row in (0, 1):
            mark_trial(axes[row, column], loop)
    axes[0, 0].set_ylabel("force on the finger [N]")
    axes[1, 0].set_ylabel("way into the object [mm]")
    axes[0, 0].set_ylim(0, 1.15 * axes[0, 0].get_ylim()[1])
    axes[1, 0].set_ylim(top=1.3 * axes[1, 0].get_ylim()[1])
    axes[0, 0].set_xlim(0, loop.duration_s)
    figure.suptitle("S2 fig. 4: the index finger presses a teapot at 0.9 N/mm, simulated exoskeleton, 200 Hz")
    return figure


if __name__ == "__main__":
    options = arguments(__doc__, seed=(1, "seed of the trial"))
    save(draw(*compute(options.seed)), options.out)
