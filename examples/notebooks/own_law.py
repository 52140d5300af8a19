# %% [markdown]
# # A friction law of your own
#
# A bristle under a Stribeck curve of Lorentz' shape, written in Python: what it feeds and damps, whether a servo hunts with
# it, and what it costs.

# %%
import ctypes
import math
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import limcycle
import matplotlib.pyplot as plt
import numpy as np


class LorentzBristle:
    """dz/dt = v - s |v| z/g(v), F = s z + d dz/dt, g(v) = Fc + (Fs - Fc)/(1 + (v/vs)^2)."""

    Fs, Fc, vs, s, d = 1.5, 1.0, 0.001, 1e5, 300.0  # N, N, m/s, N/m, N s/m
    states, odd = 1, True
    scales = (Fs / s, vs, Fs)  # m, m/s, N: the sizes over which it changes

    def rate(self, v, z):
        return v - self.s * abs(v) * z[0] / (self.Fc + (self.Fs - self.Fc) / (1.0 + (v / self.vs) ** 2))

    def output(self, v, z):
        return self.s * z[0] + self.d * self.rate(v, z)


# %% [markdown]
# ## Its describing function, beside that of LuGre
#
# LuGre's curve has the shape of Gauss; everything else is the same.

# %%
amplitude = np.logspace(-6, -1.5, 28)  # m
lugre = limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=300.0)
figure, axes = plt.subplots()
gains = {}
for name, law in (("Lorentz", LorentzBristle()), ("LuGre", lugre)):
    gains[name] = limcycle.df(law, amplitude, 1.0).gain[:, 0, 0]
    axes.loglog(amplitude, np.abs(gains[name]) * amplitude, label=name)
axes.set(xlabel="amplitude [m]", ylabel="|N| A [N]", title="First harmonic of the force at 1 rad/s")
axes.legend()
plt.show()

# %% [markdown]
# ## Does a servo hunt with it?
#
# The law passes through the same methods as those of the library; derivatives are differences.


# %%
def servo(friction):
    return limcycle.Loop(title="A servo with a law of its own", plant={"kind": "mass", "mass": 1.0},
                         controller={"kind": "pid", "kp": 3.0, "ki": 4.0, "kd": 6.0}, friction=friction)


run = limcycle.simulate(servo(LorentzBristle()), 60.0, initial={"y": 0.2}, sample=0.1, check=False, audit=False)
run.plot(columns=["y", "loop.friction.output"])[0].set_title("The servo hunts on the law written in Python")
plt.show()

# %% [markdown]
# ## What it costs
#
# Every evaluation calls Python. A law whose functions are compiled, by Numba's `cfunc` or from C as here, is called
# directly: `double output(double v, const double *z)` and `void rate(double v, const double *z, double *dz)`.

# %%
code = """
#include <math.h>
static double slip(double v, double z) { return v - 1e5 * fabs(v) * z / (1.0 + 0.5 / (1.0 + 1e6 * v * v)); }
double output(double v, const double *z) { return 1e5 * z[0] + 300.0 * slip(v, z[0]); }
void rate(double v, const double *z, double *dz) { dz[0] = slip(v, z[0]); }
"""
with tempfile.TemporaryDirectory() as folder:
    source = Path(folder, "law.c")
    source.write_text(code, encoding="utf-8")
    compiler = shutil.which("cc") or shutil.which("g++")
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-x", "c", str(source), "-o", f"{folder}/law.so"], check=True)
    library = ctypes.CDLL(f"{folder}/law.so")


class Compiled(LorentzBristle):
    output, rate = library.output, library.rate


costs = {}
for name, law in (("Python", LorentzBristle()), ("compiled", Compiled()), ("LuGre of the library", lugre)):
    times = []
    for _ in range(10):
        begin = time.perf_counter()
        limcycle.df(law, amplitude, [1.0], threads=1)
        times.append(time.perf_counter() - begin)
    costs[name] = min(times) / len(amplitude)
    print(f"{name:20} {1e3 * costs[name]:8.3f} ms for a describing function")

# %% [markdown]
# Each of the simulations and searches of `predict` evaluates the law some hundred thousand times.

# %%
result = limcycle.predict(servo(Compiled()))
print(str(result).split("\n\n")[1])
