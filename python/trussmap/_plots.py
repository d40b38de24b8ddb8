# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""plot() of results, with matplotlib where it is installed; it is imported when first drawn."""
from __future__ import annotations

from . import _core


def _axes(axes):
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError(
            "plot() draws with matplotlib, which is not installed (Debian: python3-matplotlib)"
        ) from None
    return pyplot.subplots()[1] if axes is None else axes


def _bars(axes, names, values, label):
    places = range(len(names))
    axes.barh(places, values)
    axes.set_yticks(places, names)
    axes.invert_yaxis()
    axes.set_xlabel(label)
    return axes


def plot_map(self, axes=None):
    """The landmarks, joined by their routes; of recordings without landmarks the path."""
    axes = _axes(axes)
    for path in self.paths:
        axes.plot(path.dead_reckoned[:, 0], path.dead_reckoned[:, 1], color="0.7")
        axes.plot(path.adjusted[:, 0], path.adjusted[:, 1], color="k")
    places = dict(zip(self.landmarks, self.positions))
    for route in self.routes:
        ends = [places[route["source"]], places[route["target"]]]
        axes.plot([end[0] for end in ends], [end[1] for end in ends], color="0.6", linewidth=0.8)
    if places:
        axes.plot(self.positions[:, 0], self.positions[:, 1], "ko", markersize=4)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return axes


def plot_poses(self, axes=None):
    """The path."""
    axes = _axes(axes)
    axes.plot(self.x, self.y, color="k", linewidth=0.8)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return axes


def plot_response(self, axes=None):
    """The error in each bin with its 95 % interval, and the effect's curve through them."""
    axes = _axes(axes)
    across, up = self.variable_factor, self.error_factor
    axes.axhline(0.0, color="0.8", linewidth=0.8)
    near = [0.0, *(up * self.estimate)]
    if len(self.curve):
        axes.plot(across * self.curve[:, 0], up * self.curve[:, 1], color="0.5", label="the effect")
        near.extend(up * self.curve[:, 1])
    half = 1.96 * up * self.sd
    axes.errorbar(across * self.at, up * self.estimate, yerr=half, fmt="ko", markersize=4,
                  label="seen, 95 %")
    reach = max(near) - min(near) or 1.0  # what is hardly seen must not hide the rest
    axes.set_ylim(max(min(up * self.estimate - half), min(near) - reach) - 0.05 * reach,
                  min(max(up * self.estimate + half), max(near) + reach) + 0.05 * reach)
    axes.set_xlabel(self.variable_label)
    axes.set_ylabel(self.error_label)
    axes.set_title(self.name)
    axes.legend(frameon=False)
    return axes


def plot_comparison(self, axes=None):
    """How noisy each source is, against what the model states."""
    axes = _axes(axes)
    _bars(axes, [one.source for one in self.noise], [one.factor for one in self.noise],
          "standard deviation, true over stated")
    axes.axvline(1.0, color="0.5", linestyle=":")
    return axes


def plot_diagnosis(self, axes=None, count=8):
    """The best candidates, by the chi2 that each would take away."""
    axes = _axes(axes)
    best = self.candidates[:count]
    return _bars(axes, [one.effect.name for one in best], [one.score for one in best],
                 "chi2 that it would take away")


def plot_discovery(self, axes=None):
    """The error of held-out legs, from model to model."""
    axes = _axes(axes)
    names = ["as given"] + ["+ " + step.added.name for step in self.steps[1:]]
    return _bars(axes, names, [1e3 * step.heldout.arrival_rms_m for step in self.steps],
                 "held-out legs end off by [mm, rms]")


def plot_fit(self, axes=None):
    """The error of held-out legs without the effects and with them."""
    axes = _axes(axes)
    errors = [self.without_effects["heldout"].arrival_rms_m, self.heldout.arrival_rms_m]
    return _bars(axes, ["without effects", "with them"], [1e3 * one for one in errors],
                 "held-out legs end off by [mm, rms]")


def plot_fleet(self, axes=None, finding=0):
    """Of one finding every robot's own estimate; those that differ in black."""
    axes = _axes(axes)
    if not self.findings:
        axes.text(0.5, 0.5, "nothing found", ha="center", transform=axes.transAxes)
        return axes
    one = self.findings[finding]
    for place, robot in enumerate(one.coefficients[0].each):
        axes.errorbar(place, robot.value, yerr=robot.sd, fmt="o", markersize=3,
                      color="k" if robot.differs or robot.drifts else "0.6")
        if robot.differs or robot.drifts:
            axes.annotate(robot.robot, (place, robot.value), textcoords="offset points",
                          xytext=(4, 4))
    axes.axhline(0.0, color="0.5", linestyle=":")
    axes.set_xlabel("robot")
    axes.set_ylabel(one.effect)
    return axes


def plot_pose_graph(self, axes=None):
    """The vertices where they were adjusted to."""
    axes = _axes(axes)
    axes.plot(self.estimates[:, 0], self.estimates[:, 1], "k.", markersize=2)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return axes


def plot_table(self, axes=None):
    """The constants with their standard errors, each against its own size."""
    axes = _axes(axes)
    rows = [row for row in self.table() if row["value"]]
    axes.errorbar([1.0] * len(rows), range(len(rows)),
                  xerr=[abs(row["sd"] / row["value"]) for row in rows], fmt="ko")
    axes.set_yticks(range(len(rows)), [f"{row['constant']} = {row['value']:.5g}" for row in rows])
    axes.invert_yaxis()
    axes.set_xlabel("standard error, as a share")
    return axes


def add_plots():
    for kind, plot in ((_core.Map, plot_map), (_core.Poses, plot_poses),
                       (_core.Comparison, plot_comparison), (_core.Diagnosis, plot_diagnosis),
                       (_core.Discovery, plot_discovery), (_core.Fit, plot_fit),
                       (_core.Response, plot_response), (_core.PoseGraphFit, plot_pose_graph),
                       (_core.FleetReport, plot_fleet), (_core.Calibration, plot_table),
                       (_core.Umbmark, plot_table)):
        kind.plot = plot
