# %% [markdown]
# # A servo that hunts
#
# A linear axis under PID control should hold its position. It wanders to and fro about it by a millimetre instead. Why,
# what ends it, and how much room is left then?

# %%
import limcycle
import matplotlib.pyplot as plt
import numpy as np

axis = limcycle.Loop(
    title="Linear axis under PID control",
    plant={"kind": "mass", "mass": 5.0, "damping": 2.0},  # kg, N s/m
    controller={"kind": "pid", "kp": 2000.0, "ki": 8000.0, "kd": 150.0, "tf": 0.001},  # N/m, N/(m s), N s/m, s
    friction=limcycle.laws.coulomb(Fs=12.0, Fc=8.0),  # N: it starts at 12 N and slides at 8 N
    search={"amplitude": [1e-6, 0.1], "frequency": [0.01, 1000.0]})  # m, rad/s

# %% [markdown]
# ## Does it hunt?
#
# `predict` simulates the loop from several starts, solves for the cycles that it finds, and judges what each method
# predicts.

# %%
result = limcycle.predict(axis)
print(str(result).split("Limit cycles")[0])
cycle = result.cycles[0]

# %% [markdown]
# The describing function finds nothing: the Nyquist curve stays clear of -1/N.

# %%
result.plot()
plt.show()

# %% [markdown]
# ## What does it do?
#
# From 10 mm the axis comes near its set-point, sticks while the integrator winds up, breaks away, and sticks on the other
# side.

# %%
run = limcycle.simulate(axis, 25.0, initial={"y": 0.01}, sample=0.02, check=False)
figure, (above, below) = plt.subplots(2, 1, sharex=True)
above.plot(run["t"], 1e3 * run["y"])
above.set(ylabel="position [mm]", ylim=(-2.5, 2.5), title="The axis sticks, breaks away and overshoots")
below.plot(run["t"], run["loop.friction.output"])
below.set(ylabel="friction [N]", xlabel="t [s]")
plt.show()

# %% [markdown]
# ## How far is the edge?
#
# `margin` gives the factor on each number at which hunting ends or begins; here on two of the controller's.

# %%
margin = limcycle.margin(axis, ["loop.controller.ki", "loop.friction.Fs"])
print(str(margin).split("\n\n")[1])

# %% [markdown]
# ## What ends it?
#
# `remedy` tries changes and states the price of each. The cheapest ones are applied to the loop and asked once more.

# %%
remedies = limcycle.remedy(axis, ["integrator-leak", "error-dead-zone"], samples=0)
for one in remedies.remedies:
    print(f"{one.name:18} {one.parameter} = {one.value:.4g}: {'ends it' if one.ends else 'does not end it'}")
cured = remedies.apply(remedies.remedies[0].name)
print([cycle for cycle in limcycle.predict(cured).cycles if cycle.stable])
