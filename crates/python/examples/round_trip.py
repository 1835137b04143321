# %% [markdown]
# numpy -> .npz -> girderway -> scikit-fem: influence coefficients of a girder by numpy go to girderway as tables, a
# wheel rolls over them, and scikit-fem solves the girder under the wheel where it sinks deepest.

# %%
import tempfile
from pathlib import Path

import numpy as np

import girderway as gw

L, EI, W = 12.0, 2.1e8 * 5.768e-4, 180.0  # m, kN m^2, kN

# %% Influence coefficients of a simply supported beam by its closed form, at stations.
x = np.linspace(0, L, 25)
low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
G = (L - high) * low * (L**2 - (L - high) ** 2 - low**2) / (6 * L * EI)
folder = Path(tempfile.mkdtemp())
np.savez(folder / "girder.npz", stations=x, vertical=G, units=["m", "kN", "s"])

# %% The same coefficients by girderway, exact at every place, and back into numpy.
girder = gw.Structure(
    {
        "format": "girderway-beam/1",
        "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": [L], "E": 2.1e8, "I_vertical": 5.768e-4},
        "stations": x,
    }
)
assert np.allclose(girder.influence(x, x), G, rtol=1e-12, atol=1e-18)
girder.write_tables(folder / "back.npz")
with np.load(folder / "back.npz") as back:
    assert np.allclose(back["vertical"], G, rtol=1e-12, atol=1e-18)

# %% A wheel rolls over the tables of numpy.
scene = {
    "format": "girderway-scene/1",
    "name": "wheel",
    "units": {"length": "m", "force": "kN", "time": "s"},
    "gravity": 9.81,
    "structures": {"girder": {"tables": {"file": "girder.npz", "vertical": "vertical"}, "reading": "natural"}},
    "bodies": {"trolley": {"weight": W, "dof": ["x", "y"], "x0": 1.0}},
    "wheels": {"steel": {"radius": 0.2, "vertical": {"law": "linear", "k": 1e6, "c": 1e3}}},
    "trucks": [{"body": "trolley", "rail": "girder.rail", "tree": [0], "wheel": "steel"}],
    "motions": [{"body": "trolley", "dof": "x", "kind": "prescribed", "speed": [[0, 1.0]]}],
    "end": {"time": 10},
    "analysis": "quasi-static",
    "output": {"dt": 0.05},
}
run = gw.run(scene, folder=folder)
deepest = int(np.argmax(run["trolley.deflection"]))
place, sunk = float(run["trolley.x"][deepest]), float(run["trolley.deflection"][deepest]) - W / 1e6

# %% scikit-fem: the beam under the weight at that place (Hermite cubics with a node there are exact).
import skfem
from skfem.helpers import dd, ddot

mesh = skfem.MeshLine(np.unique(np.append(np.linspace(0, L, 9), place)))
basis = skfem.Basis(mesh, skfem.ElementLineHermite())
stiffness = skfem.BilinearForm(lambda u, v, _: EI * ddot(dd(u), dd(v))).assemble(basis)
load = W * basis.probes(np.array([[place]])).toarray().ravel()
ends = basis.get_dofs(lambda at: (at[0] == 0.0) | (at[0] == L)).all("u")
solution = skfem.solve(*skfem.condense(stiffness, load, D=ends))
reference = (basis.probes(np.array([[place]])) @ solution)[0]

print(f"at x = {place:.2f} m girderway sinks by {1e3 * sunk:.6f} mm, scikit-fem by {1e3 * reference:.6f} mm")
assert abs(sunk - reference) < 1e-4 * reference
