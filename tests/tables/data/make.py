"""Writes the .npz files beside it: arrays as numpy's own functions save them (numpy 2.4)."""

import numpy as np

x = np.array([-15.0, 0.0, 15.0, 30.0, 45.0])
values = np.outer(np.cos(x / 20), np.cos(x / 20)) * 1e-8
units = np.array(["ft", "lbf", "s"])

np.savez("plain.npz", stations=x, vertical=values, lateral=values / 3, units=units, name="bridge")
np.savez_compressed("packed.npz", stations=x, vertical=values, lateral=values / 3, units=units, name="bridge")
np.savez("fortran.npz", stations=x, vertical=np.asfortranarray(values), units=b"ft lbf s")
np.savez("oblong.npz", x=x.astype(int), z=x[:3], vertical=np.asfortranarray(values[:3]), units="m, kN")
np.savez("big.npz", stations=x.astype(">f4"), vertical=values.astype(">f8"), units=units.astype("S"))
np.savez("single.npz", stations=x[1:].astype("u1"), vertical=values[1:, 1:].astype("f4"), units=units)
np.savez("curve.npz", x=x, shape=values[2], units=units)
