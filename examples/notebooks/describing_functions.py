# %% [markdown]
# # Describing functions, and what they miss
#
# The describing function of any law or element, side by side with python-control; then loops for which the curves meet
# and more has to be known.

# %%
import control
import limcycle
import matplotlib.pyplot as plt
import numpy as np

# %% [markdown]
# ## Of any law
#
# Over the amplitude, a law with a bristle goes from a spring (phase 0) to a force that opposes the velocity (phase 90
# degrees). Coulomb friction has no spring.

# %%
amplitude = np.logspace(-6.5, -2, 60)  # m
frequency = 10.0  # rad/s
figure, (above, below) = plt.subplots(2, 1, sharex=True)
for law in (limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=316.0),
            limcycle.laws.dahl(Fc=1.0, sigma0=1e5), limcycle.laws.coulomb(Fc=1.0)):
    gain = limcycle.df(law, amplitude, frequency).gain[:, 0, 0]
    above.loglog(amplitude, np.abs(gain), label=law.kind)
    below.semilogx(amplitude, np.degrees(np.angle(gain)))
above.set(ylabel="|N| [N/m]", title=f"Describing functions of friction at {frequency:g} rad/s")
above.legend()
below.set(ylabel="phase [degrees]", xlabel="amplitude [m]")
plt.show()

# %% [markdown]
# ## The same as python-control
#
# `limcycle.describing_function` takes the nonlinearities of python-control, elements of `limcycle.laws`, and functions.

# %%
sizes = np.linspace(1.1, 5.0, 40)
nonlinearities = [control.saturation_nonlinearity(0.75), control.friction_backlash_nonlinearity(0.5),
                  control.relay_hysteresis_nonlinearity(1.0, 1.0)]
differences = [float(np.abs(limcycle.describing_function(F, sizes) - control.describing_function(F, sizes)).max())
               for F in nonlinearities]
cubic = limcycle.describing_function(lambda u: u**3, sizes)
differences.append(float(np.abs(cubic - 0.75 * sizes**2).max()))
print(differences)

# %% [markdown]
# ## Where the curves meet, and what happens there
#
# Two examples of python-control's documentation, and a drive with backlash. Its intersections are where G(jw) = -1/N(A);
# `predict` finds them too, and says what each is worth.

# %%
third_order = control.tf([1.0], [1.0, 2.0, 2.0, 1.0])
delayed = third_order * control.tf(*control.pade(5, 4)) * 4.0
drive = control.tf([1.2], [1.0, 2.0, 1.0, 0.0])
backlash = control.friction_backlash_nonlinearity(1.0)
loops = {"8/((s+1)(s^2+s+1)), saturation": (8.0 * third_order, control.saturation_nonlinearity(1.0), (0.1, 20.0)),
         "4/((s+1)(s^2+s+1)) and a delay of 5 s, backlash": (delayed, backlash, (0.6, 5.0)),
         "1.2/(s(s+1)^2), backlash": (drive, backlash, (0.51, 5.0))}
omega = np.logspace(-3, 3, 500)
intersections, results = {}, {}
for name, (plant, element, (low, high)) in loops.items():
    plant = control.tf(plant)
    found = control.describing_function_response(plant, element, np.linspace(low, high, 50), omega)
    intersections[name] = [(float(A), float(w)) for A, w in found.intersections]
    loop = limcycle.Loop(title=name, plant=plant, element=element, search={"amplitude": [low, high],
                                                                           "frequency": [0.01, 100.0]})
    results[name] = limcycle.predict(loop)
    print(f"\n{name}\n  python-control: " + ", ".join(f"A = {A:.3f} at {w:.3f} rad/s" for A, w in intersections[name]))
    for one in results[name].predictions:
        if one.method == "describing-function":
            print(f"  limcycle:       A = {one.amplitude:.3f} at {one.frequency:.3f} rad/s: {one.verdict}")
    for one in results[name].cycles:
        print(f"  cycle:          A = {one.first_harmonic:.3f} at {one.frequency:.3f} rad/s, "
              + ("stable" if one.stable else "unstable"))

# %% [markdown]
# In the first loop the two agree, and the cycle is 1.5 % larger. In the second both intersections are cycles, but unstable
# ones: the loop comes to rest or diverges. In the third one prediction is 17 % too small; whether a cycle belongs to the
# other one stays undecided, since none was found there.

# %%
axes = results["1.2/(s(s+1)^2), backlash"].plot()
axes.set(xlim=(-2.2, -0.6), ylim=(-1.8, 0.2), title="A drive with backlash: the curves nearly touch")
plt.show()

# %% [markdown]
# ## Where they do not meet
#
# A servo with friction and integral action hunts, although its curves do not meet.

# %%
servo = limcycle.Loop(plant={"kind": "mass", "mass": 1.0}, controller={"kind": "pid", "kp": 3.0, "ki": 4.0, "kd": 6.0},
                      friction=limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=316.0, sigma2=0.4),
                      search={"amplitude": [1e-6, 1.0], "frequency": [0.01, 1000.0]},
                      predict={"methods": ["describing-function"], "starts": 1})
missed = limcycle.predict(servo)
print(str(missed).split("\n\n")[1])
