# %% [markdown]
# # Maps and sensitivity, with pandas and SALib
#
# A mass on a moving belt, held by a spring, sticks and slips. Where does it, and which numbers decide how far it swings?

# %%
import limcycle
import matplotlib.pyplot as plt
import numpy as np
import pandas
from SALib.analyze import sobol
from SALib.sample import sobol as sobol_sample

belt = limcycle.Loop(
    title="Mass on a belt",
    plant={"kind": "belt", "mass": 1.0, "stiffness": 100.0, "damping": 1.0, "speed": 0.05},  # kg, N/m, N s/m, m/s
    friction=limcycle.laws.coulomb(Fs=1.5, Fc=1.0),  # N
    search={"amplitude": [1e-5, 0.02], "frequency": [0.1, 1000.0]},  # m, rad/s
    predict={"starts": 1, "methods": ["describing-function"]})

# %% [markdown]
# ## A map
#
# Each point is a `predict` of its own. The arrays of the result are over y and x; its points make a table of pandas.

# %%
found = limcycle.map(belt, ("loop.plant.speed", 0.02, 0.1, 17), ("loop.plant.damping", 0.5, 2.5, 9))
found.plot().set_title("Where the mass on the belt sticks and slips")
plt.show()

# %%
table = pandas.DataFrame(found.to_dict()["points"])[["x", "y", "happens", "amplitude", "period"]]
table = table.rename(columns={"x": "speed", "y": "damping"})
print(table.groupby("happens").size())
print(table[table.happens == "hunting"].groupby("damping").speed.max())  # the fastest belt on which it still sticks

# %% [markdown]
# ## Sobol indices, three times
#
# Without damping the amplitude is known: A = sqrt(((Fs - Fc)/k)^2 + m v^2/k). Fs, k and v vary by +-20 %.

# %%
free = belt.set({"loop.plant.damping": 0.0})
names = ["loop.friction.Fs", "loop.plant.stiffness", "loop.plant.speed"]
bounds = [[0.8 * free[name], 1.2 * free[name]] for name in names]


def closed_form(points):
    Fs, k, v = points.T
    return np.sqrt(((Fs - 1.0) / k) ** 2 + v**2 / k)


def amplitude(points):
    """That of the cycle, by the exact method, at each point."""
    return np.array([limcycle.predict(free.set(dict(zip(names, one)))).cycles[0].amplitude for one in points.tolist()])


problem = {"num_vars": 3, "names": names, "bounds": bounds}
points = sobol_sample.sample(problem, 64, calc_second_order=False, seed=1)
measured = amplitude(points)
by_salib = sobol.analyze(problem, measured, calc_second_order=False, seed=1)

many = sobol_sample.sample(problem, 4096, calc_second_order=False, seed=2)
exact = sobol.analyze(problem, closed_form(many), calc_second_order=False, seed=2)

spread = limcycle.Loop(plant={"kind": "belt", "mass": 1.0, "stiffness": 100.0, "damping": 0.0, "speed": 0.05},
                       friction=limcycle.laws.coulomb(Fs=1.5, Fc=1.0), search={"amplitude": [1e-5, 0.02],
                                                                               "frequency": [0.1, 1000.0]},
                       sensitivity={"parameters": [{"path": name, "from": low, "to": high}
                                                   for name, (low, high) in zip(names, bounds)]})
study = limcycle.sensitivity(spread, samples=64, trajectories=2, seed=1)
ours = {one.name: one.total for one in study.sobol if one.output == "amplitude"}
indices = pandas.DataFrame({
    "limcycle, 64": [ours[name] for name in names], "SALib, 64": by_salib["ST"],
    "closed form, 4096": exact["ST"]}, index=[name.split(".")[-1] for name in names])
print(f"amplitude against the closed form: {np.abs(measured / closed_form(points) - 1.0).max():.1e}")
print(indices.round(3))

# %%
axes = indices.plot.barh(title="Total Sobol indices of the amplitude")
axes.set_xlabel("share of the variance")
plt.show()
