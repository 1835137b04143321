#!/usr/bin/env python3
"""Time of a step by the number of wheels, as a chart with the exponents of its parts.

    cargo run --release -p girderway-sim --example crossings -- wheels > target/wheels.csv
    python fea/wheels_chart.py target/wheels.csv target/wheels.svg
"""

import csv
import sys

import matplotlib
import numpy as np

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "wheels"
import matplotlib.pyplot as plt


def main():
    source, target = sys.argv[1:]
    with open(source, newline="") as file:
        rows = [(int(row["n"]), float(row["us a step"]) / 1e3) for row in csv.DictReader(file)]
    n, ms = np.array(rows).T
    figure, axis = plt.subplots(figsize=(6.5, 4.2))
    axis.loglog(n, ms, "o-", color="tab:blue", markersize=4)
    for low, high in ((1, 8), (16, 64), (64, 512)):
        part = (n >= low) & (n <= high)
        exponent, _ = np.polyfit(np.log(n[part]), np.log(ms[part]), 1)
        print(f"{low} to {high} wheels: n^{exponent:.2f}")
        middle = np.sqrt(low * high)
        axis.annotate(f"n^{exponent:.1f}", (middle, np.interp(middle, n, ms)), (8, -16), textcoords="offset points")
    axis.set(xlabel="wheels on one rail, n", ylabel="time of a step, ms")
    axis.grid(True, which="major", alpha=0.3)
    figure.tight_layout()
    figure.savefig(target, metadata={"Date": None})


if __name__ == "__main__":
    main()
