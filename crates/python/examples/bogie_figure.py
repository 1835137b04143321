# %% [markdown]
# The bogie of McConville's paper: paths of its trunnion on the flexible girder, for every model of the girder (the
# paper's Figs 5 and 6). The cells run in Jupyter, in editors that know `# %%`, or as a script with the name of a picture:
# `python bogie_figure.py bogie.png`.

# %%
import sys
from pathlib import Path

import matplotlib

if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
    matplotlib.use("Agg")
import matplotlib.pyplot as plt

import girderway as gw

BOGIE = Path(__file__).resolve().parents[3] / "examples" / "bogie"

# %% The girder: exact influence lines, also between the seven stations of the paper's table.
girder = gw.Structure(BOGIE / "spec.json")
midspan = girder.influence(30, 30)[0, 0]
print(f"deflection at midspan under 4.8e6 lbf there: {4.8e6 * midspan:.4f} ft (the paper's classical value: 0.5248)")

# %% One call runs the scene and its five comparisons.
run = gw.run(BOGIE / "scene.json")
print(run.summary["status"], {label: float(case["bogie.deflection"].max()) for label, case in run.comparisons.items()})

# %% Fig. 5: the trunnion of the bogie on the flexible girder and on the model of rigid parts.
figure, axes = plt.subplots(2, sharex=True, figsize=(8, 7), layout="constrained")
run.plot("bogie.deflection", x="bogie.x", ax=axes[0])
run.comparisons["parts-blended"].plot("bogie.deflection", x="bogie.x", ax=axes[0])
for line, name in zip(axes[0].lines, ["influence functions", "two rigid parts"]):
    line.set_label(name)

# %% Fig. 6: every model.
for label, case in {"influence functions": run, **run.comparisons}.items():
    axes[1].plot(case["bogie.x"], case["bogie.deflection"], label=label)
for ax in axes:
    ax.invert_yaxis()
    ax.grid(True, linewidth=0.4)
    ax.set_ylabel("trunnion, ft (down)")
    ax.legend()
if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
    figure.savefig(sys.argv[1], dpi=150)
else:
    plt.show()
